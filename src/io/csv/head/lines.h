// Lines, fields and numbers of a CSV as it writes them.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "lobefit/base/text/text.h"

namespace lobefit {

// '\0' stands for runs of blanks.
inline constexpr char kBlankSeparator = '\0';

bool IsComment(std::string_view line);
std::string_view CommentText(std::string_view line);
// Without the separators by which a spreadsheet fills a line of words up to the number of columns.
std::string_view WithoutEmptyCells(std::string_view text, char separator);

// What the writer puts before a comment that would be read as a key of the written file.
inline constexpr std::string_view kCommentKey = "comment: ";
// Without it.
std::string_view PlainComment(std::string_view comment);

// Lines of a CSV; a quoted field may hold line ends, and its line goes on.
class CsvLines {
 public:
  explicit CsvLines(std::string_view bytes);
  bool Next(std::string_view* line);
  // Line in which the text of Next begins.
  std::size_t line_number() const { return first_line_; }

 private:
  std::string_view bytes_;
  LineReader lines_;
  bool has_quotes_;
  std::size_t first_line_ = 0;
};

// About how many lines, and seldom fewer than there are: from pieces all over the text, so that rows whose length
// varies are not taken for the first.
std::size_t EstimateLines(std::string_view bytes);

// Fields of a line, as written.
void SplitCsvLine(std::string_view line, char separator, std::vector<std::string_view>* fields);

// Whether the field is a number as the file writes them.
std::optional<double> ParseCsvNumber(std::string_view field, char decimal_mark);

}  // namespace lobefit

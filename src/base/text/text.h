// Strict text parsing, independent of the locale: a number is parsed to the end of its field or refused.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// `text` without leading and trailing blanks, tabs, carriage returns and newlines.
std::string_view Trim(std::string_view text);

// Lower case in the C locale.
std::string ToLower(std::string_view text);

// Pieces between separators, untrimmed; "a,,b" gives three.
std::vector<std::string_view> Split(std::string_view text, char separator);

// Pieces between runs of blanks and tabs; none is empty.
std::vector<std::string_view> SplitBlanks(std::string_view text);

// The number that fills `field` exactly (blanks at both ends allowed, one leading '+' allowed, "nan" and "inf" in any
// case allowed), else nothing. "0,5", "1.0x", "" and "0x10" give nothing. 1e-400 gives 0 and 1e400 gives infinity.
std::optional<double> ParseDouble(std::string_view field);
std::optional<long long> ParseInteger(std::string_view field);

// `name` and a suggestion from `allowed` that is at most two edits away: " (did you mean 'x'?)", else "".
std::string DidYouMean(std::string_view name, const std::vector<std::string>& allowed);

// Two digits a byte.
std::string Hex(std::string_view bytes);

// "a, b, c".
std::string Join(const std::vector<std::string>& items, std::string_view separator = ", ");

// A piece of the input that is fit to stand in a message: at most `max_length` bytes of UTF-8, control characters and
// bytes that are none as '?'.
std::string Excerpt(std::string_view text, std::size_t max_length = 40);

// A number of at most 17 significant digits that reads back as the same double; "nan", "inf", "-inf" otherwise.
std::string FormatDouble(double value);

// Walks over lines that end with LF or CRLF; a last line without either counts. Line numbers start at 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}
  // False at the end of the text. `line` has no line end.
  bool Next(std::string_view* line);
  std::size_t line_number() const { return line_number_; }
  // Byte offset of the first character after the line that Next gave last.
  std::size_t offset() const { return offset_; }

 private:
  std::string_view text_;
  std::size_t offset_ = 0;
  std::size_t line_number_ = 0;
};

}  // namespace lobefit

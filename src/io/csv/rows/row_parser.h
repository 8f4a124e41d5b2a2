// One row of a CSV: its numbers, fast, and what else may stand there.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/head/no_value.h"
#include "lobefit/io/csv/rows/layout.h"

namespace lobefit {

class RowParser {
 public:
  enum class Kind {
    kRow,
    kBlank,  // nothing but separators
    kWords   // fewer numbers than words: a line of names again, a key, a heading, a footer
  };

  RowParser(const InputFile& file, const CsvHeader& header, const CsvLayout& layout, NoValues no_values);

  // Reads a line. Throws InputError for a row that has too few or too many fields or a field that is not a number.
  Kind Parse(std::string_view line, std::size_t line_number);

  // Of a row, by column: its number; NaN where there is no value. Columns that are not needed hold anything.
  double Number(std::size_t column) const { return numbers_[column]; }
  // As written, for columns that rows are chosen by.
  std::string_view Text(std::size_t column) const { return texts_[column]; }
  // Words and marks of the row that stand for no value, with their columns.
  const std::vector<std::pair<std::size_t, std::string_view>>& marks() const { return marks_; }
  // Of kWords: what a reader of rows says of the line.
  std::string WordsMessage() const;

 private:
  void TakeOther(std::string_view field, std::size_t column);
  bool TakeCell(std::string_view text, std::size_t column);
  void SplitFast(std::string_view line);
  void SplitBlankSeparated(std::string_view line);
  bool IsSummary(std::string_view line) const;
  std::string FieldMessage(std::size_t column, std::string_view field) const;

  const InputFile& file_;
  const CsvHeader& header_;
  NoValues no_values_;
  std::size_t written_;                // columns that a row has fields of
  std::vector<unsigned char> needed_;  // 1: a number, 2: a text, 4: may have no value
  std::vector<unsigned char> fast_;    // only its number is needed, and none stands for no value; one a written column
  std::vector<double> numbers_;
  std::vector<std::string_view> texts_;
  std::vector<std::pair<std::size_t, std::string_view>> marks_;
  bool is_table_ = false;
  std::size_t columns_ = 0;  // fields of the row
  std::size_t good_ = 0, bad_ = 0, bad_column_ = 0, filled_beyond_ = 0;
  std::string_view bad_field_;
  std::string storage_;
};

}  // namespace lobefit

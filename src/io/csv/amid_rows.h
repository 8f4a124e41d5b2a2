// Lines among the rows that are none: names again where files were joined, keys that change, comments, a footer.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/csv/head/column_units.h"
#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/layout.h"
#include "lobefit/io/csv/rows/row_parser.h"

namespace lobefit {

class AmidRows {
 public:
  // All are kept by reference; keys change those of `header` and the coordinates `at` that all rows share.
  AmidRows(const InputFile& file, const CsvLayout& layout, CsvHeader* header, Coordinates* at)
      : file_(file), layout_(layout), header_(*header), at_(*at) {}

  // The names again; a key of the rows that follow; else a footer, unless rows come after it.
  void TakeWords(std::string_view line, std::size_t number, const RowParser& parser);
  // A key, or a comment that is kept.
  void TakeComment(std::size_t number, std::string_view text);
  // True behind words that are a footer at best: a row after them is a fault.
  bool pending() const { return !message_.empty(); }
  // Throws InputError for the words.
  [[noreturn]] void Fail() const;
  // What is said of a footer.
  std::string Remark() const;
  // The first words that stood above names amid the rows: "'Sample B' in line 40". Empty where there were none.
  const std::string& page() const { return page_; }

 private:
  bool MayStateAnAngle(std::string_view comment) const;
  // Throws InputError for one other than that of the rows.
  bool MentionsAnAngle(std::size_t number, std::string_view comment) const;
  bool AreNamesAgain(const std::vector<std::string_view>& fields) const;
  bool AreUnitsAgain(const std::vector<std::string_view>& fields) const;
  // Throws InputError for a unit of a column that is not that of the rows before.
  void RequireKeptUnits(std::size_t number, const std::vector<ColumnUnit>& stated) const;
  bool ReadKeyAmidRows(std::size_t number, std::string_view comment, const std::vector<std::string_view>& fields);

  const InputFile& file_;
  const CsvLayout& layout_;
  CsvHeader& header_;
  Coordinates& at_;
  std::size_t words_ = 0, line_ = 0;
  std::string message_, text_;
  std::string page_;
  std::set<std::string> prose_;  // words of comments that stated nothing
};

}  // namespace lobefit

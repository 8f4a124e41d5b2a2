// Comma-separated text [RFC 4180]: what work lists come in and tables go out as.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// Walks over records; a field in double quotes may hold commas, line ends and doubled quotes. A byte order mark and
// empty lines are passed over. Fields without quotes are trimmed.
class CsvRecords {
 public:
  // `name` stands in messages.
  CsvRecords(std::string_view text, std::string name);
  // False at the end. Throws InputError for a quote that does not end, or text after one that does.
  bool Next(std::vector<std::string>* fields);
  // Line of the file, from 1, on which the record that Next gave last begins.
  std::size_t line_number() const { return line_number_; }

 private:
  std::string Quoted();
  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0, line_ = 1, line_number_ = 0;
};

// Appends the field as a table holds it: in quotes where it has to be.
void AppendCsvField(std::string_view text, std::string* line);

}  // namespace lobefit

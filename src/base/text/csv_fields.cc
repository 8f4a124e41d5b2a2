#include "lobefit/base/text/csv_fields.h"

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// Where the field that begins at `begin` ends: its separator, or the end of the line. `closed` is false for a quoted
// field without a second quote.
std::size_t EndOfField(std::string_view line, char separator, std::size_t begin, bool* closed) {
  std::size_t at = begin;
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t') && line[at] != separator) ++at;
  *closed = true;
  if (at < line.size() && line[at] == '"') {
    *closed = false;
    for (++at; at < line.size(); ++at) {
      if (line[at] != '"') continue;
      if (at + 1 < line.size() && line[at + 1] == '"') {
        ++at;
        continue;
      }
      *closed = true;
      break;
    }
  }
  const std::size_t end = at < line.size() ? line.find(separator, at) : std::string_view::npos;
  return end == std::string_view::npos ? line.size() : end;
}

}  // namespace

void SplitQuoted(std::string_view line, char separator, std::vector<std::string_view>* fields) {
  fields->clear();
  std::size_t begin = 0;
  bool closed = true;
  while (true) {
    const std::size_t end = EndOfField(line, separator, begin, &closed);
    fields->push_back(line.substr(begin, end - begin));
    if (end == line.size()) return;
    begin = end + 1;
  }
}

std::string_view Unquoted(std::string_view field, std::string* storage) {
  field = Trim(field);
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') return field;
  field = field.substr(1, field.size() - 2);
  if (field.find("\"\"") == std::string_view::npos) return Trim(field);
  storage->clear();
  for (std::size_t i = 0; i < field.size(); ++i) {
    storage->push_back(field[i]);
    if (field[i] == '"' && i + 1 < field.size() && field[i + 1] == '"') ++i;
  }
  return Trim(*storage);
}

bool EndsWithinQuotes(std::string_view line, char separator) {
  std::size_t begin = 0;
  bool closed = true;
  while (true) {
    const std::size_t end = EndOfField(line, separator, begin, &closed);
    if (!closed) return true;
    if (end == line.size()) return false;
    begin = end + 1;
  }
}

}  // namespace lobefit

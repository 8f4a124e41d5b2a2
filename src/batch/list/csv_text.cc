#include "lobefit/batch/list/csv_text.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

CsvRecords::CsvRecords(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

std::string CsvRecords::Quoted() {
  std::string field;
  const std::size_t first_line = line_;
  for (++at_; at_ < text_.size(); ++at_) {
    if (text_[at_] == '\n') ++line_;
    if (text_[at_] != '"') {
      field += text_[at_];
      continue;
    }
    if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
      field += '"';
      ++at_;
      continue;
    }
    ++at_;
    const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
    if (const std::string_view rest = Trim(text_.substr(at_, end - at_)); !rest.empty()) {
      throw InputError(fmt::format("{}, line {}: '{}' follows a field in quotes; write \"\" for a quote within it",
                                   name_, line_, Excerpt(rest)));
    }
    at_ = end;
    return field;
  }
  throw InputError(fmt::format("{}, line {}: the quote that begins here does not end", name_, first_line));
}

bool CsvRecords::Next(std::vector<std::string>* fields) {
  fields->clear();
  while (at_ < text_.size()) {
    line_number_ = line_;
    bool more = true;
    while (more) {
      const std::size_t begin = std::min(text_.find_first_not_of(" \t", at_), text_.size());
      if (begin < text_.size() && text_[begin] == '"') {
        at_ = begin;
        fields->push_back(Quoted());
      } else {
        const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
        fields->emplace_back(Trim(text_.substr(at_, end - at_)));
        at_ = end;
      }
      more = at_ < text_.size() && text_[at_] == ',';
      if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      ++at_;
    }
    const bool empty = fields->size() == 1 && fields->front().empty();
    if (!empty) return true;
    fields->clear();
  }
  return false;
}

void AppendCsvField(std::string_view text, std::string* line) {
  const auto is_special = [](char c) { return c == ',' || c == '"' || c == '\r' || c == '\n'; };
  if (std::none_of(text.begin(), text.end(), is_special) && Trim(text) == text) {
    *line += text;
    return;
  }
  *line += '"';
  for (const char c : text) {
    if (c == '"') *line += '"';
    *line += c;
  }
  *line += '"';
}

}  // namespace lobefit

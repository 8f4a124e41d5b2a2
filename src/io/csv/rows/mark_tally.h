// Words in place of a number, counted for the remarks about a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobefit/base/text/text.h"

namespace lobefit {

class MarkTally {
 public:
  // Columns and words of a row's fields that hold no number; empty ones only where `empty_told`.
  void Add(const std::vector<std::pair<std::size_t, std::string_view>>& marks, std::uint32_t line, bool empty_told) {
    for (const auto& [column, word] : marks) {
      if (word.empty() && !empty_told) continue;
      const std::string text = Excerpt(word);
      auto known = marks_.begin();
      while (known != marks_.end() && known->word != text) ++known;
      if (known == marks_.end()) {
        if (marks_.size() >= kMost) {
          ++others_;
          continue;
        }
        known = marks_.insert(marks_.end(), {text, line, 0});
      }
      ++known->count;
    }
  }

  // One a word, with the first line that holds it.
  void AddRemarks(std::vector<std::string>* remarks) const {
    for (const Mark& mark : marks_) {
      remarks->push_back(std::to_string(mark.count) + (mark.count == 1 ? " field" : " fields") +
                         " without a number: " + (mark.word.empty() ? "empty" : "'" + mark.word + "'") +
                         ", first in line " + std::to_string(mark.line));
    }
    if (others_ > 0) remarks->push_back(std::to_string(others_) + " more fields without a number, of other words");
  }

 private:
  struct Mark {
    std::string word;
    std::uint32_t line = 0;
    std::size_t count = 0;
  };
  static constexpr std::size_t kMost = 6;

  std::vector<Mark> marks_;
  std::size_t others_ = 0;
};

}  // namespace lobefit

// Words looked up in lists of hundreds: lengths and first letters mostly differ, so that few are compared as a whole.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lobefit {

inline bool SameWord(std::string_view a, std::string_view b) {
  return a.size() == b.size() && (a.empty() || (a.front() == b.front() && a == b));
}

inline bool BeginsWith(std::string_view text, std::string_view head) {
  return head.empty() || (text.size() >= head.size() && text.front() == head.front() && text.starts_with(head));
}

// The entries of a constant table of N by the first byte of their words, none of which is empty.
template <std::size_t N>
class ByFirstByte {
 public:
  template <class Table, class WordOf>
  constexpr ByFirstByte(const Table& table, const WordOf& word_of) {
    for (const auto& entry : table) ++begin_[Byte(word_of(entry)) + 1];
    for (std::size_t byte = 0; byte < 256; ++byte) begin_[byte + 1] += begin_[byte];
    std::array<std::uint16_t, 257> next = begin_;
    for (std::size_t i = 0; i < N; ++i) order_[next[Byte(word_of(table[i]))]++] = static_cast<std::uint16_t>(i);
  }

  // The first entry, in the table's order, of those that begin like `text` for which matches(index); N where none does.
  template <class Matches>
  constexpr std::size_t Find(std::string_view text, const Matches& matches) const {
    if (text.empty()) return N;
    for (std::size_t k = begin_[Byte(text)]; k < begin_[Byte(text) + 1]; ++k) {
      if (matches(order_[k])) return order_[k];
    }
    return N;
  }

 private:
  static constexpr std::size_t Byte(std::string_view word) { return static_cast<unsigned char>(word.front()); }

  std::array<std::uint16_t, 257> begin_ = {};
  std::array<std::uint16_t, N> order_ = {};
};

}  // namespace lobefit

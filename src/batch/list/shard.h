// A part of a work list: one of N processes that share nothing but a folder.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace lobefit {

// Which of `count` parts, from 1.
struct Shard {
  std::size_t index = 1, count = 1;

  bool IsWhole() const { return count == 1; }
  // Whether the item at this place of the list belongs to the part: items go round, so that a list sorted by size
  // gives parts of about the same size.
  bool Holds(std::size_t place) const { return place % count == index - 1; }
  // The range [first, second) of `items` in turn, the first parts one longer where it does not go evenly.
  std::pair<std::size_t, std::size_t> Range(std::size_t items) const;
};

// "3/8": the third of eight. Throws UsageError.
Shard ParseShard(const std::string& text);

}  // namespace lobefit

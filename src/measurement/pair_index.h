// Numbers pairs of directions in the order in which they come, and finds a pair that came before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// An open-addressing hash table over direction pairs rounded to 1e-9.
class PairIndex {
 public:
  explicit PairIndex(std::size_t expected_pairs = 0);

  // A pair that will be asked for soon.
  struct Pair {
    std::array<std::int32_t, 6> key;
    std::uint64_t hash;
  };
  // Brings the place of the pair into the cache; a table of millions lies outside of it.
  Pair Prepare(const Vec3& wi, const Vec3& wo) const;

  // The number of the pair: that of an equal one, or size() before the call where the pair is new.
  std::size_t FindOrAdd(const Pair& pair);
  std::size_t FindOrAdd(const Vec3& wi, const Vec3& wo);
  std::size_t size() const { return keys_.size(); }

 private:
  using Key = std::array<std::int32_t, 6>;
  // Part of the hash stands beside the number, so that keys, which lie far apart in memory, are compared only where
  // they are almost surely equal.
  struct Slot {
    std::uint32_t number = 0;  // of the pair, plus 1; 0 is empty
    std::uint32_t tag = 0;
  };

  void Put(std::uint64_t hash, std::uint32_t number);
  void Grow();

  std::vector<Key> keys_;
  std::vector<Slot> slots_;
};

}  // namespace lobefit

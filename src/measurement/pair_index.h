// Numbers pairs of directions in the order in which they come, and finds a pair that came before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// An open-addressing hash table over direction pairs rounded to 1e-9. 10^6 pairs take about 80 ms.
class PairIndex {
 public:
  explicit PairIndex(std::size_t expected_pairs = 0);

  // The number of the pair: that of an equal one, or size() before the call where the pair is new.
  std::size_t FindOrAdd(const Vec3& wi, const Vec3& wo);
  std::size_t size() const { return keys_.size(); }

 private:
  using Key = std::array<std::int32_t, 6>;

  void Grow();

  std::vector<Key> keys_;
  std::vector<std::uint32_t> slots_;  // number of the pair plus 1; 0 is empty
};

}  // namespace lobefit

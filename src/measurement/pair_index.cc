#include "lobefit/measurement/pair_index.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lobefit {
namespace {

std::uint64_t Hash(const std::array<std::int32_t, 6>& key) {
  std::uint64_t hash = 0x9e3779b97f4a7c15U;
  for (std::size_t i = 0; i < key.size(); i += 2) {
    const std::uint64_t low = static_cast<std::uint32_t>(key[i]), high = static_cast<std::uint32_t>(key[i + 1]);
    hash = (hash ^ (low | high << 32)) * 0xff51afd7ed558ccdU;
    hash ^= hash >> 32;
  }
  return hash;
}

// Components of unit vectors: 1e9 fits 32 bits.
std::int32_t Rounded(double x) { return static_cast<std::int32_t>(std::lrint(x * 1e9)); }

}  // namespace

PairIndex::PairIndex(std::size_t expected_pairs) {
  keys_.reserve(expected_pairs);
  slots_.resize(std::bit_ceil(std::max<std::size_t>(16, 2 * expected_pairs)), 0);
}

std::size_t PairIndex::FindOrAdd(const Vec3& wi, const Vec3& wo) {
  if (2 * (keys_.size() + 1) > slots_.size()) Grow();
  const Key key = {Rounded(wi.x), Rounded(wi.y), Rounded(wi.z), Rounded(wo.x), Rounded(wo.y), Rounded(wo.z)};
  std::size_t slot = Hash(key) & (slots_.size() - 1);
  while (slots_[slot] != 0) {
    if (keys_[slots_[slot] - 1] == key) return slots_[slot] - 1;
    slot = (slot + 1) & (slots_.size() - 1);
  }
  keys_.push_back(key);
  slots_[slot] = static_cast<std::uint32_t>(keys_.size());
  return keys_.size() - 1;
}

void PairIndex::Grow() {
  slots_.assign(2 * slots_.size(), 0);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    std::size_t slot = Hash(keys_[i]) & (slots_.size() - 1);
    while (slots_[slot] != 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace lobefit

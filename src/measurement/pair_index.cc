#include "lobefit/measurement/pair_index.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lobefit/base/process/memory.h"

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

std::array<std::int32_t, 6> KeyOf(const Vec3& wi, const Vec3& wo) {
  return {Rounded(wi.x), Rounded(wi.y), Rounded(wi.z), Rounded(wo.x), Rounded(wo.y), Rounded(wo.z)};
}

}  // namespace

PairIndex::PairIndex(std::size_t expected_pairs) {
  keys_.reserve(expected_pairs);
  AdviseLargePages(keys_.data(), keys_.capacity() * sizeof(Key));
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(16, 2 * expected_pairs));
  slots_.reserve(slots);
  AdviseLargePages(slots_.data(), slots * sizeof(Slot));
  slots_.resize(slots);
}

std::size_t PairIndex::FindOrAdd(const Pair& pair) {
  if (2 * (keys_.size() + 1) > slots_.size()) Grow();
  const auto tag = static_cast<std::uint32_t>(pair.hash >> 32U);
  std::size_t slot = pair.hash & (slots_.size() - 1);
  while (slots_[slot].number != 0) {
    if (slots_[slot].tag == tag && keys_[slots_[slot].number - 1] == pair.key) return slots_[slot].number - 1;
    slot = (slot + 1) & (slots_.size() - 1);
  }
  keys_.push_back(pair.key);
  slots_[slot] = {static_cast<std::uint32_t>(keys_.size()), tag};
  return keys_.size() - 1;
}

std::size_t PairIndex::FindOrAdd(const Vec3& wi, const Vec3& wo) {
  const Key key = KeyOf(wi, wo);
  return FindOrAdd(Pair{key, Hash(key)});
}

PairIndex::Pair PairIndex::Prepare(const Vec3& wi, const Vec3& wo) const {
  const Key key = KeyOf(wi, wo);
  const std::uint64_t hash = Hash(key);
  __builtin_prefetch(&slots_[hash & (slots_.size() - 1)], 1);
  return {key, hash};
}

void PairIndex::Put(std::uint64_t hash, std::uint32_t number) {
  std::size_t slot = hash & (slots_.size() - 1);
  while (slots_[slot].number != 0) slot = (slot + 1) & (slots_.size() - 1);
  slots_[slot] = {number, static_cast<std::uint32_t>(hash >> 32U)};
}

void PairIndex::Grow() {
  slots_.assign(2 * slots_.size(), {});
  for (std::size_t i = 0; i < keys_.size(); ++i) Put(Hash(keys_[i]), static_cast<std::uint32_t>(i + 1));
}

}  // namespace lobefit

// Seeded random numbers that are the same with every standard library: raw bits of mt19937_64, whose sequence the
// standard fixes, turned into numbers here.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "lobefit/math/vec.h"

namespace lobefit {

// A seed for stream `stream` of `seed`: streams of one seed are unrelated (the finaliser of SplitMix64, twice).
inline std::uint64_t StreamSeed(std::uint64_t seed, std::uint64_t stream) {
  const auto mix = [](std::uint64_t x) {
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
  };
  return mix(mix(seed + 0x9e3779b97f4a7c15U) + 0x9e3779b97f4a7c15U * (stream + 1));
}

class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) : random_(seed) {}
  // In [0, 1).
  double Uniform() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  // Standard normal, by Box and Muller.
  double Normal() {
    const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
    return radius * std::cos(2 * kPi * Uniform());
  }
  // Poisson distributed with mean >= 0: by counting below a mean of 30, above it a rounded normal number (whose
  // skewness is off by at most 0.18).
  double Poisson(double mean) {
    if (mean > 30) return std::fmax(0.0, std::round(mean + std::sqrt(mean) * Normal()));
    double product = Uniform(), count = 0;
    for (const double limit = std::exp(-mean); product > limit; ++count) product *= Uniform();
    return count;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace lobefit

// Rows whose wavelengths stand in rows of their own, gathered to one sample a pair of directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "lobefit/measurement/measurement.h"
#include "lobefit/measurement/pair_index.h"

namespace lobefit {

class WavelengthTable {
 public:
  struct Row {
    Vec3 wi, wo;
    double nm = 0;
    double value = 0;  // f_r; NaN where it has no value
    double weight = 1;
    std::uint32_t line = 0;
  };
  enum class Weights { kNone, kWeight, kSigma };

  explicit WavelengthTable(Weights weights) : weights_(weights) {}

  void Add(const Row& row);
  std::size_t wavelengths() const { return numbers_.size(); }
  std::size_t pairs() const { return pair_directions_.size(); }

  // One sample a pair of directions, with NaN where it lacks a wavelength. A wavelength that a pair has already opens a
  // further sample of that pair with `keep_repeats`, else it is counted as a duplicate. A sample weighs as much as the
  // mean of its rows; standard deviations are averaged in the square.
  //
  // A lamp's wavelength that wanders from row to row is one channel: wavelengths within less than half of the distance
  // to their neighbours, and within a hundredth of themselves, become their mean, unless a pair of directions has two
  // of them. With `tolerance_nm` those that differ by no more become their mean, and a second row of a pair in one is
  // repeated. Throws InputError for more than 4096 wavelengths, and where wavelengths times pairs are more than 2^28
  // values, or more than 2^24 of which not one in 16 has a row.
  Measurement Gather(bool keep_repeats, std::optional<double> tolerance_nm = std::nullopt) const;

 private:
  struct Entry {
    std::uint32_t pair = 0, wavelength = 0, line = 0;
    double value = 0, weight = 1;
  };
  struct Pair {
    Vec3 wi, wo;
  };

  // Channel of each wavelength, by its number, and the channels' wavelengths in ascending order.
  struct Grouping {
    std::vector<std::uint32_t> channel;
    std::vector<double> nm;
  };
  Grouping Apart() const;
  Grouping Within(double tolerance_nm) const;
  std::optional<Grouping> Wandering() const;
  // Whether a pair of directions was measured at two of the wavelengths of one channel.
  bool HasPairAtTwo(const Grouping& grouping) const;

  Weights weights_;
  std::map<double, std::uint32_t> numbers_;  // nanometres -> in the order of their first rows
  std::vector<Entry> entries_;
  std::vector<Pair> pair_directions_;
  PairIndex pairs_;
};

}  // namespace lobefit

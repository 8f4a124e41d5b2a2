// Rows whose wavelengths stand in rows of their own, gathered to one sample a pair of directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "lobefit/measurement/measurement.h"
#include "lobefit/measurement/pair_index.h"

namespace lobefit {

class WavelengthTable {
 public:
  struct Row {
    Vec3 wi, wo;
    double nm = 0;
    double value = 0;  // f_r
    double weight = 1;
    std::uint32_t line = 0;
  };
  enum class Weights { kNone, kWeight, kSigma };

  // With keep_repeats, a wavelength that a pair of directions has already opens a further sample of that pair; without,
  // Add returns false for it.
  WavelengthTable(Weights weights, bool keep_repeats) : weights_(weights), keep_repeats_(keep_repeats) {}

  bool Add(const Row& row);

  // Wavelengths in ascending order.
  Channels ChannelNames() const;

  // Samples that lack a wavelength are counted as holes. A sample weighs as much as the mean of its rows; standard
  // deviations are averaged in the square.
  void MoveTo(MeasurementBuilder* builder) const;

 private:
  struct Sample {
    Vec3 wi, wo;
    std::uint32_t line = 0;
    std::uint32_t rows = 0;
    double weights = 0;             // sum over the rows, of squares for standard deviations
    std::uint32_t next_repeat = 0;  // index of the pair's next sample, 0: none
  };

  Weights weights_;
  bool keep_repeats_;
  std::map<double, std::size_t> channels_;  // nanometres -> index into columns_
  std::vector<std::vector<double>> columns_;
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> first_sample_;  // one a pair
  PairIndex pairs_;
};

}  // namespace lobefit

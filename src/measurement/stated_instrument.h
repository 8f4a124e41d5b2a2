// What a file states of the instrument that made it, and the words in which files and options say so.
#pragma once

#include <optional>
#include <string_view>

namespace lobefit {

// Gains of the incident directions.
struct StatedDrift {
  std::optional<double> sd;  // relative standard deviation of a gain, in (0, 1]; empty: to be estimated
  bool operator==(const StatedDrift&) const = default;
};

// Noise of a reading f_r cos_theta_i.
struct StatedNoise {
  double floor = 0;     // standard deviation, 1/sr
  double relative = 0;  // of the reading, in (0, 1]
  double poisson = 0;   // 1/sr, the reading that one count stands for
  bool operator==(const StatedNoise&) const = default;
};

// Empty: not stated.
struct StatedInstrument {
  std::optional<double> source, detector;  // half angles of the discs that they fill, radians
  // With which uncertainty (a standard deviation, radians) these are stated.
  std::optional<double> source_prior, detector_prior;
  std::optional<double> detector_across;  // of a rectangular detector, across the meridian
  std::optional<bool> plain_mean;         // a value is the mean of f_r, else of the flux over the mean cosines
  std::optional<StatedDrift> drift;
  std::optional<double> alignment;  // by how much the sample may stand crooked, a standard deviation, radians
  std::optional<bool> offset;       // readings may be too high by a constant of each channel
  std::optional<StatedNoise> noise;
  bool operator==(const StatedInstrument&) const = default;
};

// "auto", or a number in (0, 1]; else empty.
std::optional<StatedDrift> ParseDrift(std::string_view word);

// "floor=0.002, relative=0.03, poisson=0.0001", each once: floor or poisson above 0, relative in (0, 1]; else empty.
std::optional<StatedNoise> ParseNoiseModel(std::string_view words);

}  // namespace lobefit

// Synthetic measurements: directions of a layout, values of a reflectance function as an instrument would see them,
// declared noise. Everything is seeded.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Pairs of directions to measure, in order.
struct DirectionList {
  std::vector<Vec3> wi, wo;
  std::size_t size() const { return wi.size(); }
  void Add(const Vec3& light, const Vec3& viewer) {
    wi.push_back(light);
    wo.push_back(viewer);
  }
};

// A goniometer: for each of `polar_angles` and `azimuths` (radians) of the light, a detector grid of polar rings at
// `detector_step` up to `theta_max`, each ring with as many azimuths as keep the step on the sphere, and a finer patch
// of half the step within 15 degrees of the mirror direction.
struct GoniometerLayout {
  std::vector<double> polar_angles, azimuths;
  double detector_step = 10 * kPi / 180;
  double theta_max = 80 * kPi / 180;
  bool in_plane = false;  // only detectors in the plane of incidence, at half the step
};
DirectionList Goniometer(const GoniometerLayout& layout);

// What an instrument does to the true values. The terms act in the order of the members; each draws from a stream of
// its own, so that switching one on does not change the others.
struct Noise {
  double multiplicative = 0;  // standard deviation of a normal factor about 1, independent a sample and channel
  double additive = 0;        // standard deviation of a normal term, 1/sr
  // Standard deviation of a normal factor about 1 that all samples and channels of one incident direction share.
  double drift = 0;
  // Counting noise: the reading f_r cos(theta_i) that one count stands for, 1/sr; counts are Poisson distributed.
  double poisson = 0;
  double outliers = 0;     // share of samples whose value is multiplied by a factor drawn log-uniformly from [1/10, 10]
  bool rectified = false;  // only the magnitude is kept
  double quantisation = 0;  // step to whose multiples values are rounded, 1/sr
  double holes = 0;         // share of samples that were not measured
  // Not random: detector and source average over discs of these half angles, radians, the flux over the mean cosines
  // or, with plain_mean, f_r itself.
  double aperture = 0, source = 0;
  double across = 0;  // above 0: the detector is a flat rectangle with this half angle across the meridian
  bool plain_mean = false;
  // Not random: the sample is turned about x, then about y, radians; the instrument reports directions as if it were
  // not.
  double misalignment_x = 0, misalignment_y = 0;
  // Standard deviation, radians, of a normal turn about each of x and y that a measurement draws on top of these.
  double misalignment = 0;

  bool operator==(const Noise&) const = default;
};

// One member of Noise as the command line, recipes of studies and documents know it.
struct NoiseTerm {
  const char* name;  // "multiplicative", "misalignment-x"
  const char* unit;  // "1", "1/sr", "deg", "flag"
  double Noise::*value;
  bool Noise::*flag;
  double highest;  // largest value allowed, outside unit; the smallest is 0, or -highest where `negative`
  bool negative;
  const char* description;
};
const std::vector<NoiseTerm>& NoiseTerms();

// "multiplicative=0.05,drift=0.03,rectified"; degrees for angles. Empty: no noise. Throws UsageError with the allowed
// terms.
Noise ParseNoise(const std::string& text);
// The terms that are not zero, in the same words.
std::string ToText(const Noise& noise);

// The noise of one measurement: what is drawn once for all its samples is drawn from `seed`, and is 0 in the result.
Noise DrawnNoise(const Noise& noise, std::uint64_t seed);

// f_r of `brdf` at the directions, with `noise` drawn from `seed`. Directions at or below the horizon are set aside,
// holes too. `lobe_width` as for WithAperture (instrument.h).
Measurement Synthesise(const DirectionList& directions, const Channels& channels, const BrdfFunction& brdf,
                       const Noise& noise, std::uint64_t seed, double lobe_width = 1e9);

// The same in two steps, for many draws of noise on one truth: values without random terms, then the random terms of
// `noise` on them. `noise` is one of a measurement (DrawnNoise).
Measurement TrueMeasurement(const DirectionList& directions, const Channels& channels, const BrdfFunction& brdf,
                            const Noise& noise, double lobe_width = 1e9);
void AddNoise(const Noise& noise, std::uint64_t seed, Measurement* measurement);

}  // namespace lobefit

// Synthetic measurements: directions of a layout, values of a reflectance function, declared noise. Everything is
// seeded.
#pragma once

#include <cstdint>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Pairs of directions to measure, in order.
struct DirectionList {
  std::vector<Vec3> wi, wo;
  std::size_t size() const { return wi.size(); }
};

// A goniometer: for each of `polar_angles` and `azimuths` (radians) of the light, a detector grid of polar rings at
// `detector_step` up to `theta_max`, each ring with as many azimuths as keep the step on the sphere, and a finer patch
// of half the step within 15 degrees of the mirror direction.
struct GoniometerLayout {
  std::vector<double> polar_angles, azimuths;
  double detector_step = 10 * kPi / 180;
  double theta_max = 80 * kPi / 180;
  bool in_plane = false;  // only detectors in the plane of incidence
};
DirectionList Goniometer(const GoniometerLayout& layout);

struct Noise {
  double multiplicative = 0;  // standard deviation of a normal factor about 1, independent a sample and channel
  double additive = 0;        // standard deviation of a normal term, 1/sr
};

// f_r of `brdf` at the directions, with noise drawn from `seed`. Directions at or below the horizon are set aside.
Measurement Synthesise(const DirectionList& directions, const Channels& channels, const BrdfFunction& brdf,
                       const Noise& noise, std::uint64_t seed);

}  // namespace lobefit

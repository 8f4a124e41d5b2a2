// Samples grouped by incident direction: what a goniometer calls one incidence, and the clusters of the sandwich
// covariance.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct Incidences {
  // Mean direction of each group, ordered by polar angle, then azimuth.
  std::vector<Vec3> wi;
  // group[sample] is an index into wi.
  std::vector<std::uint32_t> group;
};

// Groups samples whose incident directions agree to `resolution` radians in polar angle and azimuth (default 0.1
// degree). For an isotropic measurement the azimuth does not count and, as tables over half and difference angles have
// no list of incidences, the polar angles are binned to one degree.
Incidences GroupByIncidence(const Measurement& measurement, double resolution = 0.1 * kPi / 180);

// The azimuth in (-pi/2, pi/2] of the plane through the normal that holds every sample (to 1e-6 rad); nothing where
// there is none. Samples in one plane do not determine what is out of it.
std::optional<double> PlaneAzimuth(const Samples& samples);
bool IsInPlane(const Samples& samples);

}  // namespace lobefit

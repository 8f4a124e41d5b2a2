// Samples grouped by the direction that the instrument held while the other one moved, most often the incident one:
// what a goniometer calls one incidence, the clusters of the sandwich covariance, what a fold leaves out.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct Incidences {
  // Mean direction of each group, ordered by polar angle (to the resolution), then azimuth.
  std::vector<Vec3> wi;
  // group[sample] is an index into wi.
  std::vector<std::uint32_t> group;
};

// Groups samples whose incident directions lie within `resolution` radians of each other (default 0.1 degree), or are
// joined by a chain of such directions no longer than four times that; in linear time. For an isotropic measurement the
// azimuth does not count and, as tables over half and difference angles have no list of incidences, the polar angles
// are binned to one degree. Domain: resolution at least 1e-6.
//
// By the side that the file lists (Measurement::listed_side), or by the one given.
Incidences GroupByIncidence(const Measurement& measurement, double resolution = 0.1 * kPi / 180);
Incidences GroupByDirection(const Measurement& measurement, Beam side, double resolution = 0.1 * kPi / 180);

// The azimuth in (-pi/2, pi/2] of the plane through the normal that holds every sample (to 1e-6 rad); nothing where
// there is none. Samples in one plane do not determine what is out of it.
std::optional<double> PlaneAzimuth(const Samples& samples);
bool IsInPlane(const Samples& samples);

}  // namespace lobefit

// Levenberg-Marquardt for one texel: a dense problem of at most 11 unknowns, of which some are held.
#pragma once

#include "lobefit/maps/engine/objective.h"

namespace lobefit {

// Held and bounded unknowns of a texel.
struct MapBounds {
  bool normal_held = false, slope_held = false, width_held = false;
  AmplitudeBounds amplitudes;
  double least_width = 0, most_width = 0;  // of ln alpha, ln a, ln c
  double least_normal_z = 0.02, most_slope = 1;
};

// What is left to fit.
int FreeUnknowns(const MapModel& model, const MapBounds& bounds);

struct MapDescent {
  MapPoint point;
  double cost = 0;
  bool converged = false;
  int iterations = 0;
};

// Whether residuals reach the loss's width, where there may be many valleys and a quadratic says little of them.
bool IsRough(double cost, double loss, std::size_t lights);

// Ends where the step that remains promises less than `tolerance` of the cost; not converged where it comes to where
// `known` (unless null) is the end or, with residuals well below the loss's width, lies down the slope, or where
// `known` is better by much more than the steps still promise. Domain: start within the bounds.
inline constexpr double kFineTolerance = 1e-10, kCoarseTolerance = 3e-3;
MapDescent Descend(const MapModel& model, const TexelData& data, const MapPoint& start, const MapBounds& bounds,
                   double loss, TexelObjective* objective, double tolerance = kFineTolerance,
                   const MapDescent* known = nullptr);

// Which unknowns are held, or stand at a bound against which the cost falls (gradient as of Derivatives).
std::array<bool, kMostUnknowns> HeldUnknowns(const MapModel& model, const MapPoint& point, const MapBounds& bounds,
                                             const MapVector& gradient);

}  // namespace lobefit

// Where the descents of a texel begin.
#pragma once

#include <vector>

#include "lobefit/maps/engine/descent.h"

namespace lobefit {

// Least-squares Lambertian normal [Woodham 1980] of the lights whose mean over channels, `mean` (units of the scale),
// is at most 1: the 90th percentile, so that highlights stay out. Held away from the horizon. With the diffuse
// amplitudes that fit best.
MapPoint LambertStart(const MapModel& model, const TexelData& data, const std::vector<double>& mean,
                      const MapBounds& bounds, const MapPoint& fixed);

// The normal that mirrors the brightest lights into the camera: their half vectors, weighed by how much they exceed
// what the Lambertian point predicts.
Vec3 HighlightNormal(const TexelData& data, const std::vector<double>& mean, const MapPoint& lambert,
                     const MapBounds& bounds);

}  // namespace lobefit

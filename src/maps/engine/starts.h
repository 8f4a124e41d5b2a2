// Where the descents of a texel begin.
#pragma once

#include "lobefit/maps/engine/descent.h"

namespace lobefit {

// Least-squares Lambertian normal [Woodham 1980] of the lights whose mean over channels, `mean` (units of the scale, 0
// on padding), is at most 1: the 90th percentile, so that highlights stay out. Held away from the horizon. With the
// diffuse amplitudes that fit best. Then again under the weights that the loss gives that answer, where that lowers the
// cost. What is held is that of `held`. `weight`: room for the padded lights.
MapDescent LambertStart(const MapModel& model, const TexelData& data, const LightVector& mean, const MapBounds& bounds,
                        const MapPoint& held, double loss, TexelObjective* objective, LightVector* weight);

// The normal that mirrors the brightest lights into the cameras: their half vectors, weighed by how much they exceed
// what the Lambertian point predicts.
Vec3 HighlightNormal(const TexelData& data, const LightVector& mean, const MapPoint& lambert, const MapBounds& bounds);

}  // namespace lobefit

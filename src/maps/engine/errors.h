// Standard errors of a texel's unknowns.
#pragma once

#include "lobefit/maps/engine/descent.h"

namespace lobefit {

struct MapErrors {
  bool regular = false;       // the data determine all unknowns that are not held
  MapMatrix covariance = {};  // of the unknowns; NaN in rows and columns of held ones
};

// Sandwich of the whole second derivatives of the loss (with those of the model where it is linear) around the
// one-step jackknife over lights: what the solution moves by when a light is left out [MacKinnon and White 1985, HC3],
// the channels of one light together. Robust against noise that differs from light to light.
MapErrors ErrorsOf(const MapModel& model, const TexelData& data, const MapPoint& point, const MapBounds& bounds,
                   double loss, TexelObjective* objective);

}  // namespace lobefit

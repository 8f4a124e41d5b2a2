// Standard errors of a texel's unknowns.
#pragma once

#include "lobefit/maps/engine/descent.h"

namespace lobefit {

struct MapErrors {
  bool regular = false;       // the data determine all unknowns that are not held
  MapMatrix covariance = {};  // of the unknowns; NaN in rows and columns of held ones
};

// Sandwich of the whole second derivatives of the loss (with those of the model where it is linear) around what the
// solution moves by when a light is left out, the channels of one light together: kJackknife of the way from residuals
// as they are [White 1980, HC0], which understate errors, to the one-step jackknife [MacKinnon and White 1985, HC3],
// which overstates them where few lights decide. Robust against noise that differs from light to light.
MapErrors ErrorsOf(const MapModel& model, const TexelData& data, const MapPoint& point, const MapBounds& bounds,
                   double loss, TexelObjective* objective);

}  // namespace lobefit

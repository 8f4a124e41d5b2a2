// Standard errors of a texel's unknowns.
#pragma once

#include "lobefit/maps/engine/descent.h"

namespace lobefit {

struct MapErrors {
  bool regular = false;       // the data determine all unknowns that are not held
  MapMatrix covariance = {};  // of the unknowns; NaN in rows and columns of held ones
  double doubt = 0;           // see DoubtOf; NaN where one of the first two unknowns is held
};

// Sandwich of the whole second derivatives of the loss (with those of the model where it is linear) around what the
// solution moves by when a light is left out, the channels of one light together: kJackknife of the way from residuals
// as they are [White 1980, HC0], which understate errors, to the one-step jackknife [MacKinnon and White 1985, HC3],
// which overstates them where few lights decide. Robust against noise that differs from light to light.
MapErrors ErrorsOf(const MapModel& model, const TexelData& data, const MapPoint& point, const MapBounds& bounds,
                   double loss, TexelObjective* objective);

// How far the first two unknowns, turns of the normal, would be off if what the fit misses were no noise. Errors from
// independent residuals average over the lights and so say little of light between surfaces or a lobe of another shape,
// whose misfit changes slowly with the light. Here it is a share of the prediction that all channels have in common, as
// large as the residuals are, kSmoothShare of its variance smooth over directions of light [a Gaussian process, as in
// Kennedy and O'Hagan 2001].
double DoubtOf(const TexelData& data, const MapMatrix& inverse, int channels, TexelObjective* objective);

}  // namespace lobefit

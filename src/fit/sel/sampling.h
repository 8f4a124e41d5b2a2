// A model sampled so that a table of squared ellipsoidal lobes can be fitted to it.
#pragma once

#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// What a model gives on hemispheres of viewers at theta_i = 0, 10, ... 80 degrees (for models that are not isotropic at
// azimuths every 45 degrees): rings about the mirror direction, as dense as the narrowest lobe needs, and a grid of 10
// degrees. The measurement to which FitSel fits a table of a model.
Measurement SampleForSel(const Material& material);

}  // namespace lobefit

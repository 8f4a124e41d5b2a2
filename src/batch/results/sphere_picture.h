// The spheres of the overview: measured and fitted under one light, small.
#pragma once

#include <string>

#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct SpherePicture {
  std::string png;        // empty for a table of lobes
  bool measured = false;  // the measured sphere stands left of the fitted one
};

// Spheres of 64 pixels, in 6 bits a channel. A measured one only of isotropic measurements that speak for nearly the
// whole sphere, as in reports; the same exposure for both.
SpherePicture DrawSpheres(const Material& material, const Measurement& measurement);

}  // namespace lobefit

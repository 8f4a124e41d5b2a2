// The material of the round trips with three channels.
#pragma once

#include "tests/support/test_brdf.h"

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

inline const Channels kThreeChannels = {{"R", "G", "B"}, {}};

// Channels are 1, 1/2 and 1/4 of the material.
inline BrdfFunction Rgb(const TestBrdf& brdf) {
  return [brdf](const Vec3& wi, const Vec3& wo, double* values) {
    values[0] = brdf(wi, wo);
    values[1] = values[0] / 2;
    values[2] = values[0] / 4;
  };
}

}  // namespace lobefit

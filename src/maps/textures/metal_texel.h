// Whether a texel is a metal's or a coloured dielectric's, for models that have one base colour for both.
#pragma once

#include "lobefit/maps/textures/numbers.h"

namespace lobefit {

struct BaseNumbers {
  double metalness = 0;
  Color3 base = {0, 0, 0};  // of the metal and of the diffuse part below the dielectric
  Color3 f0 = {0, 0, 0};    // of the dielectric
};

// A metal where F0 is above kMostDielectric and metal and base of one colour, over a dielectric of reflectance
// `dielectric`, have F0 and diffuse within 0.01; else a dielectric with the texel's own F0 in every channel.
BaseNumbers BaseNumbersOf(const TexelNumbers& texel, double dielectric);

}  // namespace lobefit

// The loops over lights that take the time, compiled for several instruction sets and chosen at run time. The lanes and
// their order are the same in all of them, and products and sums stay separate instructions: so are the bits.
#pragma once

#include <cstddef>

#include "lobefit/maps/engine/lights.h"
#include "lobefit/maps/engine/model.h"

namespace lobefit {

// out[k] = sum over the padded lights of a[l] b[k][l].
void DotProducts(const double* a, const double* const* b, int count, std::size_t padded, double* out);

// What the isotropic lobe needs beside the lights: pointers of ShapeArrays; dspecular null: no derivatives.
struct IsotropicArrays {
  const double* cosine;
  double* specular;
  double* const* dspecular;  // 3
};
// shape.cc gives the formulas. `alpha`: the width.
void IsotropicLobe(double alpha, const MapFrame& frame, const LightArrays& lights, const IsotropicArrays& arrays);

}  // namespace lobefit

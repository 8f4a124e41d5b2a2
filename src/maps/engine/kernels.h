// The loops over lights that take the time, compiled for several instruction sets and chosen at run time. The lanes and
// their order are the same in all of them, and products and sums stay separate instructions: so are the bits.
#pragma once

#include <cstddef>

#include "lobefit/maps/engine/lights.h"
#include "lobefit/maps/engine/model.h"

namespace lobefit {

// out[k] = sum over the padded lights of a[l] b[k][l].
void DotProducts(const double* a, const double* const* b, int count, std::size_t padded, double* out);

void Multiply(const double* a, const double* b, std::size_t padded, double* out);

// A channel's amplitudes, in the texel's unit: diffuse cosine + (f0 + (carried - f0) k) specular.
struct Amplitudes {
  double diffuse, f0, carried;
};
// residual = live (prediction - value), and its square added to `square`.
void AddResiduals(const Amplitudes& amplitudes, const double* cosine, const double* specular, const double* k,
                  const double* live, const double* values, std::size_t padded, double* residual, double* square);
// column = derivative of the prediction, row += residual column.
void AddColumn(const Amplitudes& amplitudes, const double* dcosine, const double* dspecular, const double* k,
               const double* residual, std::size_t padded, double* column, double* row);

// What the isotropic lobe needs beside the lights: pointers of ShapeArrays; dspecular null: no derivatives.
struct IsotropicArrays {
  const double* cosine;
  double* specular;
  double* const* dspecular;  // 3
};
// shape.cc gives the formulas. `alpha`: the width.
void IsotropicLobe(double alpha, const MapFrame& frame, const LightArrays& lights, const IsotropicArrays& arrays);

}  // namespace lobefit

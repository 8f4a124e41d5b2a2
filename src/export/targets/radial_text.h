// What shader text looks up of a radial profile (profile.h) or Student's distribution (student.h): two functions of one
// number each, as polynomials in single precision.
#pragma once

#include <string>
#include <vector>

#include "lobefit/core/brdf/lobe.h"

namespace lobefit {

// A function by polynomials: of (x - from[i]) on [from[i], from[i + 1]), the last without end.
struct PiecewisePolynomial {
  std::vector<double> from;
  std::vector<std::vector<double>> coefficients;  // ascending powers
};

// ln of the density over GGX's with the same ellipse, in u = ln(1 + t), its mass included: exact.
PiecewisePolynomial ProfileExcess(const Profile& profile);

// M over GGX's M (profile_masking.h) in w = asinh(a), to 2e-7 of max(1, value), up to the last piece; beyond `end` it
// is exp(tail[0] + tail[1] (w - end) + tail[2] exp(-2 w)), or nothing where it is below 1e-9 there.
struct MaskingRatio {
  PiecewisePolynomial pieces;
  double end = 0;
  std::vector<double> tail;  // empty: 0
};
MaskingRatio MaskingRatioOf(const Lobe& lobe, const LobeShape& shape);

bool IsRadial(const Lobe& lobe);
// The functions `float PREFIXexcess(float u)` and `float PREFIXratio(float w)` of a radial lobe as text.
std::string RadialFunctions(const std::string& prefix, const Lobe& lobe, const LobeShape& shape);

}  // namespace lobefit

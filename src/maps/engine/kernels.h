// The loops over lights that take the time, compiled for several instruction sets and chosen at run time. The lanes and
// their order are the same in all of them, and products and sums stay separate instructions: so are the bits.
#pragma once

#include <array>
#include <cstddef>

#include "lobefit/maps/engine/lights.h"
#include "lobefit/maps/engine/model.h"

namespace lobefit {

using MapVector = std::array<double, kMostUnknowns>;
using MapMatrix = std::array<std::array<double, kMostUnknowns>, kMostUnknowns>;

// A channel's amplitudes, in the texel's unit: diffuse cosine + (f0 + (carried - f0) k) specular.
struct Amplitudes {
  double diffuse, f0, carried;
};

// Sums over lights of w A A, w A B, w B B, w A y and w B y, where A is the cosine, B = (1 - k) specular and y what
// remains of a value without carried k specular.
struct AmplitudeSums {
  double aa, ab, bb, ay, by;
};

// L = (a 0; b c) in the frame of the normal, and what the frame changes by where the normal turns along its axes.
struct TwoWidths {
  double a, b, c;
  MapFrame frame;
  MapFrame turned[2];
};

// Mean slopes of the lobe in the frame of the normal, and whether they, not turns of the normal, are the first two
// numbers of the shape.
struct MeanSlope {
  double x, y;
  bool is_free;
};

// What a texel's predictions are made of, over its padded lights: of shape.h, values, and how they are weighed.
struct LightTerms {
  int shape = 2, channels = 1;  // numbers of the shape (2: no lobe), channels (1 or 3)
  std::size_t padded = 0;
  const double *cosine = nullptr, *specular = nullptr, *k = nullptr, *live = nullptr;
  std::array<const double*, 2> dcosine = {};
  std::array<const double*, kMostShape> dspecular = {};
  std::array<const double*, kMostChannels> values = {};
  std::array<Amplitudes, kMostChannels> amplitudes = {};
  double loss = 1;
};

// Arrays of RowsOf: residuals r, weight w of the loss, coefficient of (J^T r)(J^T r)^T, and J^T r by unknowns.
struct RowArrays {
  std::array<double*, kMostChannels> residual = {};
  double *weight = nullptr, *bend = nullptr;
  std::array<double*, kMostUnknowns> rows = {};
};

// How the loss bends the second derivatives: not at all, so that the quadratic lies above the cost of a linear model
// (far from the minimum); clipped so that the matrix has no negative curvature (near it); or as it is (for errors).
enum class Curvature { kNone, kClipped, kWhole };

// shape.cc gives the formulas; 0 below the horizon. All but GeneralLobe take wo = +z.
void Cosines(const Vec3& normal, const LightArrays& lights, double* cosine);
void CosineDerivatives(const MapFrame& frame, const LightArrays& lights, double* by_t, double* by_b);
void IsotropicValue(double alpha, const Vec3& normal, const LightArrays& lights, double* cosine, double* specular);
// dspecular: 3 arrays.
void IsotropicGradient(double alpha, const MapFrame& frame, const LightArrays& lights, double* cosine, double* specular,
                       double* const* dcosine, double* const* dspecular);
// dspecular: 5 arrays, or null.
void AnisotropicLobe(const TwoWidths& widths, const LightArrays& lights, double* specular, double* const* dspecular);

// Any wo; what the lobe's G1 would exceed 1 by is cut off. dspecular as above.
void GeneralLobe(const TwoWidths& widths, const MeanSlope& slope, const LightArrays& lights, double* specular,
                 double* const* dspecular);

// By channels.
void SumAmplitudes(const LightTerms& terms, const double* weight, AmplitudeSums* sums);
// c^2 / 2 sum ln(1 + |r|^2 / c^2) with r of all channels of a light together.
double CostOf(const LightTerms& terms);
// The lights' weights in that loss, live / (1 + |r|^2 / c^2).
void WeightsOf(const LightTerms& terms, double* weight);
// The same, with what derivatives are made of; gradient by unknowns.
double RowsOf(const LightTerms& terms, Curvature curvature, const RowArrays& arrays, double* gradient);
// Adds sum w J^T J, below the diagonal.
void AddSquares(const LightTerms& terms, const double* weight, MapMatrix* matrix);
// Adds sum over lights of factor row_j row_k, below the diagonal.
void AddGram(const double* factor, const double* const* rows, int count, std::size_t padded, MapMatrix* matrix);
// Of the way from residuals as they are to the jackknife (errors.h): where 95 % intervals of both recipes hold between
// 93.5 and 96.5 % on synthetic hills (tests/maps/coverage_test.cc).
inline constexpr double kJackknife = 0.85;
// moved[j][l]: by how much unknown j moves with light l (errors.cc); `inverse` has zeros for held unknowns.
void MovesOf(const LightTerms& terms, const RowArrays& arrays, const MapMatrix& inverse, double* const* moved);
// pull[j][l], j < 2: by how much unknown j moves where the values of light l are off by all of the prediction.
void PullsOf(const LightTerms& terms, const RowArrays& arrays, const MapMatrix& inverse, double* const* pull);
// The quadratic form, of left and of right together, of a covariance between lights that is 1 at the same light;
// `share` of it falls smoothly with their angle, as bumps ((1 + cos) / 2)^8 about the centres overlap.
using BumpCenters = std::array<Vec3, 16>;
double SmoothSquares(const BumpCenters& centers, double share, const LightArrays& lights, const double* left,
                     const double* right);

}  // namespace lobefit

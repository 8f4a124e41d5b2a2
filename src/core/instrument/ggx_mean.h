// Means of GGX lobes over the discs of source and detector for arrays of samples, in SIMD with run-time dispatch, and
// the same for one sample: the closed form of ggx_mean-inl.h. mean_lobe.h evaluates every lobe.
#pragma once

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/instrument/aperture.h"

namespace lobefit {

// What the Fresnel factor is averaged through: its own power, exact for Schlick's, or the cosine, whose factor then
// stands for the factor's mean (an error of second order in the discs).
enum class FresnelArgument {
  kSchlickPower,  // (1 - cos_d)^5
  kCosine,        // cos_d
};

// What is uniform over the samples of a call.
struct GgxMeanRule {
  static constexpr int kMostNodes = 40, kPoints = 7;
  int nodes = 0;
  double tau[kMostNodes] = {}, weight[kMostNodes] = {};  // DiscNodes
  double detector_share = 1;
  // The seven points: each direction as the multiples of itself w, of e3 x w and of e3 that it is made of.
  struct Point {
    double o[3], i[3], weight;
  };
  Point points[kPoints] = {};
  bool flux = true;
  double inverse_cosines = 1;  // 1 / (cos^2(source / 2) cos^2(detector / 2))
  bool argument_is_cosine = false;
};
// `aperture` must not be a point; `nodes` as DiscNodeCount gives it, at most kMostNodes.
GgxMeanRule MakeGgxMeanRule(const Aperture& aperture, int nodes, FresnelArgument argument);

// Means of a lobe a sample. specular: of D G2 / (4 cos_i cos_o), 1/sr; argument: of the Fresnel argument, weighted by
// that. Gradients by the slope coordinates: 5 arrays of `count` each, one after the other; both null: not wanted.
struct LobeMeans {
  double* specular;
  double* argument;
  double* gradient;
  double* argument_gradient;
};

// The exact mean of D over both discs (one disc), times a D-weighted mean of the rest over seven points of the joint
// disc. Every direction must stay higher above the horizon than its disc. Error of the flux mean with one disc of 1
// degree: median 6e-10 to 7e-8 of the value, worst 1e-5; 5 degrees: 1e-5 and 1e-3; both discs of 1, 2, 5 degrees:
// median 7e-6, 4e-5, 3e-4, worst 9e-4, 2e-3, 1e-2. The plain mean: worst 3e-3 at 1 degree, not for lobes of a third of
// the disc's width.
void GgxMeanLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, Masking masking,
                 const GgxMeanRule& rule, const LobeMeans& means);
// One sample, the same bits; gradients may be null together.
double GgxMeanLobe(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking,
                   const GgxMeanRule& rule, double* argument, double gradient[5], double argument_gradient[5]);

// The mean of D(half(wi', wo')) over both discs: exact with one disc, with n nodes for two (aperture.h).
double GgxMeanD(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, const GgxMeanRule& rule,
                double gradient[5]);

}  // namespace lobefit

// The discs that a source and a detector fill as seen from the sample, and rules that average over them.
//
// A reading is an average of f_r over both discs. A disc of half angle delta has the solid angle 2 pi tau, tau = 1 -
// cos(delta). Detector flux over (irradiance x solid angle x cosine) is the flux mean < f_r cos_i cos_o > / (<cos_i>
// <cos_o>), where <cos> over a disc that stays above the horizon is cos(centre) cos^2(delta / 2), exactly.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

enum class ApertureMean {
  kFlux,   // < f_r cos_i cos_o > / (<cos_i> <cos_o>): what detectors measure
  kPlain,  // < f_r >
};

// Half angles in radians, each in [0, pi / 4]; 0: a point.
struct Aperture {
  double source = 0, detector = 0;
  ApertureMean mean = ApertureMean::kFlux;
  // Above 0: the detector is a flat rectangle that faces the sample, with the half angle `detector` along the meridian
  // and this one across it.
  double across = 0;
  bool any() const { return source > 0 || detector > 0; }
  bool operator==(const Aperture&) const = default;
};

// 1 - cos(half_angle) = 2 sin^2(half_angle / 2), without the subtraction.
double DiscTau(double half_angle);

// Share of a displacement of the half vector that the detector's direction makes: tau_d / (tau_s + tau_d). `aperture`
// must not be a point.
double DetectorShare(const Aperture& aperture);

// Both discs move the half vector by the same linear map, so that their joint effect is the convolution of two discs:
// exactly a mixture of concentric discs whose tau follows Wigner's semicircle of centre tau_s + tau_d and radius 2
// sqrt(tau_s tau_d), to first order in the angles. Its Gauss rule is Chebyshev's of the second kind: weights 2 sin^2 t
// / (n + 1) at tau_s + tau_d + 2 sqrt(tau_s tau_d) cos t, t = k pi / (n + 1).
struct DiscNode {
  double tau, weight;
};
// One node where one of the discs is a point; n >= 1.
std::vector<DiscNode> DiscNodes(const Aperture& aperture, int n);

// The smaller disc's (source, detector) half width in half vectors across the plane of incidence over the width of a
// lobe: delta / (2 alpha cos_d). With one disc that disc's; it says how much an aperture changes a lobe.
double RelativeDiscWidth(double half_angle, double alpha, double cos_d);

// ceil(2 + 2.4 w), w the relative width of the smaller disc: error of the mean of D below 2e-3 of it, with a median of
// 5e-7 (1017 integrals over both discs). 1 where one disc is a point, whose mean is exact. At most 40.
int DiscNodeCount(const Aperture& aperture, double alpha, double cos_d);

// A point of the unit disc, p in the plane of incidence and q across it; the weights sum to 1.
struct DiscPoint {
  double p, q, weight;
};
// Exact for polynomials of degree 5 (7 points).
const std::vector<DiscPoint>& SevenDiscPoints();
// `rings` Gauss-Legendre nodes in the squared radius with `azimuths` points each, odd rings turned by half a step.
std::vector<DiscPoint> DiscRings(int rings, int azimuths);

// A direction at a point of a disc of chord `chord` (sqrt(2 tau)) about it, on the sphere and so that equal areas of
// the unit disc are equal solid angles: multiples[0] w + multiples[1] e3 x w + multiples[2] e3, e3 as in PairFrame.
void SetDiscMultiples(const DiscPoint& point, double chord, double multiples[3]);

struct DirectionPair {
  Vec3 wi, wo;
};

// Unit axes of a pair: half vector h, e2 along wi - wo, e3 = h x e2 across the plane of incidence (any two axes across
// h where wi = wo), and h2 = |wi + wo|^2 / 2. wi != -wo.
struct PairFrame {
  Vec3 h, e2, e3;
  double h2;
};
PairFrame FrameOf(const DirectionPair& pair);

}  // namespace lobefit

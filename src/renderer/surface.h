// The reflectance models of renderers: GGX lobes in frames of their own, a diffuse part, and how they are combined.
// Sources and conventions: each target's own documents; Fresnel and masking as in core/fresnel.h and core/g2.h.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

using Color3 = std::array<double, 3>;  // linear R, G, B
// One number a channel: R, G, B, or the wavelengths of a spectral material.
using Spectrum = std::vector<double>;
inline Spectrum ToSpectrum(const Color3& color) { return {color[0], color[1], color[2]}; }

enum class SurfaceMasking {
  kHeightCorrelated,  // 1 / (1 + Lambda_i + Lambda_o), both widths (pbrt-v4, glTF)
  kSeparable,         // G1 G1 (Mitsuba 3)
  kMeanAlpha,         // height-correlated with alpha = sqrt(alpha_1 alpha_2) (MaterialX' GLSL)
};

struct SurfaceFresnel {
  enum class Kind { kSchlick, kConductor, kDielectric };
  Kind kind = Kind::kSchlick;
  Spectrum f0 = {0, 0, 0}, f90 = {1, 1, 1};  // kSchlick
  Spectrum f82 = {};                         // kSchlick: factor of the term at 82 degrees; empty: 1
  Spectrum eta = {1, 1, 1}, k = {0, 0, 0};   // kConductor; kDielectric takes eta[0]

  double operator()(std::size_t channel, double cos_d) const;
};

// D G F / (4 (n.wi)(n.wo)) times weight, in the frame of `normal` and the tangent at azimuth `rotation` made
// perpendicular to it; alpha_1 along the tangent. A renderer multiplies by the cosine to that normal, so that the f_r
// of the surface has (n.wi) / wi_z more.
struct SurfaceLobe {
  Widths widths;
  double rotation = 0;  // radians, counter-clockwise from x
  Vec3 normal = {0, 0, 1};
  SurfaceFresnel fresnel;
  double weight = 1;
  Spectrum tint = {};  // factor a channel, after the compensation of energy; empty: 1
};

struct Surface {
  std::vector<SurfaceLobe> lobes;
  SurfaceMasking masking = SurfaceMasking::kHeightCorrelated;
  // Each lobe times 1 + F (1 - E) / E, with E the albedo of an isotropic lobe of the mean alpha (MaterialX' GLSL).
  bool energy_compensation = false;
  int albedo_side = 64;          // of the quadratures of E, IsotropicAlbedo's
  Spectrum diffuse = {0, 0, 0};  // albedo, any mixing weight included; as long as every other Spectrum of the surface
  Vec3 diffuse_normal = {0, 0, 1};
  // Energy-preserving Oren-Nayar, as MaterialX' GLSL evaluates it: directions more than 90 degrees apart count as 90.
  double diffuse_roughness = 0;
  // What dims the diffuse part: nothing; the largest channel of Schlick's term of `layer` (glTF); the mean albedo of
  // lobes[layer_lobe] (OpenPBR in MaterialX).
  enum class Layering { kNone, kSchlick, kAlbedo };
  Layering layering = Layering::kNone;
  SurfaceFresnel layer;
  std::size_t layer_lobe = 0;
  // lobes[coat_lobe] lies over all others and the diffuse part, and dims them for the viewer's direction: by its mean
  // albedo (MaterialX' layer), or by its Fresnel term at that direction, which is its own reflectance too (glTF's clear
  // coat).
  enum class Coating { kNone, kAlbedo, kFresnel };
  Coating coating = Coating::kNone;
  std::size_t coat_lobe = 0;
};

// f_r in the channels of the surface.
BrdfFunction SurfaceBrdf(const Surface& surface);

// Albedo of an isotropic, height-correlated GGX lobe whose Fresnel term is f0 + (f90 - f0) (1 - c)^5: f0 a(mu) + f90
// b(mu), by quadrature over side x side visible normals, tabulated over mu. Side 64: 0.1 % of the albedo, 20 ms; 16: 1
// %, 1 ms.
class IsotropicAlbedo {
 public:
  explicit IsotropicAlbedo(double alpha, int side = 64);
  double operator()(double mu, double f0, double f90) const;

 private:
  std::vector<double> a_, b_;
};

// The index with reflectance fresnel(1) at normal incidence whose curve is nearest to `fresnel` (least squares over the
// cosine, weighted by it).
ConductorIndex NearestConductor(const std::function<double(double)>& fresnel);
// eta = 1 and the k of pbrt's `reflectance`: F(1) = r; r in [0, 0.9999].
ConductorIndex ConductorOfReflectance(double r);

// A lobe of the fit in the words of surfaces, a grey channel three times; Schlick's term with the fit's reflectance at
// normal incidence, times 1 / weight; its tint at 82 degrees where the weight is 1.
SurfaceLobe LobeOf(const FittedBrdf& fit, std::size_t lobe, double weight);
// The index whose Fresnel term is nearest to that of the fit's lobe over `share`, all channels; the fit's own where it
// is a conductor's and the share is 1.
SurfaceFresnel ConductorFresnelOf(const FittedBrdf& fit, std::size_t lobe, double share);
// The lobe with the largest reflectance, of those about the mirror direction where there is one, below a coat where
// there is another.
std::size_t StrongestLobe(const FittedBrdf& fit);
// The diffuse albedo; grey three times.
Spectrum DiffuseOf(const FittedBrdf& fit);
// For renderers whose coats dim what lies below for the viewer's direction only: the light's way in at normal incidence
// and the absorption both ways go into a lobe's colour; a Lambertian part has the way in in its mean, and takes the
// absorption. Null: not wanted.
void DimBelowCoat(const FittedBrdf& fit, std::size_t coat, SurfaceFresnel* fresnel, Spectrum* diffuse);

// Shares of a random choice between the diffuse part and the lobes (pbrt's mix, Mitsuba's blendbsdf): the diffuse part
// gets its largest albedo, the lobes share the rest by their reflectance. A share times a component is the component.
// A lobe that reflects less than 1e-5 at normal incidence or lies about the back direction has the share 0.
struct Shares {
  double diffuse = 0;
  std::vector<double> lobes;
};
Shares SharesOf(const FittedBrdf& fit);

// For renderers whose lobes all take the mesh's tangent: the rotation of the strongest lobe that has one.
double CommonRotation(const FittedBrdf& fit);

}  // namespace lobefit

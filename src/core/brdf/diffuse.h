// Diffuse parts that depend on the directions: below a smooth dielectric, and energy-preserving Oren-Nayar.
// (Lambertian microfacets: diffuse_facets.h.) Angles of directions above the horizon; a null gradient is skipped.
#pragma once

#include "lobefit/core/brdf/model.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// A Lambertian body of albedo rho below a smooth dielectric of index n, with all reflections inside [Elias 2001]:
//   f_r = rho (1 - F(cos_i)) (1 - F(cos_o)) / (pi n^2 (1 - rho F_in)),  F_in = 1 - (1 - F_ex) / n^2.
// Written by the apparent albedo rho' = (1 - F_in) rho / (1 - rho F_in), in which it is linear:
//   f_r = rho' (1 - F(cos_i)) (1 - F(cos_o)) / (pi (1 - F_ex)).
// Reciprocal. With the smooth reflection the directional albedo is F + (1 - F) rho' <= 1. n = 1 is Lambert. Domain: n
// >= 1, cosines in (0, 1], albedos in [0, 1].
struct InterfacedGradient {
  double dcos_i, dcos_o, dior, dapparent;
};
double InterfacedDiffuse(double cos_i, double cos_o, double ior, double apparent,
                         InterfacedGradient* gradient = nullptr);
// rho' of rho, with d rho' / d rho and d rho' / dn; and back.
double ApparentAlbedo(double rho, double ior, double* drho = nullptr, double* dior = nullptr);
double AlbedoBelowInterface(double apparent, double ior);

// Energy-preserving Oren-Nayar [Portsmouth, Kutz and Hill 2024, EON], as OpenPBR and MaterialX (energy compensation)
// have it: single scattering f_ss and what scatters again f_ms. Changed from print: f_ms without the quotient that is
// 0 / 0 at roughness 0. rho is the facets' albedo, roughness in [0, 1]; rho = 1 has albedo 1 at every angle. Kinks
// where wi and wo are perpendicular in azimuth and, on the same side, where their polar angles are equal: continuous,
// none in rho and roughness.
struct OrenNayar {
  double single, multiple;  // f_ss, f_ms, 1/sr
  double dsingle_dalbedo, dmultiple_dalbedo;
  double dsingle_droughness, dmultiple_droughness;
};
OrenNayar OrenNayarDiffuse(double albedo, double roughness, const Vec3& wi, const Vec3& wo);
// Directional albedo of single scattering for rho = 1: E_F(cos_theta).
double OrenNayarSingleAlbedo(double roughness, double cos_theta);
// Directional albedo of the whole, seen from cos_theta.
double OrenNayarAlbedo(double albedo, double roughness, double cos_theta);

// The diffuse part of one channel, made ready for many samples: of the kinds that depend on the directions but not on a
// lobe. `parameters` in the order of Parameters(model), its albedo the last.
class DirectionalDiffuse {
 public:
  DirectionalDiffuse(Diffuse kind, const double* parameters);
  // f_r, 1/sr; gradient by the parameters, null skips it.
  double Evaluate(const Vec3& wi, const Vec3& wo, double* gradient) const;
  // Of kInterfaced, in SIMD: f_r for an apparent albedo of 1, and the derivative of its logarithm by the index.
  void EvaluateInterfaced(const double* cos_i, const double* cos_o, std::size_t count, double* unit,
                          double* by_ior) const;
  // Whether `other` is the same but for its albedo.
  bool HasInterfaceOf(const DirectionalDiffuse& other) const { return first_ == other.first_; }
  double albedo() const { return albedo_; }

 private:
  Diffuse kind_;
  double first_, albedo_;  // index of the interface, or roughness
  double enters_ = 1, dF_ex_ = 0;
};
// kInterfaced and kOrenNayar; the others are a constant, or belong to a lobe (diffuse_facets.h).
bool IsDirectional(Diffuse kind);

}  // namespace lobefit

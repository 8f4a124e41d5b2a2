// A microfacet BRDF that gives back the energy which the first bounce loses.
//
// [Heitz] Heitz 2014 sec 7, eq 102-105: rho = rho_1 + rho_2+, with the norm of rho_2+ fixed by E_2+(wo) = 1 - albedo of
// rho_1 for F = 1 and rescaled by the mean visible Fresnel reflectance. Its shape is free; taken here is the one
// reciprocal product [Kelemen and Szirmay-Kalos 2001; Kulla and Conty 2017]
//   rho_2+(wo, wi) = K(wo) K(wi) / (pi Ebar),  K(w) = E_2+(w) Fbar(w),  Ebar = (1 / pi) int E_2+(w) (w.n) dw,
// which for F = 1 makes the white furnace test exact. Each path of rho_2+ reflects at least twice, first and last as
// seen from wo and wi.
#pragma once

#include <vector>

#include "lobefit/core/microfacet/energy.h"

namespace lobefit {

class EnergyCompensation {
 public:
  // Keeps a reference to `distribution`. The average is a product rule of nodes x nodes directions; `tolerance` is that
  // of each albedo. Costs nodes^2 albedos with gradient: about a second at the defaults, a minute where a lobe that
  // leans is clamped (the kink in the gradient is refined). Each evaluation costs four more integrals.
  EnergyCompensation(const NormalDistribution& distribution, const Shadowing& shadowing, FresnelOfCosine fresnel,
                     double tolerance = 1e-7, int nodes = 12);

  // Ebar and its gradient in the distribution's parameters.
  double mean_missing() const { return mean_missing_; }
  const std::vector<double>& dmean_missing() const { return dmean_missing_; }

  // rho_2+ and rho_1 + rho_2+, 1/sr; 0 below the horizon of either direction. Gradients in the distribution's
  // parameters; null skips.
  double MultipleScattering(const Vec3& wo, const Vec3& wi, double* gradient = nullptr) const;
  double Brdf(const Vec3& wo, const Vec3& wi, double* gradient = nullptr) const;

 private:
  double Lobe(const Vec3& w, double* gradient) const;  // K(w)

  const NormalDistribution& distribution_;
  Shadowing shadowing_;
  FresnelOfCosine fresnel_;
  double tolerance_;
  double mean_missing_ = 0.0;
  std::vector<double> dmean_missing_;
};

}  // namespace lobefit

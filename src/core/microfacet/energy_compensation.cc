#include "lobefit/core/microfacet/energy_compensation.h"

#include <algorithm>
#include <utility>

#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {

// Ebar = (1 / pi) int_0^1 int_0^2pi E mu dphi dmu; E is smooth in mu, not in mu^2.
EnergyCompensation::EnergyCompensation(const NormalDistribution& distribution, const Shadowing& shadowing,
                                       FresnelOfCosine fresnel, double tolerance, int nodes)
    : distribution_(distribution),
      shadowing_(shadowing),
      fresnel_(std::move(fresnel)),
      tolerance_(tolerance),
      dmean_missing_(static_cast<std::size_t>(distribution.parameters()), 0.0) {
  const QuadratureRule rule = GaussLegendre(nodes);
  double gradient[kMaxDistributionParameters];
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double mu = 0.5 * (1.0 + rule.nodes[i]);
    for (int j = 0; j < nodes; ++j) {
      const Vec3 w = FromSpherical(std::acos(mu), 2.0 * kPi * (j + 0.5) / nodes);
      const double weight = rule.weights[i] * mu / nodes;
      mean_missing_ += weight * EnergyMissing(distribution, shadowing, w, gradient, tolerance);
      for (std::size_t k = 0; k < dmean_missing_.size(); ++k) dmean_missing_[k] += weight * gradient[k];
    }
  }
}

double EnergyCompensation::Lobe(const Vec3& w, double* gradient) const {
  double dE[kMaxDistributionParameters], dF[kMaxDistributionParameters];
  const bool derivatives = gradient != nullptr;
  const double E = EnergyMissing(distribution_, shadowing_, w, derivatives ? dE : nullptr, tolerance_);
  const double F = MeanVisibleFresnel(distribution_, fresnel_, w, derivatives ? dF : nullptr, tolerance_);
  if (derivatives) {
    for (int k = 0; k < distribution_.parameters(); ++k) gradient[k] = dE[k] * F + E * dF[k];
  }
  return E * F;
}

double EnergyCompensation::MultipleScattering(const Vec3& wo, const Vec3& wi, double* gradient) const {
  const int count = distribution_.parameters();
  if (!(wo.z > 0 && wi.z > 0)) {
    if (gradient != nullptr) std::fill(gradient, gradient + count, 0.0);
    return 0.0;
  }
  double d_o[kMaxDistributionParameters], d_i[kMaxDistributionParameters];
  const bool derivatives = gradient != nullptr;
  const double K_o = Lobe(wo, derivatives ? d_o : nullptr), K_i = Lobe(wi, derivatives ? d_i : nullptr);
  const double scale = kInvPi / mean_missing_;
  const double value = K_o * K_i * scale;
  if (derivatives) {
    for (int k = 0; k < count; ++k) {
      gradient[k] =
          (d_o[k] * K_i + K_o * d_i[k]) * scale - value * dmean_missing_[static_cast<std::size_t>(k)] / mean_missing_;
    }
  }
  return value;
}

double EnergyCompensation::Brdf(const Vec3& wo, const Vec3& wi, double* gradient) const {
  double specular_gradient[kMaxDistributionParameters], cos_d;
  const double multiple = MultipleScattering(wo, wi, gradient);
  const double specular =
      MicrofacetSpecular(distribution_, shadowing_, wo, wi, gradient != nullptr ? specular_gradient : nullptr, &cos_d);
  const double F = fresnel_(cos_d);
  if (gradient != nullptr) {
    for (int k = 0; k < distribution_.parameters(); ++k) gradient[k] += F * specular_gradient[k];
  }
  return F * specular + multiple;
}

}  // namespace lobefit

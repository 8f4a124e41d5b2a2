#include "lobefit/core/microfacet/diffuse_microfacets.h"

#include <algorithm>

#include "lobefit/core/microfacet/visible_quadrature.h"

namespace lobefit {

double DiffuseMicrofacetBrdf(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                             const Vec3& wi, double* gradient, double tolerance) {
  constexpr std::size_t kMax = kMaxDistributionParameters;
  const auto count = static_cast<std::size_t>(distribution.parameters());
  if (!(wo.z > 0 && wi.z > 0)) {
    if (gradient != nullptr) std::fill(gradient, gradient + count, 0.0);
    return 0.0;
  }
  const VisiblePolar polar(distribution.Outline(), wo, VisibleNormals::kFacing, wi);
  const double scale = kInvPi / (wo.z * wi.z);
  const auto weight = [&](const Vec3& m) { return scale * std::max(0.0, Dot(wo, m)) * std::max(0.0, Dot(wi, m)); };
  if (gradient == nullptr) {
    const auto f = [&](const Vec3& m) {
      return std::array<double, 1>{weight(m) * MaskingShadowingG2(distribution, shadowing, wo, wi, m) *
                                   distribution.D(m)};
    };
    return IntegrateVisibleNormals<1>(polar, f, tolerance)[0];
  }
  const auto f = [&](const Vec3& m) {
    double dD[kMax], dG2[kMax];
    const double w = weight(m), D = distribution.D(m, dD),
                 G2 = MaskingShadowingG2(distribution, shadowing, wo, wi, m, dG2);
    std::array<double, kMax + 1> value{};
    value[0] = w * G2 * D;
    for (std::size_t k = 0; k < count; ++k) value[1 + k] = w * (dG2[k] * D + G2 * dD[k]);
    return value;
  };
  const auto integral = IntegrateVisibleNormals<kMax + 1>(polar, f, tolerance);
  std::copy_n(integral.begin() + 1, count, gradient);
  return integral[0];
}

}  // namespace lobefit

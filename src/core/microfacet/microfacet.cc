#include "lobefit/core/microfacet/microfacet.h"

#include <algorithm>

namespace lobefit {
namespace {

constexpr std::size_t kMax = kMaxDistributionParameters;

// Kinds that do not know the distribution.
double ShapelessG1(const Shadowing& shadowing, const Vec3& w, const Vec3& wm) {
  switch (shadowing.masking) {
    case Masking::kVCavity:
      return VCavityG1(w, wm);
    case Masking::kImplicit:
      return ImplicitG1(w);
    case Masking::kSchlickSmith:
      return SchlickSmithG1(w, shadowing.schlick_m);
    default:
      return KelemenG1(w, wm);
  }
}

}  // namespace

double MaskingLambda(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& w,
                     double* gradient, bool* cut) {
  const double Lambda = distribution.Lambda(w, gradient);
  const bool negative = Lambda < 0 && shadowing.masking != Masking::kSmithUnclamped;
  if (cut != nullptr) *cut = negative;
  if (!negative) return Lambda;
  if (gradient != nullptr) std::fill(gradient, gradient + distribution.parameters(), 0.0);
  return 0.0;
}

double MaskingG1(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& w, const Vec3& wm,
                 double* gradient) {
  const int count = distribution.parameters();
  if (!(Dot(w, wm) > 0) || !IsSmith(shadowing.masking)) {
    if (gradient != nullptr) std::fill(gradient, gradient + count, 0.0);
    return Dot(w, wm) > 0 ? ShapelessG1(shadowing, w, wm) : 0.0;
  }
  const double value = 1.0 / (1.0 + MaskingLambda(distribution, shadowing, w, gradient));
  if (gradient != nullptr) {
    for (int k = 0; k < count; ++k) gradient[k] *= -value * value;
  }
  return value;
}

double MaskingShadowingG2(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                          const Vec3& wi, const Vec3& wm, double* gradient) {
  const int count = distribution.parameters();
  const bool facing = Dot(wo, wm) > 0 && Dot(wi, wm) > 0;
  if (!facing || !IsSmith(shadowing.masking)) {
    if (gradient != nullptr) std::fill(gradient, gradient + count, 0.0);
    if (!facing) return 0.0;
    const double go = ShapelessG1(shadowing, wo, wm), gi = ShapelessG1(shadowing, wi, wm);
    return shadowing.masking == Masking::kVCavity ? std::min(go, gi) : go * gi;
  }
  double dLambda_o[kMax], dLambda_i[kMax];
  const bool derivatives = gradient != nullptr;
  const double Lambda_o = MaskingLambda(distribution, shadowing, wo, derivatives ? dLambda_o : nullptr);
  const double Lambda_i = MaskingLambda(distribution, shadowing, wi, derivatives ? dLambda_i : nullptr);
  SmithG2Gradient g;
  const double value = SmithG2(shadowing.masking, Lambda_o, Lambda_i, VanGinnekenLambda(AzimuthDifference(wo, wi)),
                               derivatives ? &g : nullptr);
  if (derivatives) {
    for (int k = 0; k < count; ++k) gradient[k] = g.dLambda_o * dLambda_o[k] + g.dLambda_i * dLambda_i[k];
  }
  return value;
}

double MicrofacetSpecular(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                          const Vec3& wi, double* gradient, double* cos_d) {
  const int count = distribution.parameters();
  const Vec3 sum = wo + wi;
  const double length = Norm(sum);
  if (cos_d != nullptr) *cos_d = std::min(1.0, 0.5 * length);
  if (!(wo.z > 0 && wi.z > 0)) {
    if (gradient != nullptr) std::fill(gradient, gradient + count, 0.0);
    return 0.0;
  }
  const Vec3 wh = (1.0 / length) * sum;
  double dD[kMax], dG2[kMax];
  const bool derivatives = gradient != nullptr;
  const double D = distribution.D(wh, derivatives ? dD : nullptr);
  const double G2 = MaskingShadowingG2(distribution, shadowing, wo, wi, wh, derivatives ? dG2 : nullptr);
  const double scale = 0.25 / (wo.z * wi.z);
  if (derivatives) {
    for (int k = 0; k < count; ++k) gradient[k] = scale * (dD[k] * G2 + D * dG2[k]);
  }
  return scale * D * G2;
}

}  // namespace lobefit

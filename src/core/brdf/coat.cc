#include "lobefit/core/brdf/coat.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/microfacet/microfacet.h"
#include "lobefit/core/ndf/normal_distribution.h"
#include "lobefit/core/radial/smith.h"

namespace lobefit {

// u'_z = sqrt(n^2 - 1 + u_z^2) / n: no cancellation near n = 1 or at grazing.
Vec3 Refracted(const Vec3& u, double ior, Vec3* dior) {
  const double root = std::sqrt((ior - 1.0) * (ior + 1.0) + u.z * u.z);
  const Vec3 inside = {u.x / ior, u.y / ior, root / ior};
  if (dior != nullptr) {
    const double sine2 = u.x * u.x + u.y * u.y, nn = ior * ior;
    *dior = {-u.x / nn, -u.y / nn, sine2 / (nn * root)};
  }
  return inside;
}

CoatPassage PassThroughCoat(double ior, bool refracted, const Vec3& wi, const Vec3& wo) {
  double dTi, dTo;
  const double T_i = DielectricTransmittance(wi.z, ior, nullptr, &dTi);
  const double T_o = DielectricTransmittance(wo.z, ior, nullptr, &dTo);
  CoatPassage p = {T_i * T_o, 2, dTi / T_i + dTo / T_o, 0, wi, wo, {}, {}};
  if (!refracted) return p;
  p.clear /= ior * ior;
  p.dlog_clear_dior -= 2.0 / ior;
  p.inside_i = Refracted(wi, ior, &p.dinside_i_dior);
  p.inside_o = Refracted(wo, ior, &p.dinside_o_dior);
  const double zi = p.inside_i.z, zo = p.inside_o.z;
  p.path = 1.0 / zi + 1.0 / zo;
  p.dpath_dior = -p.dinside_i_dior.z / (zi * zi) - p.dinside_o_dior.z / (zo * zo);
  return p;
}

double LambertBelowCoat(double ior, bool refracted, double* dior) {
  double dF_ex;
  const double enters = 1.0 - DielectricMeanReflectance(ior, &dF_ex);
  const double value = (refracted ? ior * ior : 1.0) * kInvPi / enters;
  if (dior != nullptr) *dior = value * (dF_ex / enters + (refracted ? 2.0 / ior : 0.0));
  return value;
}

CoatFactors EvaluateCoat(const Coat& coat, const Vec3& wi, const Vec3& wo) {
  const SlopeNormalDistribution distribution({Family::kGgx, coat.alpha, coat.alpha, 0.0, 0.0, 0.0});
  double by_shape[kSlopeParameters], cos_d, dF_dior;
  const double specular = MicrofacetSpecular(distribution, {}, wo, wi, by_shape, &cos_d);
  const double F = FresnelDielectric(cos_d, coat.ior, nullptr, &dF_dior);
  CoatFactors f = {};
  f.lobe = specular * F;
  f.dlobe_dalpha = F * (by_shape[0] + by_shape[1]);
  f.dlobe_dior = specular * dF_dior;
  const CoatPassage passage = PassThroughCoat(coat.ior, coat.refracted, wi, wo);
  f.through = passage.clear * std::exp(-coat.tau * passage.path);
  f.dthrough_dior = f.through * (passage.dlog_clear_dior - coat.tau * passage.dpath_dior);
  f.dthrough_dtau = -f.through * passage.path;
  f.inside_i = passage.inside_i;
  f.inside_o = passage.inside_o;
  f.dinside_i_dior = passage.dinside_i_dior;
  f.dinside_o_dior = passage.dinside_o_dior;
  return f;
}

DirectionalSpecular SpecularWithDirections(const SlopeDistribution& slopes, double f0, const Vec3& wi, const Vec3& wo) {
  const Vec3 sum = wi + wo;
  const double length = Norm(sum), cos_d = std::min(1.0, 0.5 * length);
  const Vec3 wh = (1.0 / length) * sum;
  double dD[kSlopeParameters];
  Vec3 dD_dwm;
  const double D = SlopeDistributionD(slopes, wh, dD, &dD_dwm);
  // 1 / (G1 / cos) = max(sigma, cos), with its derivatives.
  struct Area {
    double value;
    double by_shape[kSlopeParameters];
    Vec3 by_direction;
  };
  const auto area = [&](const Vec3& u) {
    Area a = {};
    const double sigma = SmithSigma(slopes, u, a.by_shape, &a.by_direction);
    bool clamped;
    SmithG1Clamped(slopes, u, nullptr, &clamped);
    a.value = clamped ? u.z : sigma;
    if (clamped) {
      std::fill_n(a.by_shape, kSlopeParameters, 0.0);
      a.by_direction = {0, 0, 1};
    }
    return a;
  };
  const Area i = area(wi), o = area(wo);
  double dF_dc, dF_df0;
  const double F = FresnelSchlick(cos_d, f0, &dF_dc, &dF_df0);
  const double specular = D / (4.0 * i.value * o.value), value = specular * F;
  DirectionalSpecular result = {};
  result.value = value;
  result.df0 = specular * dF_df0;
  for (int k = 0; k < kSlopeParameters; ++k)
    result.by_shape[k] = value * (dD[k] / D - i.by_shape[k] / i.value - o.by_shape[k] / o.value);
  // Through the half vector: wh = sum / |sum|, cos_d = |sum| / 2.
  const Vec3 by_wh = (F / (4.0 * i.value * o.value * length)) * (dD_dwm - Dot(dD_dwm, wh) * wh);
  const Vec3 by_sum = by_wh + (0.5 * specular * dF_dc) * wh;
  result.dwi = by_sum - (value / i.value) * i.by_direction;
  result.dwo = by_sum - (value / o.value) * o.by_direction;
  return result;
}

}  // namespace lobefit

#include "lobefit/core/brdf/diffuse.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/fresnel/fresnel.h"

namespace lobefit {
namespace {

// Of Oren-Nayar: C1 = 1/2 - 2/(3 pi), C2 = 2/3 - 28/(15 pi), C1 - C2 = 6/(5 pi) - 1/6.
constexpr double kC1 = 0.5 - 2.0 / (3.0 * kPi);
constexpr double kC2 = 2.0 / 3.0 - 28.0 / (15.0 * kPi);
constexpr double kC1MinusC2 = 6.0 / (5.0 * kPi) - 1.0 / 6.0;

// C1 - G(c): what of a rough facet's light is not scattered singly. In asin c and 1 - sin: no cancellation at grazing.
double SingleLoss(double c) {
  const double sn = std::sqrt((1.0 - c) * (1.0 + c)), rest = c * c / (1.0 + sn);  // 1 - sin
  return kInvPi * ((0.5 * kPi - 2.0 / 3.0) * rest +
                   sn * (std::asin(c) + c * (sn - 2.0 / 3.0 * (1.0 + sn + sn * sn) / (1.0 + sn))));
}

double SingleScale(double roughness) { return 1.0 / (1.0 + kC1 * roughness); }

// With 1 - F_ex and dF_ex / dn.
double Interfaced(double cos_i, double cos_o, double ior, double apparent, double enters, double dF_ex,
                  InterfacedGradient* gradient) {
  double dTi_dc, dTi_dn, dTo_dc, dTo_dn;
  const double T_i = DielectricTransmittance(cos_i, ior, &dTi_dc, &dTi_dn);
  const double T_o = DielectricTransmittance(cos_o, ior, &dTo_dc, &dTo_dn);
  const double unit = T_i * T_o * kInvPi / enters;
  if (gradient != nullptr) {
    const double f = apparent * unit;
    *gradient = {f * dTi_dc / T_i, f * dTo_dc / T_o, f * (dTi_dn / T_i + dTo_dn / T_o + dF_ex / enters), unit};
  }
  return apparent * unit;
}

}  // namespace

double InterfacedDiffuse(double cos_i, double cos_o, double ior, double apparent, InterfacedGradient* gradient) {
  double dF_ex;
  const double enters = 1.0 - DielectricMeanReflectance(ior, &dF_ex);
  return Interfaced(cos_i, cos_o, ior, apparent, enters, dF_ex, gradient);
}

double ApparentAlbedo(double rho, double ior, double* drho, double* dior) {
  double dF_ex;
  const double enters = 1.0 - DielectricMeanReflectance(ior, &dF_ex), nn = ior * ior;
  const double leaves = enters / nn;                // 1 - F_in
  const double total = (1.0 - rho) + rho * leaves;  // 1 - rho F_in
  if (drho != nullptr) *drho = leaves / (total * total);
  if (dior != nullptr) *dior = -rho * (1.0 - rho) / (total * total) * (dF_ex + 2.0 * enters / ior) / nn;
  return leaves * rho / total;
}

double AlbedoBelowInterface(double apparent, double ior) {
  const double leaves = (1.0 - DielectricMeanReflectance(ior)) / (ior * ior);
  return apparent / (leaves + apparent * (1.0 - leaves));
}

OrenNayar OrenNayarDiffuse(double albedo, double roughness, const Vec3& wi, const Vec3& wo) {
  const double A = SingleScale(roughness), E = A * (1.0 + kC2 * roughness), lost = A * roughness * kC1MinusC2;  // 1 - E
  const double s = wi.x * wo.x + wi.y * wo.y;  // wi . wo - cos_i cos_o
  const double st = s > 0 ? s / std::max(wi.z, wo.z) : s;
  const double back = kInvPi * A * (1.0 + roughness * st);
  // f_ms = X A R (C1 - G_i) (C1 - G_o) / (pi (C1 - C2)), X = rho^2 E / (1 - rho (1 - E)).
  const double series = 1.0 - albedo * lost, X = albedo * albedo * E / series;
  const double angular = kInvPi * A * SingleLoss(wi.z) * SingleLoss(wo.z) / kC1MinusC2;
  const double dE = A * (kC2 - kC1 * E);
  OrenNayar result;
  result.single = albedo * back;
  result.multiple = X * angular * roughness;
  result.dsingle_dalbedo = back;
  result.dmultiple_dalbedo = albedo * E * (2.0 - albedo * lost) / (series * series) * angular * roughness;
  result.dsingle_droughness = albedo * kInvPi * A * (st - kC1 * A * (1.0 + roughness * st));
  result.dmultiple_droughness = X * angular + result.multiple * (dE * (1.0 / E - albedo / series) - kC1 * A);
  return result;
}

double OrenNayarSingleAlbedo(double roughness, double cos_theta) {
  return 1.0 - SingleScale(roughness) * roughness * SingleLoss(cos_theta);
}

double OrenNayarAlbedo(double albedo, double roughness, double cos_theta) {
  const double A = SingleScale(roughness), E = A * (1.0 + kC2 * roughness);
  const double X = albedo * albedo * E / (1.0 - albedo * (1.0 - E)),
               single = OrenNayarSingleAlbedo(roughness, cos_theta);
  return albedo * single + X * (1.0 - single);
}

bool IsDirectional(Diffuse kind) { return kind == Diffuse::kInterfaced || kind == Diffuse::kOrenNayar; }

DirectionalDiffuse::DirectionalDiffuse(Diffuse kind, const double* parameters)
    : kind_(kind), first_(parameters[0]), albedo_(parameters[1]) {
  if (kind == Diffuse::kInterfaced) enters_ = 1.0 - DielectricMeanReflectance(first_, &dF_ex_);
}

double DirectionalDiffuse::Evaluate(const Vec3& wi, const Vec3& wo, double* gradient) const {
  if (kind_ == Diffuse::kOrenNayar) {
    const OrenNayar f = OrenNayarDiffuse(albedo_, first_, wi, wo);
    if (gradient != nullptr) {
      gradient[0] = f.dsingle_droughness + f.dmultiple_droughness;
      gradient[1] = f.dsingle_dalbedo + f.dmultiple_dalbedo;
    }
    return f.single + f.multiple;
  }
  InterfacedGradient g;
  const double value = Interfaced(wi.z, wo.z, first_, albedo_, enters_, dF_ex_, gradient != nullptr ? &g : nullptr);
  if (gradient != nullptr) gradient[0] = g.dior, gradient[1] = g.dapparent;
  return value;
}

}  // namespace lobefit

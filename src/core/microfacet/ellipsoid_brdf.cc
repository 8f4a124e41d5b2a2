#include "lobefit/core/microfacet/ellipsoid_brdf.h"

#include <algorithm>

namespace lobefit {
namespace {

constexpr std::size_t kShape = kEllipsoidParameters;

struct Masked {
  double value;
  double gradient[kShape];
  Vec3 du;
  bool clamped;
};

// G1 / cos = 1 / sigma, or 1 / cos where clamped: the quotient that the BRDF needs, without a division by cos that the
// masking undoes.
Masked MaskingOverCosine(const EllipsoidFrame& frame, const Vec3& u, Masking masking, bool derivatives) {
  Masked g;
  const double sigma = frame.Sigma(u, derivatives ? g.gradient : nullptr, derivatives ? &g.du : nullptr);
  g.clamped = frame.Clamped(u);
  if (g.clamped && masking == Masking::kSmithSeparable) {
    g.value = 1.0 / u.z;
    std::fill(g.gradient, g.gradient + kShape, 0.0);
    g.du = {0.0, 0.0, -g.value * g.value};
    return g;
  }
  g.value = 1.0 / sigma;
  if (derivatives) {
    for (double& d : g.gradient) d *= -g.value * g.value;
    g.du = (-g.value * g.value) * g.du;
  }
  return g;
}

// The factor of F with its derivatives, and c = wo.wh.
struct Specular {
  double value, c;
  double gradient[kShape];
  Vec3 wh;
  BrdfDirectionGradient direction;
  BrdfFactors factors;
};

Vec3 Perpendicular(const Vec3& w, const Vec3& v) { return v - Dot(w, v) * w; }

Specular EvaluateSpecular(const Ellipsoid& ellipsoid, const Vec3& wo, const Vec3& wi, Masking masking,
                          bool derivatives) {
  Specular s;
  const EllipsoidFrame frame(ellipsoid);
  const Vec3 sum = wo + wi;
  const double length = Norm(sum);
  s.wh = (1.0 / length) * sum;
  s.c = std::min(1.0, 0.5 * length);  // |wo + wi| / 2 = wo.wh, symmetric in the two
  double dD[kShape];
  Vec3 dD_dwh;
  const double D = frame.D(s.wh, derivatives ? dD : nullptr, derivatives ? &dD_dwh : nullptr);
  const Masked o = MaskingOverCosine(frame, wo, masking, derivatives),
               i = MaskingOverCosine(frame, wi, masking, derivatives);
  const double G2 = o.value * i.value;
  s.value = 0.25 * D * G2;
  s.factors = {D, o.value * wo.z, i.value * wi.z, 0.0, o.clamped, i.clamped};
  if (derivatives) {
    for (std::size_t k = 0; k < kShape; ++k) {
      s.gradient[k] = 0.25 * (dD[k] * G2 + D * (o.gradient[k] * i.value + i.gradient[k] * o.value));
    }
    const Vec3 through_half = (0.25 * G2 / length) * Perpendicular(s.wh, dD_dwh);
    s.direction.wo = through_half + (0.25 * D * i.value) * o.du;
    s.direction.wi = through_half + (0.25 * D * o.value) * i.du;
  }
  return s;
}

// Puts the Fresnel factor onto the rest: f = F s, dF/dwo = dF/dc wh / 2.
double WithFresnel(const Specular& s, double F, double dF_dc, double* gradient, BrdfFactors* factors,
                   BrdfDirectionGradient* direction_gradient) {
  if (gradient != nullptr) {
    for (std::size_t k = 0; k < kShape; ++k) gradient[k] = F * s.gradient[k];
  }
  if (factors != nullptr) {
    *factors = s.factors;
    factors->F = F;
  }
  if (direction_gradient != nullptr) {
    const Vec3 fresnel = (0.5 * s.value * dF_dc) * s.wh;
    *direction_gradient = {F * s.direction.wo + fresnel, F * s.direction.wi + fresnel};
  }
  return F * s.value;
}

double BelowHorizon(int parameters, double* gradient, BrdfFactors* factors, BrdfDirectionGradient* direction_gradient) {
  if (gradient != nullptr) std::fill(gradient, gradient + parameters, 0.0);
  if (factors != nullptr) *factors = {0, 0, 0, 0, false, false};
  if (direction_gradient != nullptr) *direction_gradient = {{0, 0, 0}, {0, 0, 0}};
  return 0.0;
}

}  // namespace

double EllipsoidConductorBrdf(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi,
                              Masking masking, double* gradient, BrdfFactors* factors,
                              BrdfDirectionGradient* direction_gradient) {
  if (!(wo.z > 0 && wi.z > 0)) return BelowHorizon(7, gradient, factors, direction_gradient);
  const bool derivatives = gradient != nullptr || direction_gradient != nullptr;
  const Specular s = EvaluateSpecular(ellipsoid, wo, wi, masking, derivatives);
  ConductorFresnelGradient dF{};
  const double F = FresnelConductor(s.c, index, derivatives ? &dF : nullptr);
  if (gradient != nullptr) {
    gradient[5] = s.value * dF.deta;
    gradient[6] = s.value * dF.dk;
  }
  return WithFresnel(s, F, dF.dc, gradient, factors, direction_gradient);
}

double EllipsoidSchlickBrdf(const Ellipsoid& ellipsoid, double f0, const Vec3& wo, const Vec3& wi, Masking masking,
                            double* gradient, BrdfFactors* factors, BrdfDirectionGradient* direction_gradient) {
  if (!(wo.z > 0 && wi.z > 0)) return BelowHorizon(6, gradient, factors, direction_gradient);
  const bool derivatives = gradient != nullptr || direction_gradient != nullptr;
  const Specular s = EvaluateSpecular(ellipsoid, wo, wi, masking, derivatives);
  double dF_dc, dF_df0;
  const double F = FresnelSchlick(s.c, f0, &dF_dc, &dF_df0);
  if (gradient != nullptr) gradient[5] = s.value * dF_df0;
  return WithFresnel(s, F, dF_dc, gradient, factors, direction_gradient);
}

double LambertBrdf(double albedo, const Vec3& wo, const Vec3& wi, double* df_dalbedo) {
  const double scale = wo.z > 0 && wi.z > 0 ? kInvPi : 0.0;
  if (df_dalbedo != nullptr) *df_dalbedo = scale;
  return albedo * scale;
}

}  // namespace lobefit

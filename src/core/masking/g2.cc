#include "lobefit/core/masking/g2.h"

#include <algorithm>

namespace lobefit {

double SmithG2(Masking masking, double Lambda_o, double Lambda_i, double lambda, SmithG2Gradient* gradient) {
  const double go = 1.0 / (1.0 + Lambda_o), gi = 1.0 / (1.0 + Lambda_i);
  const bool o_is_larger = Lambda_o >= Lambda_i;
  double value = 0.0;
  SmithG2Gradient g{0.0, 0.0, 0.0};
  switch (masking) {
    case Masking::kSmithSeparable:
    case Masking::kSmithUnclamped:
      value = 1.0 / ((1.0 + Lambda_o) * (1.0 + Lambda_i));
      g = {-value * go, -value * gi, 0.0};
      break;
    case Masking::kSmithHeight:
      value = 1.0 / (1.0 + (Lambda_o + Lambda_i));
      g = {-value * value, -value * value, 0.0};
      break;
    case Masking::kSmithDirection: {
      const double smaller = o_is_larger ? go : gi;
      const double both = lambda * (go * gi);
      value = both + (1.0 - lambda) * smaller;
      g = {-both * go, -both * gi, go * gi - smaller};
      (o_is_larger ? g.dLambda_o : g.dLambda_i) -= (1.0 - lambda) * smaller * smaller;
      break;
    }
    case Masking::kSmithHeightDirection: {
      const double larger = o_is_larger ? Lambda_o : Lambda_i, other = o_is_larger ? Lambda_i : Lambda_o;
      value = 1.0 / (1.0 + larger + lambda * other);
      const double scale = -value * value;
      g = {o_is_larger ? scale : scale * lambda, o_is_larger ? scale * lambda : scale, scale * other};
      break;
    }
    default:
      break;
  }
  if (gradient != nullptr) *gradient = g;
  return value;
}

double AzimuthDifference(const Vec3& wo, const Vec3& wi) {
  const double cross = wo.x * wi.y - wo.y * wi.x, dot = wo.x * wi.x + wo.y * wi.y;
  return (cross == 0 && dot == 0) ? 0.0 : std::abs(std::atan2(cross, dot));
}

double VanGinnekenLambda(double phi, double* dlambda_dphi) {
  const double k = 4.41 * phi;
  if (dlambda_dphi != nullptr) *dlambda_dphi = 4.41 / ((k + 1.0) * (k + 1.0));
  return k / (k + 1.0);
}

double VCavityG1(const Vec3& w, const Vec3& m, Vec3* dG1_dw, Vec3* dG1_dm) {
  const double d = Dot(w, m);
  const double value = d > 0 ? 2.0 * m.z * w.z / d : 0.0;
  const bool smooth = d > 0 && value < 1.0;
  const auto derivative = [&](const Vec3& other) -> Vec3 {
    if (!smooth) return {0.0, 0.0, 0.0};
    return {-value * other.x / d, -value * other.y / d, (2.0 * other.z - value * other.z) / d};
  };
  if (dG1_dw != nullptr) *dG1_dw = derivative(m);
  if (dG1_dm != nullptr) *dG1_dm = derivative(w);
  return std::min(1.0, value);
}

namespace {

// One direction against the normal: value before the minimum and derivatives in theta_w, phi_w, theta_m, phi_m.
struct AngularG1 {
  double value, dtheta_w, dphi_w, dtheta_m, dphi_m;
  bool smooth;
};

AngularG1 EvaluateAngular(double theta_w, double phi_w, double theta_m, double phi_m) {
  using Real = long double;
  const Real cw = std::cos(Real{theta_w}), sw = std::sin(Real{theta_w}), cm = std::cos(Real{theta_m}),
             sm = std::sin(Real{theta_m});
  const Real phi = Real{phi_w} - Real{phi_m}, c = std::cos(phi), s = std::sin(phi);
  const Real d = sw * sm * c + cw * cm;
  if (!(d > 0)) return {0, 0, 0, 0, 0, false};
  const Real value = 2 * cm * cw / d;
  if (value >= 1) return {1, 0, 0, 0, 0, false};
  // value = 2 / (1 + tan_w tan_m c): the derivatives are free of differences.
  const Real scale = value / d;
  return {static_cast<double>(value),
          static_cast<double>(-scale * sm * c / cw),
          static_cast<double>(scale * sw * sm * s),
          static_cast<double>(-scale * sw * c / cm),
          static_cast<double>(-scale * sw * sm * s),
          true};
}

}  // namespace

VCavityValues VCavity(const VCavityAngles& a, double* dG1_o, double* dG2) {
  const AngularG1 o = EvaluateAngular(a.theta_o, a.phi_o, a.theta_m, a.phi_m);
  const AngularG1 i = EvaluateAngular(a.theta_i, a.phi_i, a.theta_m, a.phi_m);
  const auto fill = [](const AngularG1& g, bool is_o, double* out) {
    out[0] = is_o ? g.dtheta_w : 0.0;
    out[1] = is_o ? g.dphi_w : 0.0;
    out[2] = is_o ? 0.0 : g.dtheta_w;
    out[3] = is_o ? 0.0 : g.dphi_w;
    out[4] = g.dtheta_m;
    out[5] = g.dphi_m;
  };
  const bool o_is_smaller = o.value <= i.value;
  if (dG1_o != nullptr) fill(o, true, dG1_o);
  if (dG2 != nullptr) fill(o_is_smaller ? o : i, o_is_smaller, dG2);
  return {o.value, i.value, o_is_smaller ? o.value : i.value};
}

double ImplicitG1(const Vec3& w, Vec3* dG1_dw) {
  if (dG1_dw != nullptr) *dG1_dw = {0.0, 0.0, 1.0};
  return w.z;
}

double SchlickSmithG1(const Vec3& w, double m, double* dG1_dm, Vec3* dG1_dw) {
  constexpr double kSqrtTwoOverPi = 0.797884560802865355879892119868763737;
  const double k = kSqrtTwoOverPi * m, c = w.z;
  const double denominator = c + k * (1.0 - c);
  if (dG1_dm != nullptr) *dG1_dm = -kSqrtTwoOverPi * c * (1.0 - c) / (denominator * denominator);
  if (dG1_dw != nullptr) *dG1_dw = {0.0, 0.0, k / (denominator * denominator)};
  return c / denominator;
}

double KelemenG1(const Vec3& w, const Vec3& wh, Vec3* dG1_dw, Vec3* dG1_dwh) {
  const double d = Dot(w, wh), value = w.z / d;
  if (dG1_dw != nullptr) *dG1_dw = {-value * wh.x / d, -value * wh.y / d, (1.0 - value * wh.z) / d};
  if (dG1_dwh != nullptr) *dG1_dwh = (-value / d) * w;
  return value;
}

}  // namespace lobefit

#include "lobefit/core/brdf/abg_lobe.h"

#include <algorithm>
#include <cmath>

#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

// Of AbgAlbedo.
constexpr int kRayNodes = 32, kRays = 192;
constexpr double kBend = 2;  // asinh of the widths up to which the fall is no power yet

struct AbgEllipse {
  explicit AbgEllipse(const SlopeCoordinates& shape)
      : a(std::exp(shape.v[2])), b(shape.v[3]), c(std::exp(shape.v[4])) {}
  double a, b, c;
};

// 1 / (pi a c (1 + t^(g/2))) at the point (x, y) of the plane of slopes; gradient with a stride.
double AbgDensity(const AbgEllipse& e, double g, double x, double y, double* gradient, std::size_t stride) {
  const double y1 = x / e.a, y2 = (y - e.b * y1) / e.c, t = y1 * y1 + y2 * y2;
  const double power = std::pow(t, 0.5 * g), value = kInvPi / (e.a * e.c * (1 + power));
  if (gradient == nullptr) return value;
  // power / (1 + power) without overflow of the square.
  const double share = std::isfinite(power) ? power / (1 + power) : 1.0;
  const double by_t = t > 0 ? -value * share * 0.5 * g / t : 0.0;  // d value / dt
  gradient[0] = gradient[stride] = 0;
  gradient[2 * stride] = -value + by_t * 2 * (-y1 * y1 + y2 * e.b * y1 / e.c);
  gradient[3 * stride] = by_t * 2 * y2 * (-y1 / e.c);
  gradient[4 * stride] = -value - by_t * 2 * y2 * y2;
  gradient[5 * stride] = t > 0 ? -value * share * 0.5 * std::log(t) : 0.0;
  return value;
}

// Integral of r / (1 + (k r)^g) from 0 to `reach`, where that may be thousands of widths.
double AlongRay(const QuadratureRule& rule, double k, double g, double reach) {
  // k r = sinh x.
  const double end = std::asinh(k * reach), bend = std::min(end, kBend);
  const auto integrand = [&](double x) {
    const double s = std::sinh(x);
    return s * std::cosh(x) / (1 + std::pow(s, g));
  };
  return (Integrate(rule, 0, bend, integrand) + Integrate(rule, bend, end, integrand)) / (k * k);
}

}  // namespace

void AbgLobe(const DirectionArrays& d, const SlopeCoordinates& shape, double g, double* specular, double* cos_d,
             double* gradient) {
  const AbgEllipse ellipse(shape);
  for (std::size_t i = 0; i < d.count; ++i) {
    const Vec3 sum = {d.wi_x[i] + d.wo_x[i], d.wi_y[i] + d.wo_y[i], d.wi_z[i] + d.wo_z[i]};
    double* const by = gradient != nullptr ? gradient + i : nullptr;
    specular[i] = 0.25 * AbgDensity(ellipse, g, 0.5 * sum.x, 0.5 * sum.y, by, d.count);
    for (std::size_t k = 0; by != nullptr && k < kAbgParameters; ++k) by[k * d.count] *= 0.25;
    cos_d[i] = std::min(1.0, 0.5 * Norm(sum));
  }
}

double AbgAlbedo(const SlopeCoordinates& shape, double g, const Vec3& wi) {
  static const QuadratureRule rule = GaussLegendre(kRayNodes);
  const AbgEllipse e(shape);
  // d omega cos_theta_o = d beta: polar coordinates about beta_0 = -wi_xy.
  double sum = 0;
  for (int k = 0; k < kRays; ++k) {
    const double phi = 2 * kPi * (k + 0.5) / kRays, x = std::cos(phi), y = std::sin(phi);
    const double along = -wi.x * x - wi.y * y, across = -wi.x * y + wi.y * x;
    const double reach = -along + std::sqrt(std::max(0.0, (1 - across) * (1 + across)));
    if (!(reach > 0)) continue;
    const double y1 = 0.5 * x / e.a, y2 = (0.5 * y - e.b * y1) / e.c;
    sum += AlongRay(rule, std::hypot(y1, y2), g, reach);
  }
  return sum * 2 * kPi / kRays * kInvPi / (4 * e.a * e.c);
}

double AbgDistribution::D(const Vec3& wm, double* gradient) const {
  if (wm.z < 0) {
    if (gradient != nullptr) std::fill(gradient, gradient + kAbgParameters, 0.0);
    return 0;
  }
  return AbgDensity(AbgEllipse(shape_), g_, wm.x, wm.y, gradient, 1);
}

double AbgDistribution::Sigma(const Vec3& u, double* gradient) const {
  if (gradient != nullptr) std::fill(gradient, gradient + kAbgParameters, 0.0);
  return std::max(0.0, u.z);
}

Ellipsoid AbgDistribution::Outline() const {
  const AbgEllipse e(shape_);
  const double alpha = std::sqrt(e.a * e.c);
  return {alpha, alpha, 0, 0, 0};
}

}  // namespace lobefit

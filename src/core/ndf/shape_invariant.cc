#include "lobefit/core/ndf/shape_invariant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"
#include "lobefit/core/ndf/off_center.h"
#include "lobefit/core/ndf/smith.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr double kTableEnd = 1e4;  // in a; beyond it M is integrated at each call
constexpr int kTableSteps = 1200;

// s - a atan(s / a), s, a >= 0.
double SMinusAtan(double s, double a) {
  const double x = s / a;
  if (!(x < 0.25)) return s - a * std::atan2(s, a);
  const double xx = x * x;
  double sum = 0, sign = 1, power = 1;
  for (int n = 3; n < 33; n += 2) {
    sum += sign * power / n;
    sign = -sign;
    power *= xx;
  }
  return a * x * xx * sum;
}

// int_0^inf g(s) ds, or to `end`: s = scale u / (1 - u).
template <std::size_t N, class G>
QuadratureResult<N> IntegrateRadius(double end, double scale, const G& g) {
  const double u_end = std::isfinite(end) ? end / (scale + end) : 1.0;
  const auto f = [&](double u) {
    const double v = 1.0 - u;
    std::array<double, N> value = g(scale * u / v);
    for (double& x : value) x *= scale / (v * v);
    return value;
  };
  QuadratureOptions options;
  options.relative = 1e-14;
  options.max_intervals = 400;
  return IntegrateAdaptive<N>(f, {0.0, 0.5 * u_end, u_end}, options);
}

}  // namespace

SlopeProfile BeckmannProfile() {
  return {[](double t) { return std::exp(-t); }, [](double t) { return -std::exp(-t); }};
}

SlopeProfile GgxProfile() { return StudentProfile(2.0); }

SlopeProfile StudentProfile(double gamma) {
  if (!(gamma > 1.5))
    throw InputError("a slope profile with gamma = " + FormatDouble(gamma) +
                     " has no mean slope; gamma must be above 1.5");
  const double scale = 1.0 / (gamma - 1.0);
  return {[=](double t) { return std::pow(1.0 + scale * t, -gamma); },
          [=](double t) { return -gamma * scale * std::pow(1.0 + scale * t, -gamma - 1.0); }};
}

ShapeInvariantMasking::ShapeInvariantMasking(SlopeProfile profile) : profile_(std::move(profile)) {
  const double end = std::sqrt(profile_.support);
  const auto mass =
      IntegrateRadius<1>(end, 1.0, [&](double r) { return std::array<double, 1>{2.0 * kPi * r * profile_.f(r * r)}; });
  const bool usable = mass.converged && std::isfinite(mass.value[0]) && mass.value[0] > 0 && profile_.f(0.25) >= 0;
  if (!usable) throw InputError("a slope profile must be finite, not negative and integrable over the plane");
  normalisation_ = 1.0 / mass.value[0];
  const double a_end = std::min(kTableEnd, end);
  step_ = std::asinh(a_end) / kTableSteps;
  table_.reserve(kTableSteps + 1);
  for (int k = 0; k <= kTableSteps; ++k) table_.push_back(Integrate(std::sinh(k * step_)));
  if (!std::isfinite(table_[0].m))
    throw InputError("a slope profile must have a finite mean slope: f must fall faster than t^(-3/2)");
}

// With r^2 = a^2 + s^2: M = 2 int f s (s - a atan(s / a)) ds, -M' = 2 int f s atan(s / a) ds, M'' = P2(a) = 2 int f ds.
ShapeInvariantMasking::Moments ShapeInvariantMasking::Integrate(double a) const {
  const double end =
      std::isfinite(profile_.support) ? std::sqrt(std::max(0.0, profile_.support - a * a)) : profile_.support;
  if (!(end > 0)) return {0.0, 0.0, 0.0};
  const auto moments = IntegrateRadius<3>(end, std::hypot(1.0, a), [&](double s) {
    const double f = 2.0 * normalisation_ * profile_.f(a * a + s * s);
    if (!(f > 0)) return std::array<double, 3>{};  // no inf * 0 where the tail has underflowed
    return std::array<double, 3>{f * s * SMinusAtan(s, a), f * s * std::atan2(s, a), f};
  });
  return {moments.value[0], moments.value[1], moments.value[2]};
}

double ShapeInvariantMasking::Density(double t, double* derivative) const {
  const bool inside = t < profile_.support;
  if (derivative != nullptr) *derivative = inside ? normalisation_ * profile_.df(t) : 0.0;
  return inside ? normalisation_ * profile_.f(t) : 0.0;
}

double ShapeInvariantMasking::M(double a, double* derivative) const {
  const double position = std::asinh(a) / step_;
  if (!(position < kTableSteps)) {
    const Moments moments = Integrate(a);
    if (derivative != nullptr) *derivative = -moments.tail;
    return moments.m;
  }
  const auto k = static_cast<std::size_t>(position);
  const double a0 = std::sinh(static_cast<double>(k) * step_), h = std::sinh(static_cast<double>(k + 1) * step_) - a0;
  const Moments &p = table_[k], &q = table_[k + 1];
  // Quintic Hermite in x = (a - a0) / h as Taylor polynomial of the left end plus x^3 (c0 + c1 y + c2 y^2), y = x - 1.
  const double x = (a - a0) / h, y = x - 1.0;
  const double d0 = -p.tail * h, d1 = -q.tail * h, e0 = 0.5 * p.p2 * h * h, e1 = 0.5 * q.p2 * h * h;
  const double r = q.m - p.m - d0 - e0, dr = d1 - d0 - 2.0 * e0, er = e1 - e0;
  const double c0 = r, c1 = dr - 3.0 * r, c2 = er - 3.0 * c1 - 3.0 * c0;
  const double inner = c0 + y * (c1 + y * c2);
  if (derivative != nullptr)
    *derivative = (d0 + 2.0 * e0 * x + 3.0 * x * x * inner + x * x * x * (c1 + 2.0 * c2 * y)) / h;
  return p.m + x * (d0 + x * (e0 + x * inner));
}

double ShapeInvariantMasking::Sigma(double a, double* derivative) const {
  double dM;
  const double m = M(std::abs(a), derivative != nullptr ? &dM : nullptr);
  if (derivative != nullptr) *derivative = a > 0 ? 1.0 + dM : -dM;
  return a > 0 ? a + m : m;
}

double ShapeInvariantMasking::Lambda(double a, double* derivative) const {
  double dM;
  const double m = M(std::abs(a), &dM);
  if (derivative != nullptr) *derivative = ((a > 0 ? dM : -dM) - m / a) / a;
  return m / a - (a > 0 ? 0.0 : 1.0);
}

ShapeInvariantDistribution::ShapeInvariantDistribution(std::shared_ptr<const ShapeInvariantMasking> masking,
                                                       const SlopeDistribution& slopes)
    : masking_(std::move(masking)), slopes_(slopes), outline_(EllipsoidFromOffCenter(OffCenterFromSlopes(slopes))) {}

// D = density(Q / m_z^2) / (alpha_x alpha_y sqrt(1 - r^2) m_z^4), Q as in slope_distribution.cc.
double ShapeInvariantDistribution::D(const Vec3& wm, double* gradient) const {
  if (!(wm.z > 0)) {
    if (gradient != nullptr) std::fill(gradient, gradient + kSlopeParameters, 0.0);
    return 0.0;
  }
  const SlopeDistribution& s = slopes_;
  const double zz = wm.z * wm.z, rr = (1.0 - s.r) * (1.0 + s.r);
  const double X = wm.x + s.slope_x * wm.z, Y = wm.y + s.slope_y * wm.z;
  const double x = X / s.alpha_x, y = Y / s.alpha_y;
  const double difference = (x - y) / (1.0 - s.r), sum = (x + y) / (1.0 + s.r);
  const double Q = 0.5 * ((x - y) * difference + (x + y) * sum);
  double slope;
  const double scale = 1.0 / (s.alpha_x * s.alpha_y * std::sqrt(rr) * zz * zz);
  const double value = scale * masking_->Density(Q / zz, &slope);
  if (gradient != nullptr) {
    slope *= scale / zz;
    const double dx = sum + difference, dy = sum - difference;
    gradient[0] = -(value + slope * dx * x) / s.alpha_x;
    gradient[1] = -(value + slope * dy * y) / s.alpha_y;
    gradient[2] = value * s.r / rr + slope * 0.5 * (difference * difference - sum * sum);
    gradient[3] = slope * dx * wm.z / s.alpha_x;
    gradient[4] = slope * dy * wm.z / s.alpha_y;
  }
  return value;
}

// sigma = sqrt(q) S(a), a = c / sqrt(q): dsigma = S' dc + (S - a S') dq / (2 sqrt(q)).
double ShapeInvariantDistribution::Sigma(const Vec3& u, double* gradient) const {
  double dc[kSlopeParameters], dq[kSlopeParameters];
  const ProjectedSlopes p = ProjectSlopes(slopes_, u, dc, dq);
  if (!(p.q > 0)) {
    if (gradient != nullptr) std::copy(dc, dc + kSlopeParameters, gradient);
    return std::max(p.c, 0.0);
  }
  const double root = std::sqrt(p.q);
  double slope;
  const double S = masking_->Sigma(p.a, &slope);
  if (gradient != nullptr) {
    const double in_q = 0.5 * (S - p.a * slope) / root;
    for (int k = 0; k < kSlopeParameters; ++k) gradient[k] = slope * dc[k] + in_q * dq[k];
  }
  return root * S;
}

}  // namespace lobefit

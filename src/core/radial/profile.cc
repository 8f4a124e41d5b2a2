#include "lobefit/core/radial/profile.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostKnots = 20;
using Real = long double;  // the cubics are rounded once

std::string Listed(const std::vector<double>& numbers) {
  std::vector<std::string> items;
  for (const double x : numbers) items.push_back(FormatDouble(x));
  return Join(items);
}

// Integral from the interval's left end, as a cubic: value there and the integrand's three coefficients.
struct Cubic {
  Real c[4] = {0, 0, 0, 0};
  Real At(Real x) const { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }
};

// int_0^u N_j for each of the K + 1 quadratic B-splines (the last two are added), one cubic an interval between knots.
std::vector<std::vector<Cubic>> IntegratedSplines(const std::vector<Real>& u) {
  const std::size_t K = u.size() - 1;
  std::vector<std::vector<Cubic>> integral(K + 2, std::vector<Cubic>(K));
  for (std::size_t i = 0; i < K; ++i) {
    const Real h = u[i + 1] - u[i], left = u[i + 1] - u[i > 0 ? i - 1 : 0], right = u[std::min(i + 2, K)] - u[i];
    // In x = u - u_i: (h - x)^2 / (h left), x^2 / (h right), and the rest of 1 between them.
    const Real a = 1 / (h * left), b = 1 / (h * right);
    const Real pieces[3][3] = {{h * h * a, -2 * h * a, a}, {1 - h * h * a, 2 * h * a, -a - b}, {0, 0, b}};
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) integral[i + j][i].c[k + 1] = pieces[j][k] / static_cast<Real>(k + 1);
    }
  }
  for (std::size_t i = 0; i < K; ++i) {
    for (std::size_t k = 0; k < 4; ++k) integral[K][i].c[k] += integral[K + 1][i].c[k];
  }
  integral.pop_back();
  for (std::vector<Cubic>& pieces : integral) {
    for (std::size_t i = 1; i < K; ++i) pieces[i].c[0] = pieces[i - 1].At(u[i] - u[i - 1]);
  }
  return integral;
}

std::vector<Real> LogKnots(const std::vector<double>& knots) {
  std::vector<Real> u;
  for (const double r : knots) u.push_back(std::log1p(static_cast<Real>(r) * r));
  return u;
}

// Points of each interval's rule for Z: exp of a cubic, which 32 points integrate to rounding for exponents to 40.
const QuadratureRule& MassRule() {
  static const QuadratureRule rule = GaussLegendre(32);
  return rule;
}

}  // namespace

ProfileSpline::ProfileSpline(std::vector<double> knots) : knots_(std::move(knots)) {
  std::size_t one = 0;
  bool good = knots_.size() >= 2 && knots_.size() <= kMostKnots && knots_[0] == 0;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    good = good && std::isfinite(knots_[i]) && knots_[i] > knots_[i - 1];
    if (knots_[i] == 1) one = i;
  }
  if (!good || one == 0) {
    throw InputError("the knots of a profile (" + Listed(knots_) +
                     ") must increase, begin with 0 and contain 1, at most 20, such as 0, 1, 2, 4, 8");
  }
  const std::size_t K = size_ = knots_.size() - 1;
  const std::vector<Real> u = LogKnots(knots_);
  const std::vector<std::vector<Cubic>> integral = IntegratedSplines(u);
  // W_j = int_0^ln2 N_j; the coefficient with the largest is solved for (K + 1 splines; never the tail's).
  std::vector<Real> weight;
  for (const std::vector<Cubic>& pieces : integral) weight.push_back(pieces[one - 1].At(u[one] - u[one - 1]));
  const auto e = static_cast<std::size_t>(std::max_element(weight.begin(), weight.end() - 1) - weight.begin());
  for (const Real x : u) u_.push_back(static_cast<double>(x));
  coefficients_.assign((K + 1) * 4 * K + 7, 0.0);
  for (std::size_t j = 0, k = 0; j <= K; ++j) {
    if (j == e) continue;
    const Real ratio = weight[j] / weight[e];
    for (std::size_t i = 0; i < K; ++i) {
      for (std::size_t p = 0; p < 4; ++p)
        coefficients_[(i * 4 + p) * K + k] = static_cast<double>(ratio * integral[e][i].c[p] - integral[j][i].c[p]);
    }
    const Real end = u[K] - u[K - 1];
    coefficients_[K * 4 * K + k] = static_cast<double>(ratio * integral[e][K - 1].At(end) - integral[j][K - 1].At(end));
    if (j == K) coefficients_[(K * 4 + 1) * K + k] = -1.0;
    first_radius_.push_back(j >= 2 ? knots_[j - 2] : 0.0);
    ++k;
  }
}

ProfileSpline ProfileSpline::PowerLaw() {
  ProfileSpline spline;
  spline.size_ = 1;
  spline.knots_ = {0, 0.125, 0.25, 0.5, 1, 2, 4, 8, 16, 32};
  for (const Real x : LogKnots(spline.knots_)) {
    spline.u_.push_back(static_cast<double>(x));
    for (const Real c : {-x, Real{-1}, Real{0}, Real{0}}) spline.coefficients_.push_back(static_cast<double>(c));
  }
  spline.coefficients_.resize(spline.coefficients_.size() + 7, 0.0);
  spline.first_radius_ = {0};
  return spline;
}

std::size_t ProfileSpline::Interval(double u) const {
  std::size_t i = 0;
  while (i + 1 < u_.size() && u >= u_[i + 1]) ++i;
  return i;
}

void ProfileSpline::Evaluate(double u, double* basis, double* slope) const {
  const std::size_t i = Interval(u), K = size_;
  const double x = u - u_[i];
  const double* c = Coefficients(i);
  for (std::size_t k = 0; k < K; ++k) basis[k] = c[k] + x * (c[K + k] + x * (c[2 * K + k] + x * c[3 * K + k]));
  for (std::size_t k = 0; slope != nullptr && k < K; ++k)
    slope[k] = c[K + k] + x * (2.0 * c[2 * K + k] + x * (3.0 * c[3 * K + k]));
}

Profile::Profile(std::shared_ptr<const ProfileSpline> spline, std::vector<double> q)
    : spline_(std::move(spline)), q_(std::move(q)) {
  const ProfileSpline& s = *spline_;
  const std::size_t K = s.size();
  const bool finite = std::all_of(q_.begin(), q_.end(), [](double x) { return std::isfinite(x); });
  if (q_.size() != K || !finite) {
    throw InputError("a profile of " + std::to_string(s.knots().size()) + " knots needs " + std::to_string(K) +
                     " finite coefficients, not (" + Listed(q_) + ")");
  }
  if (!(tail_exponent() > 1.5)) {
    throw InputError("a profile whose tail exponent is " + FormatDouble(tail_exponent()) +
                     " has no mean slope; it must be above 1.5, so its last coefficient above -0.5");
  }
  for (std::size_t i = 0; i < s.intervals(); ++i) {
    for (std::size_t p = 0; p < 4; ++p) {
      double sum = 0;
      for (std::size_t k = 0; k < K; ++k) sum += q_[k] * s.Coefficients(i)[p * K + k];
      cubics_.push_back(sum);
    }
  }
  // int e^-u (e^E - 1) du between the knots, then the tail's closed form; the derivatives have e^E B_k.
  std::vector<double> basis(K);
  dlog_mass_.assign(K, 0.0);
  const QuadratureRule& rule = MassRule();
  for (std::size_t i = 0; i + 1 < s.intervals(); ++i) {
    const double half = 0.5 * (s.Left(i + 1) - s.Left(i)), center = s.Left(i) + half;
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double u = center + half * rule.nodes[j], weight = half * rule.weights[j] * std::exp(-u);
      const double excess = std::expm1(Excess(u));
      mass_excess_ += weight * excess;
      s.Evaluate(u, basis.data());
      for (std::size_t k = 0; k < K; ++k) dlog_mass_[k] += weight * (1.0 + excess) * basis[k];
    }
  }
  const double end = std::exp(-s.last_u()), excess = std::expm1(Excess(s.last_u()));
  const double exponent = tail_exponent() - 1.0, rest = end * (1.0 + excess) / exponent;
  mass_excess_ += end * (excess - q_.back()) / exponent;
  s.Evaluate(s.last_u(), basis.data());
  for (std::size_t k = 0; k < K; ++k) dlog_mass_[k] += rest * basis[k];
  dlog_mass_[K - 1] -= rest / exponent;
  for (double& x : dlog_mass_) x /= 1.0 + mass_excess_;
}

double Profile::Excess(double u, double* g) const {
  const std::size_t i = spline_->Interval(u);
  const double* c = cubics_.data() + 4 * i;
  const double x = u - spline_->Left(i);
  if (g != nullptr) *g = 2.0 - (c[1] + x * (2.0 * c[2] + x * (3.0 * c[3])));
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

double Profile::MassBeyond(double r) const {
  const double from = std::log1p(r * r), end = spline_->last_u();
  double sum = 0;
  const QuadratureRule& rule = MassRule();
  for (std::size_t i = 0; i + 1 < spline_->intervals(); ++i) {
    const double a = std::max(from, spline_->Left(i)), b = spline_->Left(i + 1);
    if (a < b) sum += Integrate(rule, a, b, [&](double u) { return std::exp(-u + Excess(u)); });
  }
  const double tail = std::max(from, end);
  sum += std::exp(-tail + Excess(tail)) / (tail_exponent() - 1.0);
  return sum / (1.0 + mass_excess_);
}

double ProfileD(const Profile& profile, const SlopeDistribution& slopes, const Vec3& wm, double* gradient) {
  const std::size_t K = profile.q().size();
  if (!(wm.z > 0)) {
    if (gradient != nullptr) std::fill_n(gradient, kSlopeParameters + K, 0.0);
    return 0.0;
  }
  // As in SlopeDistributionD.
  const SlopeQuadratic q = EvaluateSlopeQuadratic(slopes, wm.x + slopes.slope_x * wm.z, wm.y + slopes.slope_y * wm.z);
  const double zz = wm.z * wm.z, h = zz + q.value;
  const double u = std::log1p(std::min(q.value / zz, 1e300));
  double value = SlopeNormalisation(slopes) / (h * h);
  double g;
  value *= std::exp(profile.Excess(u, &g)) / (1.0 + profile.mass_excess());
  if (gradient != nullptr) {
    FillSlopeGradient(slopes, q, value, -g * value / h, wm.z, gradient);
    double* by_q = gradient + kSlopeParameters;
    profile.spline().Evaluate(u, by_q);
    for (std::size_t k = 0; k < K; ++k) by_q[k] = value * (by_q[k] - profile.dlog_mass()[k]);
  }
  return value;
}

}  // namespace lobefit

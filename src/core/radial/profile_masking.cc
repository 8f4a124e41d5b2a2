#include "lobefit/core/radial/profile_masking.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lobefit/math/quadrature.h"
#include "lobefit/math/special.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr int kTablePoints = 20;        // a panel
constexpr std::size_t kSteps = 32;      // of the table between two knots, or for each doubling of a up to kFineEnd
constexpr double kFineEnd = 32;         // beyond, M is a power
constexpr std::size_t kTailSteps = 24;  // for each doubling from there on
constexpr double kPanelsEnd = 4;        // last knots from the centre
constexpr int kDoublings = 15;          // from kFineEnd to the end of the table; beyond, the closed form

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

// M, T, P2 at a >= 1 of f = (1 + t)^-c, divided by (1 + a^2)^-c, and the derivatives of their logarithms by c less the
// -ln(1 + a^2) of that factor. All terms are positive (MATH.md 8.2 with gamma = c in units of sqrt(c - 1)).
struct PowerMoments {
  double value[3], dlog[3];
};
PowerMoments PowerLawMoments(double a, const ProfileTail& tail) {
  const double c = tail.exponent, dlog_ratio = tail.dlog_ratio;
  const double A = 1.0 + a * a, y = 1.0 / A;
  const double p2 = std::sqrt(kPi * A) / tail.gamma_ratio;
  // F = 2F1(c - 3/2, 1; c; y).
  double F = 1, dF = 0, term = 1, dlog = 0;
  for (int n = 0; n < 400 && term > 1e-19 * F; ++n) {
    const double up = c - 1.5 + n, down = c + n;
    term *= up / down * y;
    dlog += 1.0 / up - 1.0 / down;
    F += term;
    dF += term * dlog;
  }
  // int x P2 = P2 A / (2 c - 3), M = that F / (2 c - 2), T = (the one less the other) / a.
  const double half = 0.5 / (c - 1.0), first = p2 * A / (2.0 * c - 3.0), rest = 1.0 - half * F;
  const double dfirst = -2.0 / (2.0 * c - 3.0) - dlog_ratio, dhalf = -1.0 / (c - 1.0);  // of the logarithms
  return {{first * half * F, first * rest / a, p2},
          {dfirst + dhalf + dF / F, dfirst - half * (dF + dhalf * F) / rest, -dlog_ratio}};
}

}  // namespace

ProfileRule::ProfileRule(const ProfileSpline& spline, double a, const QuadratureRule& rule, int parts)
    : a_(a), end_(spline.knots().back()) {
  if (a < end_) AddPanels(spline, rule, parts);
  u_ = std::log1p(end_ * end_);
  f_ggx_ = std::exp(-2.0 * u_);
  basis_.resize(spline.size());
  spline.Evaluate(u_, basis_.data());
  if (a >= end_) {
    log_shift_ = u_ - std::log1p(a * a);
  } else {
    const double Y = 1.0 + end_ * end_, s = std::sqrt((end_ - a) * (end_ + a));
    edge_ = {Y * SMinusAtan(s, a), Y * std::atan2(s, a)};
  }
  double unused[3];
  ggx_ = TailMoments(ProfileTail(2.0), unused);
}

void ProfileRule::AddPanels(const ProfileSpline& spline, const QuadratureRule& rule, int parts) {
  const double a = a_;
  // Radii at which panels end: the knots beyond a, then twice and four times the last; within the first panel the
  // kernel turns at s = a.
  const auto at_radius = [a](double r) { return std::sqrt((r - a) * (r + a)); };
  const std::vector<double>& knots = spline.knots();
  const std::size_t first =
      static_cast<std::size_t>(std::upper_bound(knots.begin(), knots.end(), a) - knots.begin()) - 1;
  double from = 0;
  const auto add = [&](std::size_t interval, double to) {
    const double step = (to - from) / parts;
    for (int part = 0; part < parts; ++part)
      AddPanel(spline, interval, from + step * part, from + step * (part + 1), rule);
    from = to;
  };
  for (double s = a; s > 0 && s < 0.7 * at_radius(knots[first + 1]); s *= 2) add(first, s);
  for (std::size_t i = first; i + 1 < knots.size(); ++i) add(i, at_radius(knots[i + 1]));
  for (const double factor : {2.0, kPanelsEnd}) add(knots.size() - 1, at_radius(factor * end_));
  points_.Finish();
  end_ *= kPanelsEnd;
  const double A = 1.0 + a * a;
  double j = 1, h = 1, sum_e = 0, sum_h = 0, power = 1;
  for (std::size_t n = 0; n < j_.size(); ++n, power /= 1.0 + end_ * end_) {
    sum_e += j;
    sum_h += h;
    j_[n] = power * j;
    e_[n] = power * sum_e;
    h_[n] = power * sum_h;
    const auto k = static_cast<double>(n);
    j *= (k + 0.5) / (k + 1.0) * A;
    h *= (k - 0.5) / (k + 1.0) * A;
  }
}

void ProfileRule::AddPanel(const ProfileSpline& spline, std::size_t interval, double from, double to,
                           const QuadratureRule& rule) {
  const double half = 0.5 * (to - from), center = from + half;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double s = center + half * rule.nodes[i], angle = std::atan2(s, a_);
    const double u = std::log1p(a_ * a_ + s * s), w = 2.0 * half * rule.weights[i] * std::exp(-2.0 * u);
    points_.Add(spline, interval, u, {w * s * SMinusAtan(s, a_), w * s * angle, w});
  }
}

void ProfileRule::Apply(const Profile& profile, const ProfileTail& tail, bool minus_ggx, double* moments,
                        std::size_t stride) const {
  const std::size_t K = profile.q().size();
  for (std::size_t m = 0; m < 3; ++m) std::fill_n(moments + m * stride, K + 1, 0.0);
  points_.AddMoments(profile, minus_ggx, moments, stride);
  Complete(profile, tail, minus_ggx, moments, stride);
}

void ProfileRule::Complete(const Profile& profile, const ProfileTail& tail, bool minus_ggx, double* moments,
                           std::size_t stride) const {
  const std::size_t K = profile.q().size();
  const double inverse = 1.0 / (1.0 + profile.mass_excess());
  for (std::size_t m = 0; m < 3; ++m) {
    for (std::size_t k = 0; k <= K; ++k) moments[m * stride + k] *= inverse;
  }
  AddTail(profile, tail, minus_ggx, moments, stride);
  // So far the derivatives lack -Z_k / Z times the value; everything is in units of pi.
  double ggx[3] = {0, 0, 0};
  if (minus_ggx) {
    const double root = std::sqrt(1.0 + a_ * a_);
    ggx[0] = 0.5 / (a_ + root);
    ggx[1] = 0.5 / (root * (a_ + root));
    ggx[2] = 0.5 / (root * root * root);
  }
  for (std::size_t m = 0; m < 3; ++m) {
    double* to = moments + m * stride;
    to[0] *= kInvPi;
    for (std::size_t k = 0; k < K; ++k) to[k + 1] = kInvPi * to[k + 1] - (to[0] + ggx[m]) * profile.dlog_mass()[k];
  }
}

ProfileTail::ProfileTail(double c) : exponent(c), gamma_ratio(GammaHalfRatio(c - 0.5, &dlog_ratio)) {
  for (std::size_t n = 0; n < inverse.size(); ++n) inverse[n] = 1.0 / (c + static_cast<double>(n) - 1.5);
}

// Beyond the circle of radius R = end_ f falls as (1 + t)^-c. For a < R: with Y = 1 + R^2, s_R = sqrt(R^2 - a^2),
//   P2: f_R Y^(1/2) sum j_n Y^-n / (c + n - 1/2)
//   T:  f_R / (c - 1) [Y atan(s_R / a) + (a / 2) Y^(1/2) sum e_n Y^-n / (c + n - 1/2)]
//   M:  f_R / (c - 1) [Y (s_R - a atan(s_R / a)) + (1 / 2) Y^(3/2) sum h_n Y^-n / (c + n - 3/2)].
std::array<double, 3> ProfileRule::TailMoments(const ProfileTail& tail, double* dlog) const {
  std::array<double, 3> value;
  if (a_ >= end_) {
    const PowerMoments power = PowerLawMoments(a_, tail);
    const double scale = std::exp(tail.exponent * log_shift_);
    for (std::size_t m = 0; m < 3; ++m) {
      value[m] = power.value[m] * scale;
      dlog[m] = power.dlog[m] + log_shift_;
    }
    return value;
  }
  const double Y = 1.0 + end_ * end_, root = std::sqrt(Y), c = tail.exponent;
  double sums[3] = {0, 0, 0}, slopes[3] = {0, 0, 0};
  for (std::size_t n = 0; n < j_.size(); ++n) {
    const double more = tail.inverse[n], half = tail.inverse[n + 1];
    const double terms[3] = {h_[n] * more, e_[n] * half, j_[n] * half};
    for (std::size_t m = 0; m < 3; ++m) {
      sums[m] += terms[m];
      slopes[m] -= terms[m] * (m == 0 ? more : half);
    }
  }
  const double rest = 1.0 / (c - 1.0);
  const double factor[3] = {0.5 * Y * root * rest, 0.5 * a_ * root * rest, root};
  for (std::size_t m = 0; m < 3; ++m) {
    value[m] = factor[m] * sums[m] + (m < 2 ? edge_[m] * rest : 0.0);
    dlog[m] = (value[m] > 0 ? factor[m] * slopes[m] / value[m] : 0.0) - (m < 2 ? rest : 0.0);
  }
  return value;
}

void ProfileRule::AddTail(const Profile& profile, const ProfileTail& tail, bool minus_ggx, double* moments,
                          std::size_t stride) const {
  const std::size_t K = profile.q().size();
  const double f = f_ggx_ * std::exp(profile.Excess(u_)) / (1.0 + profile.mass_excess());
  double dlog[3];
  const std::array<double, 3> value = TailMoments(tail, dlog);
  for (std::size_t m = 0; m < 3; ++m) {
    double* to = moments + m * stride;
    to[0] += f * value[m] - (minus_ggx ? f_ggx_ * ggx_[m] : 0.0);
    for (std::size_t k = 0; k < K; ++k) to[k + 1] += f * value[m] * (basis_[k] + (k + 1 == K ? dlog[m] : 0.0));
  }
}

double ProfileRule::EndOfPoints(const ProfileSpline& spline) {
  const double radius = kPanelsEnd * spline.knots().back();
  return std::log1p(radius * radius);
}

ProfileGrid::ProfileGrid(std::shared_ptr<const ProfileSpline> spline)
    : spline_(std::move(spline)), matrix_(*spline_, ProfileRule::EndOfPoints(*spline_)) {
  const auto add = [&](double from, double to, std::size_t steps) {
    const double x0 = std::asinh(from), x1 = std::asinh(to), step = (x1 - x0) / static_cast<double>(steps);
    breaks_.push_back({x0, 1.0 / step, a_.size(), steps});
    // A knot itself, not the sinh of its asinh: beside it P2 has a corner.
    a_.push_back(from);
    for (std::size_t j = 1; j < steps; ++j) a_.push_back(std::sinh(x0 + step * static_cast<double>(j)));
  };
  const std::vector<double>& knots = spline_->knots();
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) add(knots[i], knots[i + 1], kSteps);
  double end = knots.back();
  if (end < kFineEnd) {
    add(end, kFineEnd, kSteps * static_cast<std::size_t>(std::ceil(std::log2(kFineEnd / end))));
    end = kFineEnd;
  }
  const double last = std::ldexp(end, kDoublings);
  add(end, last, kDoublings * kTailSteps);
  a_.push_back(last);
  const QuadratureRule rule = GaussLegendre(kTablePoints);
  rules_.reserve(a_.size());
  for (const double a : a_) rules_.emplace_back(*spline_, a, rule);
  below_ = static_cast<std::size_t>(std::lower_bound(a_.begin(), a_.end(), knots.back()) - a_.begin());
  for (std::size_t i = 0; i < below_; ++i) matrix_.Add(rules_[i].points());
  matrix_.Finish();
  stride_ = (spline_->size() + 4) / 4 * 4;
  zero_ = Table(Profile(spline_, std::vector<double>(spline_->size(), 0.0)));
}

std::vector<double> ProfileGrid::Table(const Profile& profile) const {
  std::vector<double> table(a_.size() * 3 * stride_, 0.0);
  const ProfileTail tail(profile.tail_exponent());
  const bool resolved = matrix_.Resolves(profile);
  if (resolved) matrix_.Moments(profile, stride_, table.data());
  for (std::size_t i = 0; i < a_.size(); ++i) {
    double* moments = table.data() + i * 3 * stride_;
    if (resolved || i >= below_) {
      rules_[i].Complete(profile, tail, true, moments, stride_);
    } else {
      rules_[i].Apply(profile, tail, true, moments, stride_);
    }
  }
  return table;
}

ProfileMasking::ProfileMasking(std::shared_ptr<const ProfileGrid> grid, Profile profile)
    : grid_(std::move(grid)), profile_(std::move(profile)), stride_(grid_->stride_) {
  const bool zero = std::all_of(profile_.q().begin(), profile_.q().end(), [](double q) { return q == 0; });
  table_ = zero ? grid_->zero_ : grid_->Table(profile_);
}

void ProfileMasking::Differences(const double* a, std::size_t count, double* slope, double* difference) const {
  const double last = grid_->a_.back();
  const ProfileTable table = {&grid_->breaks_, grid_->a_.data(), table_.data(), stride_};
  for (std::size_t i = 0; i < count;) {
    std::size_t end = i;
    while (end < count && a[end] < last) ++end;
    if (end > i)
      InterpolateProfile(table, a + i, end - i, slope == nullptr ? nullptr : slope + i, difference + i * stride_);
    for (i = end; i < count && !(a[i] < last); ++i) {
      double* to = difference + i * stride_;
      std::vector<double> moments(3 * stride_, 0.0);
      if (std::isfinite(a[i])) {
        const ProfileTail tail(profile_.tail_exponent());
        ProfileRule(profile_.spline(), a[i], {}).Apply(profile_, tail, true, moments.data(), stride_);
      }
      if (slope != nullptr) slope[i] = -moments[stride_];
      std::copy_n(moments.data(), stride_, to);
    }
  }
}

}  // namespace lobefit

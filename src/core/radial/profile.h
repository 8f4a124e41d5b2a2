// Free radial profiles of a slope distribution: the logarithm of the density is a spline, written by its local
// exponent, and its coefficients are parameters of a fit beside the five of the ellipse.
//
// [Heitz] Heitz 2014 sec 5.3 (shape-invariant distributions); MATH.md section 8.1. t is the squared distance from the
// mean slope in the metric of the ellipse ([Heitz eq 95]), r = sqrt(t), u = ln(1 + t):
//   ln f(t) = -2 u + E(u),   E(u) = sum_k q_k B_k(u),   P22 = f(t) / (Z alpha_x alpha_y sqrt(1 - r_xy^2)),
//   Z = pi int_0^inf f dt.
// The local exponent g(u) = -d ln f / du = 2 - dE/du is a quadratic B-spline over the knots u_i = ln(1 + r_i^2), free
// at the left end and constant beyond the last knot: there f ~ (1 + t)^-g, exactly. q = 0 is GGX. The coefficient that
// is not among the q keeps B_k(ln 2) = 0: f = 1/4 at r = 1 whatever q is, so that alpha stays the slope where the
// density is a quarter of its peak and q is shape alone.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "lobefit/core/radial/slope_distribution.h"

namespace lobefit {

// What does not depend on the coefficients. Immutable: share it.
class ProfileSpline {
 public:
  // Knots r_i >= 0: increasing, the first 0, one of them 1. Throws InputError otherwise. K = knots - 1 coefficients.
  explicit ProfileSpline(std::vector<double> knots);
  // f = (1 + t)^-(2 + q_1): one exponent everywhere, no gauge (student.h scales it). The knots are where quadratures
  // and tables break.
  static ProfileSpline PowerLaw();

  std::size_t size() const { return size_; }
  const std::vector<double>& knots() const { return knots_; }
  double last_u() const { return u_.back(); }
  // Where coefficient k begins to act, but for the gauge: data that end before it cannot determine it.
  double FirstRadius(std::size_t k) const { return first_radius_[k]; }

  // B_k(u) and, where asked, dB_k/du, k = 0 .. size() - 1; u >= 0.
  void Evaluate(double u, double* basis, double* slope = nullptr) const;

  // Interval of u; its cubics in x = u - Left(i) are Coefficients(i)[j * size() + k] x^j, j = 0 .. 3. The last interval
  // is the tail, straight lines.
  std::size_t Interval(double u) const;
  double Left(std::size_t interval) const { return u_[interval]; }
  // Seven numbers more can be read behind each.
  const double* Coefficients(std::size_t interval) const { return coefficients_.data() + interval * 4 * size_; }
  std::size_t intervals() const { return u_.size(); }

 private:
  ProfileSpline() = default;

  std::size_t size_ = 0;
  std::vector<double> knots_, u_, coefficients_, first_radius_;
};

// A profile: spline and coefficients. Immutable.
class Profile {
 public:
  // Throws InputError if the number of coefficients is not the spline's, one is not finite, or the tail's exponent
  // 2 + q_K is not above 3/2: the mean slope and with it the masking would not exist.
  Profile(std::shared_ptr<const ProfileSpline> spline, std::vector<double> q);

  const ProfileSpline& spline() const { return *spline_; }
  const std::vector<double>& q() const { return q_; }
  double tail_exponent() const { return 2.0 + q_.back(); }

  // E(u) and the local exponent g(u); dE/dq_k = B_k.
  double Excess(double u, double* g = nullptr) const;
  // E in an interval of the spline: the four coefficients of its cubic in u - Left(interval).
  const double* Cubic(std::size_t interval) const { return cubics_.data() + 4 * interval; }
  // Z / pi - 1, without the rounding of the subtraction: 0 for q = 0. Z_k / Z = d ln Z / dq_k.
  double mass_excess() const { return mass_excess_; }
  const std::vector<double>& dlog_mass() const { return dlog_mass_; }
  // Share of Z that lies beyond r.
  double MassBeyond(double r) const;

 private:
  std::shared_ptr<const ProfileSpline> spline_;
  std::vector<double> q_;
  std::vector<double> cubics_;  // of E, four an interval
  double mass_excess_ = 0.0;
  std::vector<double> dlog_mass_;
};

// D(wm), 1/sr: GGX's D (slope_distribution.h; `slopes.family` is not read) times e^E pi / Z; 0 for wm.z <= 0. Gradient
// by alpha_x, alpha_y, r, slope_x, slope_y and q: d ln D / dq_k = B_k(u) - Z_k / Z.
double ProfileD(const Profile& profile, const SlopeDistribution& slopes, const Vec3& wm, double* gradient = nullptr);

}  // namespace lobefit

// Smith masking of a profile (profile.h): its one-dimensional Lambda, by a fixed quadrature and by a table.
//
// [Heitz] Heitz 2014 eq 73-78, 96; MATH.md section 8.1. With a = c / sqrt(q) of smith.h and P2 the one-dimensional
// density of slopes,
//   T(a) = int_a^inf P2,  M(a) = int_a^inf T,   sigma = sqrt(q) S(a),  S(a) = M(-a) = a + M(a);
// as integrals over s, t = a^2 + s^2, whose integrands are positive:
//   Z M = 2 int f s (s - a atan(s/a)) ds,   Z T = 2 int f s atan(s/a) ds,   Z P2 = 2 int f ds.
// The table holds what differs from GGX, whose M is closed: at q = 0 it is 0 and sigma is GGX's to the bit.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "lobefit/core/radial/moment_matrix.h"
#include "lobefit/core/radial/profile.h"
#include "lobefit/core/radial/profile_moments.h"
#include "lobefit/core/radial/profile_table.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {

// What a tail (1 + t)^-c of exponent c > 3/2 is at every a.
struct ProfileTail {
  explicit ProfileTail(double c);
  static constexpr std::size_t kTerms = 20;
  double exponent, dlog_ratio, gamma_ratio;  // Gamma(c) / Gamma(c - 1/2) and the derivative of its logarithm
  std::array<double, kTerms + 1> inverse;    // 1 / (c + n - 3/2)
};

// M, T and P2 at one a >= 0 for any coefficients of a spline: Gauss-Legendre between the circles of the knots, series
// beyond (for a beyond the last knot nothing else). Nodes and kernels do not depend on the coefficients.
class ProfileRule {
 public:
  // `rule` for each of `parts` equal parts of a panel: 20 points keep 3e-15 of the values of moderate profiles, and
  // 7e-8 of one of e^-100.
  ProfileRule(const ProfileSpline& spline, double a, const QuadratureRule& rule, int parts = 1);

  // moments[m * stride]: M, T, P2 (m = 0, 1, 2), followed by the derivatives by q; stride > spline.size().
  // `minus_ggx`: the values less those of GGX. `tail`: the profile's.
  void Apply(const Profile& profile, const ProfileTail& tail, bool minus_ggx, double* moments,
             std::size_t stride) const;
  // What Apply does after the sums over the points, for sums that come from elsewhere.
  void Complete(const Profile& profile, const ProfileTail& tail, bool minus_ggx, double* moments,
                std::size_t stride) const;

  const ProfilePoints& points() const { return points_; }
  // u beyond all points, the same for every a below the last knot.
  static double EndOfPoints(const ProfileSpline& spline);

 private:
  void AddPanels(const ProfileSpline& spline, const QuadratureRule& rule, int parts);
  void AddPanel(const ProfileSpline& spline, std::size_t interval, double from, double to, const QuadratureRule& rule);
  // Of f beyond the panels for f = 1 at their end, and the derivatives of the logarithms by the exponent.
  std::array<double, 3> TailMoments(const ProfileTail& tail, double* dlog) const;
  void AddTail(const Profile& profile, const ProfileTail& tail, bool minus_ggx, double* moments,
               std::size_t stride) const;

  double a_, end_;  // the panels' last radius
  ProfilePoints points_;
  std::array<double, ProfileTail::kTerms> j_{}, e_{}, h_{};  // the tail's series, times (1 + end_^2)^-n
  double u_ = 0, f_ggx_ = 0;                                 // at end_
  std::vector<double> basis_;                                // there
  double log_shift_ = 0;                                     // a beyond end_: f at a instead
  std::array<double, 2> edge_{};                             // (1 + end_^2) times s - a atan(s / a) and atan(s / a)
  std::array<double, 3> ggx_{};                              // GGX's tail
};

// Nodes of a table for any coefficients of a spline; immutable, some milliseconds to make.
class ProfileGrid {
 public:
  explicit ProfileGrid(std::shared_ptr<const ProfileSpline> spline);
  const std::shared_ptr<const ProfileSpline>& spline() const { return spline_; }

 private:
  friend class ProfileMasking;
  std::vector<double> Table(const Profile& profile) const;

  std::shared_ptr<const ProfileSpline> spline_;
  std::vector<ProfileBreak> breaks_;
  std::vector<double> a_;     // of the nodes
  std::size_t stride_;        // numbers of a row of a table
  std::vector<double> zero_;  // the table of coefficients 0, where fits begin
  std::vector<ProfileRule> rules_;
  std::size_t below_;    // nodes below the last knot, of which the matrix has rows
  MomentMatrix matrix_;  // of profiles that it resolves
};

// The table of one profile: quintic Hermite interpolation of M, M' = -T, M'' = P2 and of their derivatives by q.
// Immutable after construction (a tenth of a millisecond); one serves all samples of an iteration. Absolute error of
// sigma / sqrt(q) below 1e-12, of its derivatives 1e-10.
class ProfileMasking {
 public:
  ProfileMasking(std::shared_ptr<const ProfileGrid> grid, Profile profile);

  const Profile& profile() const { return profile_; }

  // difference[i * stride()]: M(a[i]) less GGX's; then its derivatives by q, padded to stride() numbers. slope[i]: its
  // derivative in a; without it those by q are not set either. Any a >= 0, infinity included; quick below 10^6.
  void Differences(const double* a, std::size_t count, double* slope, double* difference) const;
  std::size_t stride() const { return stride_; }

 private:
  std::shared_ptr<const ProfileGrid> grid_;
  Profile profile_;
  std::size_t stride_;
  std::vector<double> table_;  // [node][M, T, P2][value, derivatives by q, padding to stride_]
};

}  // namespace lobefit

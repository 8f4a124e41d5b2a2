#include "lobefit/core/radial/moment_matrix.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/core/radial/profile_masking.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr double kRadii[] = {0, 0.01, 0.3, 1, 1.4, 3, 7.9, 12, 31};

std::shared_ptr<const ProfileSpline> SplineOf(std::vector<double> knots) {
  return std::make_shared<const ProfileSpline>(std::move(knots));
}

struct Rows {
  std::vector<ProfileRule> rules;
  MomentMatrix matrix;
};
Rows RowsOf(const ProfileSpline& spline) {
  Rows rows = {{}, MomentMatrix(spline, ProfileRule::EndOfPoints(spline))};
  const QuadratureRule rule = GaussLegendre(20);
  for (const double a : kRadii) {
    if (!(a < spline.knots().back())) continue;
    rows.rules.emplace_back(spline, a, rule);
    rows.matrix.Add(rows.rules.back().points());
  }
  rows.matrix.Finish();
  return rows;
}

// The oracle: the sums over the points themselves.
TEST(MomentMatrix, IsTheSumsOverThePoints) {
  ShapeGenerator random(320);
  for (const auto& spline :
       {SplineOf({0, 1, 2, 4, 8, 16, 32}), SplineOf({0, 0.25, 0.5, 0.75, 1, 1.5, 2}), SplineOf({0, 1})}) {
    const Rows rows = RowsOf(*spline);
    const std::size_t K = spline->size(), stride = K + 3;
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<double> q;
      for (std::size_t k = 0; k < K; ++k) q.push_back(random.Uniform(-0.45, 0.15 * trial));
      const Profile profile(spline, q);
      ASSERT_TRUE(rows.matrix.Resolves(profile));
      std::vector<double> moments(rows.rules.size() * 3 * stride, 7.0), expected(3 * stride);
      rows.matrix.Moments(profile, stride, moments.data());
      for (std::size_t i = 0; i < rows.rules.size(); ++i) {
        std::fill(expected.begin(), expected.end(), 0.0);
        rows.rules[i].points().AddMoments(profile, true, expected.data(), stride);
        double most = 0;
        for (const double x : expected) most = std::fmax(most, std::fabs(x));
        for (std::size_t k = 0; k < 3 * stride; ++k)
          EXPECT_NEAR(moments[i * 3 * stride + k], expected[k], 2e-14 * std::fmax(most, 1)) << kRadii[i] << " " << k;
      }
    }
  }
}

// What it does not resolve it says, and the table is right all the same.
TEST(MomentMatrix, LeavesSteepProfilesToThePoints) {
  const auto spline = SplineOf({0, 1, 2, 4, 8, 16, 32});
  const Rows rows = RowsOf(*spline);
  const Profile steep(spline, {-30, 20, 1, 0, 0, 0}), even(spline, {-3, 2, 1, 0, 0, 0});
  EXPECT_FALSE(rows.matrix.Resolves(steep));
  EXPECT_TRUE(rows.matrix.Resolves(even));
  const ProfileMasking masking(std::make_shared<const ProfileGrid>(spline), steep);
  const double a = 0.7;
  double expected[21], slope, found[8];
  ProfileRule(*spline, a, GaussLegendre(32), 8).Apply(steep, ProfileTail(steep.tail_exponent()), true, expected, 7);
  masking.Differences(&a, 1, &slope, found);
  EXPECT_NEAR(found[0], expected[0], 1e-9);
}

}  // namespace
}  // namespace lobefit

#include "lobefit/core/slopes/slope_sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/reference_table.h"
#include "tests/support/table_check.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Triangle = std::array<Vec2, 3>;

TEST(TruncatedRadius, Table) {
  const ReferenceTable table("truncated_radius");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double alpha = table(row, "alpha"), r_min = table(row, "r_min"), r_max = table(row, "r_max"),
                 v = table(row, "V");
    TruncatedRadiusGradient g;
    const double s = TruncatedRadius(alpha, r_min, r_max, v, &g);
    EXPECT_NEAR(s, table(row, "s_r"), 1e-12 * s) << row;
    EXPECT_NEAR(TruncatedRadiusMass(alpha, r_min, r_max), table(row, "N_R"), 1e-12 * table(row, "N_R")) << row;
    ExpectTableDerivatives(table, row, {"ds_dalpha", "ds_drmin", "ds_drmax", "ds_dV"},
                           {g.dalpha, g.dr_min, g.dr_max, g.dv}, 1e-12);
    EXPECT_EQ(TruncatedRadius(alpha, r_min, r_max, v), s);
  }
}

TEST(TruncatedRadius, InvertsTheCumulativeDistribution) {
  std::mt19937_64 random(54);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const double alpha = std::pow(10.0, -4 * unit(random)),
                 r_min = i % 3 == 0 ? 0 : alpha * std::pow(10.0, 4 * unit(random) - 2);
    const double r_max = i % 4 == 0 ? kInfinity : (r_min + alpha) * (1 + std::pow(10.0, 6 * unit(random) - 3));
    const double v = unit(random), s = TruncatedRadius(alpha, r_min, r_max, v);
    EXPECT_GE(s, r_min * (1 - 1e-15));
    EXPECT_LE(s, r_max * (1 + 1e-15));
    const double mass = TruncatedRadiusMass(alpha, r_min, r_max);
    EXPECT_NEAR(TruncatedRadiusMass(alpha, r_min, s), v * mass, 1e-11 * mass + 4e-16 * s * s / (alpha * alpha + s * s));
  }
  EXPECT_EQ(TruncatedRadius(0.3, 0.2, 0.7, 0), 0.2);
  EXPECT_NEAR(TruncatedRadius(0.3, 0.2, 0.7, 1), 0.7, 1e-15);
  EXPECT_NEAR(TruncatedRadius(0.3, 0.2, 1.7, 0.37), 0.333458, 1e-6);  // MATH.md section 3
}

// 10^2 equal parts of the triangle (n rows of small triangles), expected counts by the closed form.
double TriangleChiSquare(const Triangle& p, double ax, double ay, int seed) {
  constexpr int kRows = 10, kSamples = 30000;
  const GgxTriangleSampler sampler(p, ax, ay);
  const Vec2 b = {p[1].x - p[0].x, p[1].y - p[0].y}, c = {p[2].x - p[0].x, p[2].y - p[0].y};
  const double det = b.x * c.y - b.y * c.x;
  const auto at = [&](double i, double j) {
    return Vec2{p[0].x + i / kRows * b.x + j / kRows * c.x, p[0].y + i / kRows * b.y + j / kRows * c.y};
  };
  std::vector<double> counts(2 * kRows * kRows, 0.0), expected(2 * kRows * kRows, 0.0);
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; i + j < kRows; ++j) {
      expected[2 * (i * kRows + j)] =
          kSamples / sampler.integral() * GgxTriangleIntegral({at(i, j), at(i + 1, j), at(i, j + 1)}, ax, ay);
      if (i + j + 1 == kRows) continue;
      expected[2 * (i * kRows + j) + 1] =
          kSamples / sampler.integral() * GgxTriangleIntegral({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, ax, ay);
    }
  }
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < kSamples; ++k) {
    const double u = unit(random);
    const Vec2 s = sampler.Sample(u, unit(random));
    const double x = s.x - p[0].x, y = s.y - p[0].y;
    const double s1 = kRows * (x * c.y - y * c.x) / det, s2 = kRows * (b.x * y - b.y * x) / det;
    EXPECT_TRUE(s1 > -1e-6 && s2 > -1e-6 && s1 + s2 < kRows + 1e-6) << s1 << " " << s2;
    const int i = std::clamp(static_cast<int>(s1), 0, kRows - 1),
              j = std::clamp(static_cast<int>(s2), 0, kRows - 1 - i);
    const bool upper = (s1 - i) + (s2 - j) > 1 && i + j + 1 < kRows;
    counts[2 * (i * kRows + j) + (upper ? 1 : 0)] += 1;
  }
  return ChiSquarePValue(counts, expected);
}

TEST(GgxTriangleSampler, ChiSquare) {
  struct Case {
    Triangle p;
    double ax, ay;
  };
  const std::vector<Case> cases = {
      {{{{-1, -1}, {2, -1}, {0, 1.5}}}, 1, 1},                   // around the origin
      {{{{-1, -1}, {0, 1.5}, {2, -1}}}, 0.2, 0.5},               // other orientation, anisotropic
      {{{{0.5, 0.2}, {2, 0.1}, {1, 1.4}}}, 1, 1},                // beside it, middle vertex near
      {{{{0.5, -1}, {2, 0.1}, {0.6, 1.4}}}, 0.4, 0.8},           // middle vertex far
      {{{{0, 0}, {1, 0.2}, {0.3, 1}}}, 0.5, 0.5},                // a vertex at the origin
      {{{{-1, 0}, {1, 0}, {0.2, 1}}}, 0.3, 0.3},                 // an edge through the origin
      {{{{1, 0}, {2, 0}, {1.5, 1}}}, 0.5, 0.5},                  // an edge pointing at the origin
      {{{{30, 3}, {31, 2}, {30.5, 4}}}, 1, 1},                   // far away
      {{{{0.3, 0.3}, {0.3001, 0.3}, {0.3, 0.3001}}}, 0.1, 0.2},  // small
      {{{{-50, -50}, {70, -40}, {10, 90}}}, 0.5, 1},             // large
      {{{{0.2, 0.1}, {1.5, 0.9}, {0.8, 0.47}}}, 0.3, 0.4},       // thin
      {{{{0.01, -0.02}, {0.03, 0.01}, {-0.02, 0.02}}}, 1e-3, 2e-3},
      {{{{-3, 1}, {-1, 2}, {-4, 4}}}, 1, 0.05},
      {{{{2, -5}, {2.5, 5}, {3, 0}}}, 1, 1},  // wide azimuth, thin
  };
  const double threshold = SidakThreshold(0.01, static_cast<int>(cases.size()));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_GT(TriangleChiSquare(cases[i].p, cases[i].ax, cases[i].ay, static_cast<int>(100 + i)), threshold) << i;
  }
}

TEST(GgxTriangleSampler, PdfIntegratesToOneAndCornersAreFinite) {
  const Triangle p = {{{0.5, 0.2}, {2, 0.1}, {1, 1.4}}};
  const GgxTriangleSampler sampler(p, 0.7, 0.9);
  EXPECT_NEAR(sampler.integral(), GgxTriangleIntegral(p, 0.7, 0.9), 1e-15);
  EXPECT_NEAR(sampler.Pdf({1, 0.5}) * sampler.integral(), GgxSlopeDensity({1, 0.5}, 0.7, 0.9), 1e-15);
  for (const double u : {0.0, 1e-300, 0.5, 1 - 1e-16, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const Vec2 s = sampler.Sample(u, v);
      EXPECT_TRUE(std::isfinite(s.x) && std::isfinite(s.y)) << u << " " << v;
    }
  }
}

TEST(ChiSquare, TailAndSensitivity) {
  EXPECT_NEAR(ChiSquareTail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquareTail(124.34211340400407, 100), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquareTail(77.92946516501729, 100), 0.95, 1e-12);
  // A sampler that ignores the distribution is found out.
  EXPECT_LT(ChiSquarePValue({500, 500}, {560, 440}), 1e-3);
  EXPECT_EQ(ChiSquarePValue({999, 1}, {1000, 0}), 0);
}

}  // namespace
}  // namespace lobefit

#include "lobefit/core/slopes/slope_integral.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/support/reference_table.h"
#include "tests/support/table_check.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

using Triangle = std::array<Vec2, 3>;

std::vector<double> Flat(const GgxTriangleGradient& g) {
  return {g.dalpha_x,       g.dalpha_y,       g.dvertices[0].x, g.dvertices[0].y,
          g.dvertices[1].x, g.dvertices[1].y, g.dvertices[2].x, g.dvertices[2].y};
}

TEST(GgxTriangle, Table) {
  const ReferenceTable table("triangle_ggx");
  double worst_value = 0;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Triangle p = {{{table(row, "p0x"), table(row, "p0y")},
                         {table(row, "p1x"), table(row, "p1y")},
                         {table(row, "p2x"), table(row, "p2y")}}};
    const double ax = table(row, "alpha_x"), ay = table(row, "alpha_y"), reference = table(row, "integral");
    GgxTriangleGradient g;
    const double integral = GgxTriangleIntegral(p, ax, ay, &g);
    EXPECT_NEAR(integral, reference, 1e-11 * reference) << row;
    worst_value = std::fmax(worst_value, std::fabs(integral / reference - 1));
    ExpectTableDerivatives(table, row,
                           {"dintegral_dalpha_x", "dintegral_dalpha_y", "dintegral_dp0x", "dintegral_dp0y",
                            "dintegral_dp1x", "dintegral_dp1y", "dintegral_dp2x", "dintegral_dp2y"},
                           Flat(g), 1e-10);
    EXPECT_EQ(GgxTriangleIntegral(p, ax, ay), integral);
    // The other orientation: the same value, the same derivatives at the same points.
    GgxTriangleGradient turned;
    EXPECT_NEAR(GgxTriangleIntegral({p[0], p[2], p[1]}, ax, ay, &turned), reference, 1e-11 * reference);
    std::swap(turned.dvertices[1], turned.dvertices[2]);
    ExpectTableDerivatives(table, row,
                           {"dintegral_dalpha_x", "dintegral_dalpha_y", "dintegral_dp0x", "dintegral_dp0y",
                            "dintegral_dp1x", "dintegral_dp1y", "dintegral_dp2x", "dintegral_dp2y"},
                           Flat(turned), 1e-10);
  }
  RecordProperty("largest_relative_error", std::to_string(worst_value * 1e15) + "e-15");
}

TEST(GgxTriangle, GradientEqualsJets) {
  using Jet = ceres::Jet<double, 8>;
  std::mt19937_64 random(51);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> unit(0.2, 1.0);
  for (int i = 0; i < 500; ++i) {
    const double ax = unit(random), ay = unit(random);
    Triangle p;
    for (Vec2& v : p) v = {gauss(random), gauss(random)};
    std::array<Vec2T<Jet>, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = {Jet(p[k].x, 2 + 2 * k), Jet(p[k].y, 3 + 2 * k)};
    const Jet jet = GgxTriangleIntegralFormula(q, Jet(ax, 0), Jet(ay, 1));
    if (jet.a < 1e-3) continue;
    GgxTriangleGradient g;
    EXPECT_NEAR(GgxTriangleIntegral(p, ax, ay, &g), jet.a, 1e-13);
    const std::vector<double> flat = Flat(g);
    for (int k = 0; k < 8; ++k) EXPECT_NEAR(flat[k], jet.v[k], 1e-10 * jet.v.norm()) << k;
  }
}

TEST(GgxTriangle, AgainstTwoDimensionalQuadrature) {
  for (const Triangle& p : {Triangle{{{0.1, 0.2}, {0.9, -0.3}, {-0.4, 0.6}}}, Triangle{{{3, 0.2}, {4, 0.3}, {3.5, 2}}},
                            Triangle{{{-1, -1}, {2, -1}, {0, 1.5}}}}) {
    const double ax = 0.3, ay = 0.7;
    const Vec2 a = p[0], b = {p[1].x - a.x, p[1].y - a.y}, c = {p[2].x - a.x, p[2].y - a.y};
    const double area = std::fabs(b.x * c.y - b.y * c.x);
    const double integral = IntegrateAdaptive(
        [&](double s) {
          return s * IntegrateAdaptive(
                         [&](double t) {
                           const double u = s * (1 - t), w = s * t;
                           return GgxSlopeDensity({a.x + u * b.x + w * c.x, a.y + u * b.y + w * c.y}, ax, ay);
                         },
                         0, 1);
        },
        0, 1);
    EXPECT_NEAR(GgxTriangleIntegral(p, ax, ay), area * integral, 1e-11);
  }
}

TEST(GgxTriangle, WholePlaneHalfPlaneAndNothing) {
  const double far = 1e9;
  GgxTriangleGradient whole;
  EXPECT_NEAR(GgxTriangleIntegral({{{-far, -far}, {far, -far}, {0, far}}}, 0.3, 0.01, &whole), 1, 1e-12);
  for (const double d : Flat(whole)) EXPECT_NEAR(d, 0, 1e-12);
  EXPECT_NEAR(GgxTriangleIntegral({{{-far, 0}, {far, 0}, {0, far}}}, 0.3, 0.01), 0.5, 1e-9);
  GgxTriangleGradient g;
  EXPECT_EQ(GgxTriangleIntegral({{{0, 0}, {1, 1}, {2, 2}}}, 1, 1, &g), 0);
  for (const double d : Flat(g)) EXPECT_TRUE(std::isfinite(d));
  EXPECT_EQ(GgxTriangleIntegral({{{1, 2}, {1, 2}, {1, 2}}}, 1, 1, &g), 0);
  for (const double d : Flat(g)) EXPECT_TRUE(std::isfinite(d));
}

// Subdivision is a law that no single form can satisfy by accident where another form takes over.
TEST(GgxTriangle, PartsAddUpForHostileTriangles) {
  std::mt19937_64 random(52);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> gauss;
  double worst = 0;
  for (int i = 0; i < 3000; ++i) {
    const double size = std::pow(10.0, -6 + 8 * unit(random)), distance = std::pow(10.0, -2 + 4.5 * unit(random));
    const double phi = 6.28 * unit(random), ax = std::pow(10.0, -4 * unit(random)),
                 ay = std::pow(10.0, -4 * unit(random));
    Triangle p;
    for (Vec2& v : p) {
      v = {ax * (distance * std::cos(phi) + size * gauss(random)),
           ay * (distance * std::sin(phi) + size * gauss(random))};
    }
    if (i % 5 == 0) {
      const double t = std::pow(10.0, -9 * unit(random));  // thin
      p[2] = {0.4 * p[0].x + 0.6 * p[1].x + t * size * ax, 0.4 * p[0].y + 0.6 * p[1].y};
    }
    const Vec2 middle = {0.5 * (p[0].x + p[1].x), 0.5 * (p[0].y + p[1].y)};
    const double whole = GgxTriangleIntegral(p, ax, ay);
    const double parts =
        GgxTriangleIntegral({p[0], middle, p[2]}, ax, ay) + GgxTriangleIntegral({middle, p[1], p[2]}, ax, ay);
    // The middle vertex is itself rounded: the thin triangle that this opens belongs to the comparison.
    const double opened = GgxTriangleIntegral({p[0], middle, p[1]}, ax, ay);
    EXPECT_LE(std::fabs(parts - whole), opened * (1 + 1e-9) + 1e-12 * whole)
        << i << " size " << size << " distance " << distance;
    if (opened < 1e-15 * whole) worst = std::fmax(worst, std::fabs(parts / whole - 1));
    EXPECT_GE(whole, 0);
    EXPECT_LE(whole, 1 + 1e-14);
  }
  RecordProperty("largest_relative_difference", std::to_string(worst * 1e15) + "e-15");
}

TEST(GgxPolygon, EqualsItsTrianglesWhereverTheyStart) {
  std::mt19937_64 random(53);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 100; ++trial) {
    // Star-shaped about a point, so simple but often not convex.
    const double ax = 0.05 + unit(random), ay = 0.05 + unit(random), cx = unit(random), cy = unit(random);
    std::vector<Vec2> polygon;
    double triangles = 0;
    const int n = 3 + trial % 7;
    for (int i = 0; i < n; ++i) {
      const double phi = 2 * kPi * i / n, r = 0.1 + unit(random);
      polygon.push_back({cx + r * std::cos(phi), cy + r * std::sin(phi)});
    }
    for (int i = 0; i < n; ++i)
      triangles += GgxTriangleIntegral({{{cx, cy}, polygon[i], polygon[(i + 1) % n]}}, ax, ay);
    GgxPolygonGradient g;
    const double integral = GgxPolygonIntegral(polygon, ax, ay, &g);
    EXPECT_NEAR(integral, triangles, 1e-13);
    EXPECT_EQ(GgxPolygonIntegral(polygon, ax, ay), integral);
    std::vector<Vec2> turned = polygon;
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    EXPECT_NEAR(GgxPolygonIntegral(turned, ax, ay), integral, 1e-13);
    std::reverse(turned.begin(), turned.end());
    GgxPolygonGradient g_turned;
    EXPECT_NEAR(GgxPolygonIntegral(turned, ax, ay, &g_turned), integral, 1e-13);
    EXPECT_NEAR(g_turned.dalpha_x, g.dalpha_x, 1e-12 * (1 + std::fabs(g.dalpha_x)));
    // Derivatives by differences, and moving every vertex as one: scaling slopes and alphas together changes nothing.
    const double h = 1e-6;
    std::vector<Vec2> moved = polygon;
    moved[1].x += h;
    const double up = GgxPolygonIntegral(moved, ax, ay);
    moved[1].x -= 2 * h;
    EXPECT_NEAR((up - GgxPolygonIntegral(moved, ax, ay)) / (2 * h), g.dvertices[1].x, 1e-7);
    EXPECT_NEAR((GgxPolygonIntegral(polygon, ax, ay + h) - GgxPolygonIntegral(polygon, ax, ay - h)) / (2 * h),
                g.dalpha_y, 1e-6);
    double scale_x = ax * g.dalpha_x;
    for (int i = 0; i < n; ++i) scale_x += polygon[i].x * g.dvertices[i].x;
    EXPECT_NEAR(scale_x, 0, 1e-12);
  }
}

}  // namespace
}  // namespace lobefit

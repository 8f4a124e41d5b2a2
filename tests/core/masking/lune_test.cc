#include "lobefit/core/masking/lune.h"

#include "tests/support/reference_table.h"
#include "tests/support/shapes.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

TEST(LuneTable, ProjectedAndLuneArea) {
  const ReferenceTable table("lune_area");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Ellipsoid e = EllipsoidOfRow(table, row);
    const Vec3 u = DirectionOfRow(table, row, "u"), v = DirectionOfRow(table, row, "v");
    const double cond = table(row, "cond");
    double gradient[5];
    ExpectValue(EllipsoidProjectedArea(e, u), table(row, "A_e_u"), cond, row);
    ExpectValue(EllipsoidLuneArea(e, u, v, gradient), table(row, "A_l_uv"), cond, row);
    ExpectGradient(gradient, table, row, "dAl_d", kEllipsoidNames, cond);
  }
}

TEST(LuneJets, GradientsInParametersAndDirections) {
  using Jet = ceres::Jet<double, 11>;
  ShapeGenerator random(51);
  for (int i = 0; i < 1000; ++i) {
    const Ellipsoid e = i % 2 == 0 ? random.Moderate() : random.Hostile();
    const Vec3 u = random.Sphere(), v = random.Sphere();
    const Jet p[5] = {Jet(e.alpha_x, 0), Jet(e.alpha_y, 1), Jet(e.theta_x, 2), Jet(e.theta_y, 3), Jet(e.theta_z, 4)};
    const Vec3T<Jet> ju = {Jet(u.x, 5), Jet(u.y, 6), Jet(u.z, 7)}, jv = {Jet(v.x, 8), Jet(v.y, 9), Jet(v.z, 10)};
    double gradient[5];
    Vec3 du, dv;
    const double area = EllipsoidLuneArea(e, u, v, gradient, &du, &dv);
    const Jet jet = EllipsoidLuneAreaFormula(p, ju, jv);
    EXPECT_NEAR(area, jet.a, 1e-10 * area);
    ExpectSameGradient(gradient, jet.v.data(), 5, 1e-10, area);
    const double entries[6] = {du.x, du.y, du.z, dv.x, dv.y, dv.z};
    ExpectSameGradient(entries, jet.v.data() + 5, 6, 1e-9, area);
    EXPECT_EQ(area, EllipsoidLuneArea(e, u, v));
    // The whole ellipsoid: u against itself.
    double whole_gradient[5];
    const double whole = EllipsoidProjectedArea(e, u, whole_gradient);
    const Jet jet_whole = EllipsoidLuneAreaFormula(p, ju, ju);
    EXPECT_NEAR(whole, jet_whole.a, 1e-10 * whole);
    ExpectSameGradient(whole_gradient, jet_whole.v.data(), 5, 1e-9, whole);
  }
}

TEST(LuneLaws, SpecialDirections) {
  ShapeGenerator random(52);
  for (int i = 0; i < 500; ++i) {
    const Ellipsoid e = random.Hostile();
    const Vec3 u = random.Sphere(), v = random.Sphere(), n = {0, 0, 1};
    const double whole = EllipsoidProjectedArea(e, u);
    EXPECT_NEAR(EllipsoidProjectedArea(e, n), 1, 1e-14);
    EXPECT_NEAR(EllipsoidLuneArea(e, u, n), EllipsoidSigma(e, u), 1e-12 * whole);
    EXPECT_NEAR(EllipsoidLuneArea(e, u, u), whole, 1e-14 * whole);
    EXPECT_EQ(EllipsoidLuneArea(e, u, -u), 0);
    // What faces u and v and what faces u and not v make up the visible half.
    EXPECT_NEAR(EllipsoidLuneArea(e, u, v) + EllipsoidLuneArea(e, u, -v), whole, 1e-13 * whole);
  }
}

}  // namespace
}  // namespace lobefit

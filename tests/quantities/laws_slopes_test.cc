// Laws that tie quantities of distributions to each other: the same distribution under two names, identities of
// projected areas, integrals.
#include <cmath>
#include <string>
#include <vector>

#include "tests/quantities/named_row.h"
#include <gtest/gtest.h>

#include "lobefit/math/quadrature.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using test::Evaluated;
using test::ExpectClose;
using test::Named;
using test::Rows;
using test::With;

const Named kGgx = {{"kind", 1}};

TEST(SlopeLaws, StudentOfGammaTwoIsGgx) {
  for (const Named& row : Rows("offcenter_D", 1, 40)) {
    ExpectClose(Evaluated("student_D", With(row, {{"gamma", 2}}))["D"], Evaluated("offcenter_D", With(row, kGgx))["D"],
                1e-12, "D");
  }
  for (const Named& row : Rows("smith_lambda", 2, 10)) {
    Named student = Evaluated("student_sigma", With(row, {{"gamma", 2}}));
    Named ggx = Evaluated("smith_lambda", With(row, kGgx));
    for (const char* column : {"c", "q", "a", "sigma"}) ExpectClose(student[column], ggx[column], 1e-11, column);
  }
}

TEST(SlopeLaws, AFlatProfileIsGgx) {
  for (const Named& row : Rows("offcenter_D", 3, 40)) {
    Named ggx = Evaluated("offcenter_D", With(row, kGgx));
    Named profile = Evaluated("profile_D", row);
    ExpectClose(profile["D"], ggx["D"], 1e-12, "D");
    ExpectClose(profile["P22"], ggx["P22"], 1e-12, "P22");
  }
  for (const Named& row : Rows("smith_lambda", 4, 10)) {
    Named ggx = Evaluated("smith_lambda", With(row, kGgx));
    Named profile = Evaluated("profile_sigma", row);
    for (const char* column : {"sigma", "G1_clamped", "clamped"}) {
      ExpectClose(profile[column], ggx[column], 1e-11, column);
    }
  }
}

// The ellipsoid, and the slopes that it is converted to, have one D, one sigma, one mask.
TEST(SlopeLaws, AnEllipsoidIsItsSlopes) {
  for (const Named& row : Rows("ellipsoid_G1", 5, 60)) {
    Named to = Evaluated("offcenter_from_ellipsoid", row);
    const Named slopes = With(With(row, kGgx), {{"alpha_x", to["slope_alpha_x"]},
                                                {"alpha_y", to["slope_alpha_y"]},
                                                {"r", to["slope_r"]},
                                                {"slope_x", to["slope_x"]},
                                                {"slope_y", to["slope_y"]}});
    Named ellipsoid = Evaluated("ellipsoid_G1", row), smith = Evaluated("smith_lambda", slopes);
    ExpectClose(ellipsoid["sigma"], smith["sigma"], 1e-9, "sigma");
    ExpectClose(ellipsoid["G1"], smith["G1_clamped"], 1e-9, "G1");
    EXPECT_NEAR(ellipsoid["meso_c"], smith["c"], 1e-11 * (1 + std::abs(smith["c"])));
    const Named normal = test::Renamed(row, "u", "m"), normal_of_slopes = test::Renamed(slopes, "u", "m");
    ExpectClose(Evaluated("ellipsoid_D", normal)["D"], Evaluated("offcenter_D", normal_of_slopes)["D"], 1e-8, "D");
    // And back, to the canonical form: the same distribution, whatever its angles are called.
    Named back = Evaluated("ellipsoid_from_offcenter", to);
    EXPECT_TRUE(back["alpha_x"] <= 1 && back["alpha_y"] <= back["alpha_x"] && std::abs(back["theta_z"]) <= kPi / 2);
    ExpectClose(Evaluated("ellipsoid_D", With(normal, back))["D"], Evaluated("ellipsoid_D", normal)["D"], 1e-7, "back");
  }
}

// int D(m) (m.u) dm = c(u), and <x> - <-x> = x: sigma(u) - sigma(-u) = c(u).
TEST(SlopeLaws, BothSidesOfASurfaceDifferByItsMeanSurface) {
  for (const char* name : {"smith_lambda", "profile_sigma", "student_sigma"}) {
    for (const Named& row : Rows(name, 6, 8)) {
      Named above = Evaluated(name, row);
      Named below = Evaluated(name, With(row, {{"ux", -row.at("ux")}, {"uy", -row.at("uy")}, {"uz", -row.at("uz")}}));
      EXPECT_NEAR(above["sigma"] - below["sigma"], above["c"], 1e-13 * (1 + std::abs(above["c"]))) << name;
      EXPECT_NEAR(above["sigma"], above["c"] * (1 + above["Lambda"]), 1e-9 * above["sigma"]) << name;
    }
  }
}

// The lune that faces u and v, with the one that faces u and -v, is all that faces u.
TEST(SlopeLaws, TwoLunesMakeTheWhole) {
  for (const Named& row : Rows("lune_area", 7, 60)) {
    Named lune = Evaluated("lune_area", row);
    Named rest =
        Evaluated("lune_area", With(row, {{"vx", -row.at("vx")}, {"vy", -row.at("vy")}, {"vz", -row.at("vz")}}));
    EXPECT_NEAR(lune["A_l_uv"] + rest["A_l_uv"], lune["A_e_u"], 1e-13 * lune["A_e_u"]);
    EXPECT_NEAR(Evaluated("lune_area", test::Renamed(row, "u", "v"))["A_l_uv"], lune["A_e_u"], 1e-13 * lune["A_e_u"]);
    EXPECT_GE(lune["A_l_uv"], -1e-15 * lune["A_e_u"]);
  }
}

TEST(SlopeLaws, VisibleNormalsAreTheirFactors) {
  for (const Named& row : Rows("vndf_pdf", 8, 60)) {
    const auto length = [&](const std::string& of) {
      return std::hypot(row.at(of + "x"), row.at(of + "y"), row.at(of + "z"));
    };
    const double dot = (row.at("psix") * row.at("mx") + row.at("psiy") * row.at("my") + row.at("psiz") * row.at("mz")) /
                       (length("psi") * length("m"));
    const double sigma = Evaluated("ellipsoid_G1", test::Renamed(row, "psi", "u"))["sigma"];
    const double expected = Evaluated("ellipsoid_D", row)["D"] * std::fmax(0, dot) / sigma;
    ExpectClose(Evaluated("vndf_pdf", row)["pdf"], expected, 1e-11, "pdf");
  }
}

// Joint masking: what two directions see grows as their masking is taken to be more alike, and is at most what one sees
// [Heitz section 6].
TEST(SlopeLaws, MaskingIsOrdered) {
  for (const Named& row : Rows("g2", 9, 100)) {
    Named g = Evaluated("g2", row);
    const double least = std::fmin(1 / (1 + g["Lambda_o"]), 1 / (1 + g["Lambda_i"]));
    const double exact = 1 + 1e-14;
    EXPECT_LE(g["G2_separable"], g["G2_height"] * exact);
    EXPECT_LE(g["G2_separable"], g["G2_direction"] * exact);
    EXPECT_LE(g["G2_height"], g["G2_height_direction"] * exact);
    EXPECT_LE(g["G2_direction"], least * exact);
    EXPECT_LE(g["G2_height_direction"], least * exact);
    Named same = Evaluated("g2", test::Renamed(row, "o", "i"));
    ExpectClose(same["G2_direction"], 1 / (1 + same["Lambda_o"]), 1e-14, "one direction");
    ExpectClose(same["G2_height_direction"], 1 / (1 + same["Lambda_o"]), 1e-14, "one direction, by heights");
    Named swapped = Evaluated("g2", test::Swapped(row, "o", "i"));
    for (const char* kind : {"G2_separable", "G2_height", "G2_direction", "G2_height_direction"}) {
      ExpectClose(swapped[kind], g[kind], 1e-13, kind);
    }
  }
}

// Cauchy: the mean over all directions of the area that a closed surface shows is a quarter of the surface. Of int D dm
// = 1 over the sphere that is 2 pi int sigma du = 4 pi / 4.
TEST(SlopeLaws, MeanProjectedAreaIsAQuarter) {
  static const QuadratureRule rule = GaussLegendre(64);
  const std::vector<std::pair<std::string, Named>> cases = {
      {"sigma_ring", {{"un", 0.3}}},  {"sigma_ring", {{"un", -0.9}}}, {"sigma_ring", {{"un", 1}}},
      {"sigma_kk", {{"b", 0.2}}},     {"sigma_kk", {{"b", 0.97}}},    {"sigma_sg", {{"alpha", 0.1}}},
      {"sigma_sg", {{"alpha", 0.8}}}, {"sigma_sg", {{"alpha", 4}}}};
  for (const auto& [name, parameters] : cases) {
    double sum = 0;
    constexpr int kPanels = 64;
    for (int panel = 0; panel < kPanels; ++panel) {
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        const double u = -1 + (2 * panel + 1 + rule.nodes[i]) / kPanels;
        sum += rule.weights[i] / kPanels * Evaluated(name, With(parameters, {{"u", u}}))["sigma"];
      }
    }
    EXPECT_NEAR(2 * kPi * sum, kPi, 2e-5) << name;
  }
}

// sigma(1) = 1 by area; a surface seen edge-on from below shows nothing, and both sides differ by the cosine.
TEST(SlopeLaws, CrossSectionsByArea) {
  for (const char* name : {"sigma_beckmann", "sigma_ggx"}) {
    for (const double alpha : {1e-3, 0.1, 1.0, 10.0}) {
      EXPECT_DOUBLE_EQ(Evaluated(name, {{"alpha", alpha}, {"u", 1}})["sigma"], 1) << name;
      EXPECT_EQ(Evaluated(name, {{"alpha", alpha}, {"u", -1}})["sigma"], 0) << name;
      for (const double u : {0.0, 1e-9, 0.2, 0.9}) {
        const double above = Evaluated(name, {{"alpha", alpha}, {"u", u}})["sigma"];
        EXPECT_NEAR(above - Evaluated(name, {{"alpha", alpha}, {"u", -u}})["sigma"], u, 1e-14 * above) << name;
        const Named slopes = {{"kind", name[6] == 'b' ? 0 : 1},
                              {"alpha_x", alpha},
                              {"alpha_y", alpha},
                              {"ux", std::sqrt(1 - u * u)},
                              {"uz", u}};
        ExpectClose(above, Evaluated("smith_lambda", slopes)["sigma"], 1e-12, name);
      }
    }
  }
}

}  // namespace
}  // namespace lobefit

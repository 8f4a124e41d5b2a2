// Laws of the quantities of reflection: reciprocity, energy, limits in which one model is another, integrals.
#include <cmath>
#include <string>
#include <vector>

#include "tests/quantities/named_row.h"
#include <gtest/gtest.h>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using test::Evaluated;
using test::ExpectClose;
using test::Named;
using test::Renamed;
using test::Rows;
using test::Swapped;
using test::With;

Named Direction(const std::string& prefix, double theta, double phi) {
  return {{prefix + "x", std::sin(theta) * std::cos(phi)},
          {prefix + "y", std::sin(theta) * std::sin(phi)},
          {prefix + "z", std::cos(theta)}};
}

// Midpoints of equal solid angle weighted by the cosine: the mean of a BRDF times pi is its albedo.
template <class F>
double CosineMean(int side, const F& f) {
  double sum = 0;
  for (int a = 0; a < side; ++a) {
    for (int b = 0; b < 2 * side; ++b) sum += f(std::asin(std::sqrt((a + 0.5) / side)), kPi * (b + 0.5) / side);
  }
  return kPi * sum / (2.0 * side * side);
}

TEST(ReflectionLaws, BrdfsAreReciprocal) {
  const std::vector<std::pair<std::string, std::string>> columns = {{"brdf", "fr"},
                                                                    {"coat_brdf", "f_refracted"},
                                                                    {"coat_brdf", "f_layered"},
                                                                    {"diffuse_eon", "f"},
                                                                    {"retro_brdf", "symmetric"},
                                                                    {"profile_brdf", "specular"},
                                                                    {"misaligned_brdf", "fr"},
                                                                    {"profile_brdf", "specular_height"}};
  for (const auto& [name, column] : columns) {
    for (const Named& row : Rows(name, 1, 12)) {
      const double value = Evaluated(name, row)[column];
      ExpectClose(Evaluated(name, Swapped(row, "o", "i"))[column], value, 1e-11, name + " " + column);
    }
  }
  for (const Named& row : Rows("retro_brdf", 2, 20)) {
    Named one = Evaluated("retro_brdf", row), other = Evaluated("retro_brdf", Swapped(row, "o", "i"));
    ExpectClose(one["specular"], other["specular_swapped"], 1e-12, "retro");
  }
  for (const Named& row : Rows("diffuse_interfaced", 3, 20)) {
    const Named swapped = With(row, {{"cos_i", row.at("cos_o")}, {"cos_o", row.at("cos_i")}});
    ExpectClose(Evaluated("diffuse_interfaced", swapped)["f"], Evaluated("diffuse_interfaced", row)["f"], 1e-14, "f");
  }
}

TEST(ReflectionLaws, BrdfIsItsFactors) {
  for (const Named& row : Rows("brdf", 4, 60)) {
    Named f = Evaluated("brdf", row);
    const auto cosine = [&](const std::string& of) {
      return row.at(of + "z") / std::hypot(row.at(of + "x"), row.at(of + "y"), row.at(of + "z"));
    };
    const double co = cosine("o"), ci = cosine("i");
    if (co <= 0 || ci <= 0) {
      EXPECT_EQ(f["fr"], 0);
      continue;
    }
    ExpectClose(f["fr"], f["D"] * f["G1_o"] * f["G1_i"] * f["F"] / (4 * co * ci), 1e-12, "factors");
    EXPECT_TRUE(f["F"] >= 0 && f["F"] <= 1 && f["G1_o"] <= 1 && f["G1_i"] <= 1);
  }
}

// A sample that is not turned; and one that is turned about its normal under directions turned with it.
TEST(ReflectionLaws, MisalignmentOfNothingAndOfAll) {
  for (const Named& row : Rows("misaligned_brdf", 5, 40)) {
    const Named still = With(row, {{"e_x", 0}, {"e_y", 0}, {"e_z", 0}});
    const double fr = Evaluated("brdf", still)["fr"];
    for (const char* kind : {"fr", "fr_ci", "fr_co"}) {
      ExpectClose(Evaluated("misaligned_brdf", still)[kind], fr, 1e-10, kind);
    }
    const double e = row.at("e_z"), c = std::cos(e), s = std::sin(e);
    Named turned = With(still, {{"e_z", e}});
    for (const char* of : {"o", "i"}) {
      const std::string d = of;
      turned[d + "x"] = c * row.at(d + "x") - s * row.at(d + "y");
      turned[d + "y"] = s * row.at(d + "x") + c * row.at(d + "y");
    }
    ExpectClose(Evaluated("misaligned_brdf", turned)["fr"], fr, 1e-9, "turned with its directions");
  }
}

TEST(ReflectionLaws, PointsHaveNoAperture) {
  const Named row = {{"alpha_x", 0.2}, {"alpha_y", 0.3}, {"theta_x", 0.1}, {"ox", 0.3},  {"oz", 1},
                     {"ix", -0.5},     {"iy", 0.1},      {"iz", 1},        {"eta", 1.2}, {"k", 3}};
  Named mean = Evaluated("aperture_ggx", row), at = Evaluated("brdf", row);
  for (const char* value : {"fr_mean", "flux_mean", "fr_centre"}) ExpectClose(mean[value], at["fr"], 1e-13, value);
  ExpectClose(mean["D_mean"], at["D"], 1e-13, "D");
  ExpectClose(mean["D_closed"], at["D"], 1e-13, "D");
}

// Conductors of no absorption and of index 1 reflect nothing; Schlick's is the tinted one of tint 1.
TEST(ReflectionLaws, FresnelLimits) {
  for (const double c : {0.001, 0.1, 0.5, 1.0}) {
    EXPECT_NEAR(Evaluated("fresnel", {{"cos", c}, {"eta", 1}, {"k", 0}})["F"], 0, 1e-30);
    EXPECT_NEAR(Evaluated("fresnel", {{"cos", 0}, {"eta", c}, {"k", c}})["F"], 1, 1e-15);
    ExpectClose(Evaluated("fresnel_f82", {{"cos", c}, {"f0", 0.3}, {"tint", 1}})["F"], 0.3 + 0.7 * std::pow(1 - c, 5),
                1e-14, "Schlick");
    for (const double tint : {0.0, 0.5, 2.0}) {
      const Named tinted = {{"cos", 1.0 / 7}, {"f0", c}, {"tint", tint}}, plain = With(tinted, {{"tint", 1}});
      EXPECT_NEAR(Evaluated("fresnel_f82", tinted)["F"], tint * Evaluated("fresnel_f82", plain)["F"], 1e-15);
      EXPECT_EQ(Evaluated("fresnel_f82", {{"cos", 1}, {"f0", c}, {"tint", tint}})["F"], c);
    }
    // A dielectric: Fresnel's equations as they are printed, by Snell's angle.
    const double n = 1.5, ct = std::sqrt(1 - (1 - c * c) / (n * n));
    const double rs = (c - n * ct) / (c + n * ct), rp = (n * c - ct) / (n * c + ct);
    ExpectClose(Evaluated("fresnel", {{"cos", c}, {"eta", n}, {"k", 0}})["F"], (rs * rs + rp * rp) / 2, 1e-13, "F");
  }
}

TEST(ReflectionLaws, SplineCurvesSumToOne) {
  const Quantity& quantity = *FindQuantity("fresnel_curve");
  for (const double c : {0.0, 0.1, 0.25, 0.4, 0.6, 0.99, 1.0}) {
    Named ones = {{"cos", c}};
    for (const InputColumn& column : quantity.inputs) ones.emplace(column.name, 1);
    Named f = Evaluated("fresnel_curve", ones);
    EXPECT_NEAR(f["F"], 1, 1e-15);
    EXPECT_NEAR(f["dF_dcos"], 0, 1e-13);
  }
}

// Facets that absorb nothing lose nothing, whatever their roughness; roughness 0 is Lambert's.
TEST(ReflectionLaws, OrenNayarKeepsEnergy) {
  for (const double roughness : {0.0, 0.3, 1.0}) {
    for (const double theta : {0.0, 0.8, 1.5}) {
      const Named viewer = With(Direction("o", theta, 0.3), {{"albedo", 1}, {"roughness", roughness}});
      const double albedo = CosineMean(
          60, [&](double t, double p) { return Evaluated("diffuse_eon", With(viewer, Direction("i", t, p)))["f"]; });
      EXPECT_NEAR(albedo, 1, 2e-3) << roughness << " " << theta;
    }
  }
  for (Named row : Rows("diffuse_eon", 6, 10)) {
    row["roughness"] = 0;
    ExpectClose(Evaluated("diffuse_eon", row)["f"], row["albedo"] / kPi, 1e-14, "Lambert");
  }
}

// A white body below a clear interface returns all that is not reflected: F + (1 - F) = 1.
TEST(ReflectionLaws, InterfacedKeepsEnergy) {
  for (const double ior : {1.0, 1.0001, 1.5, 3.0}) {
    for (const double cos_o : {0.05, 0.5, 1.0}) {
      double out = 0;
      constexpr int kSteps = 1000;
      for (int i = 0; i < kSteps; ++i) {
        const double c = (i + 0.5) / kSteps;
        const Named row = {{"cos_i", c}, {"cos_o", cos_o}, {"ior", ior}, {"albedo", 1}};
        out += 2 * kPi * c * Evaluated("diffuse_interfaced", row)["f"] / kSteps;
      }
      const Named row = {{"cos_i", 1}, {"cos_o", cos_o}, {"ior", ior}, {"albedo", 1}};
      EXPECT_NEAR(out + Evaluated("diffuse_interfaced", row)["F_o"], 1, 1e-4) << ior << " " << cos_o;
    }
  }
}

// Without a step of the index and without absorption a coat is not there.
TEST(ReflectionLaws, AClearCoatOfIndexOneIsNothing) {
  for (Named row : Rows("coat_brdf", 7, 20)) {
    row["ior"] = 1, row["tau"] = 0;
    Named f = Evaluated("coat_brdf", row);
    EXPECT_NEAR(f["coat_lobe"], 0, 1e-25);
    ExpectClose(f["f_refracted"], f["base_unrefracted"], 1e-12, "refracted");
    ExpectClose(f["f_layered"], f["base_unrefracted"], 1e-12, "layered");
    EXPECT_DOUBLE_EQ(f["T_o"], 1);
    row["tau"] = 2;
    EXPECT_LT(Evaluated("coat_brdf", row)["f_layered"], std::exp(-2.0) * f["f_layered"]);
  }
}

// W over the sphere is 1 where the masking is not cut, and the mean surface's share where it is; what a tilted lobe
// sends below the horizon is missing above it.
TEST(ReflectionLaws, WhiteFurnace) {
  for (const double tilt : {0.0, 0.5}) {
    const Named row = With(Direction("o", 1.2, 0.4), {{"alpha_x", 0.3}, {"alpha_y", 0.2}, {"theta_y", tilt}});
    Named w = Evaluated("white_furnace", row), seen = Evaluated("ellipsoid_G1", Renamed(row, "o", "u"));
    EXPECT_DOUBLE_EQ(w["W_sphere"], std::fmin(1, seen["sigma"] / std::cos(1.2)));
    EXPECT_LT(w["W_hemi"], w["W_sphere"]);
    EXPECT_EQ(std::isnan(w["albedo_F1"]), tilt != 0);
    EXPECT_TRUE(tilt != 0 || w["albedo_F1"] < w["W_hemi"]);  // shadowing takes more
  }
}

}  // namespace
}  // namespace lobefit

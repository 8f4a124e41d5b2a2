// Squared ellipsoidal lobes by brute force, integrals over triangles of slopes by parts of them, radii by their
// distribution function, gains and residuals by what they minimise.
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
using test::Rows;
using test::With;

TEST(LobeLaws, IntegralOfTheLobeByBruteForce) {
  for (const auto& [ax, ay] : {std::pair{0.3, 0.6}, std::pair{1.0, 1.0}, std::pair{0.8, 0.25}}) {
    const Named lobe = {{"alpha_x", ax}, {"alpha_y", ay}, {"rot_x", 0.4}, {"rot_z", -1}};
    double sum = 0;
    constexpr int kSide = 60;
    for (int a = 0; a < kSide; ++a) {
      for (int b = 0; b < 2 * kSide; ++b) {
        const double z = -1 + 2 * (a + 0.5) / kSide, r = std::sqrt(1 - z * z), phi = kPi * (b + 0.5) / kSide;
        sum += Evaluated("sel", With(lobe, {{"wx", r * std::cos(phi)}, {"wy", r * std::sin(phi)}, {"wz", z}}))["K"];
      }
    }
    const double integral = Evaluated("sel_integral", lobe)["integral"];
    EXPECT_NEAR(sum * 4 * kPi / (2 * kSide * kSide), integral, 2e-3 * integral) << ax << " " << ay;
    const Named other = {{"alpha_x", ay}, {"alpha_y", ax}};
    ExpectClose(Evaluated("sel_integral", other)["integral"], integral, 1e-13, "axes swapped");
  }
}

TEST(LobeLaws, SpheroidsAreEllipsoidsOfEqualAxes) {
  for (const Named& row : Rows("ssl", 1, 30)) {
    const double alpha = row.at("alpha"), theta = row.at("theta");
    const Named sel = {{"alpha_x", alpha}, {"alpha_y", alpha}, {"wx", std::sin(theta)}, {"wz", std::cos(theta)}};
    Named lobe = Evaluated("sel", sel);
    ExpectClose(Evaluated("ssl", row)["K"], lobe["K"], 1e-12, "K");
    EXPECT_TRUE(std::isnan(lobe["dK_dalpha_x"]) && std::isnan(lobe["dK_dalpha_y"]));
  }
  // The frame is turned, not bent; the lobe is 1 on its axis and depends on the turned direction alone.
  for (const Named& row : Rows("sel", 2, 30)) {
    Named lobe = Evaluated("sel", row);
    EXPECT_NEAR(std::hypot(lobe["vx"], lobe["vy"], lobe["vz"]), 1, 1e-15);
    // Rodrigues: w cos t + (r x w) sin t + r (r.w) (1 - cos t), r the axis.
    const Vec3 rotation = {row.at("rot_x"), row.at("rot_y"), row.at("rot_z")};
    const Vec3 w = Normalized(Vec3{row.at("wx"), row.at("wy"), row.at("wz")}), axis = Normalized(rotation);
    const double turn = Norm(rotation);
    const Vec3 v = std::cos(turn) * w + std::sin(turn) * Cross(axis, w) + (1 - std::cos(turn)) * Dot(axis, w) * axis;
    EXPECT_NEAR(Norm(v - Vec3{lobe["vx"], lobe["vy"], lobe["vz"]}), 0, 1e-14);
    const Named straight = {{"alpha_x", row.at("alpha_x")},
                            {"alpha_y", row.at("alpha_y")},
                            {"wx", lobe["vx"]},
                            {"wy", lobe["vy"]},
                            {"wz", lobe["vz"]}};
    ExpectClose(Evaluated("sel", straight)["K"], lobe["K"], 1e-11, "K");
    EXPECT_EQ(Evaluated("sel", With(straight, {{"wx", 0}, {"wy", 0}, {"wz", 1}}))["K"], 1);
  }
}

TEST(LobeLaws, TrianglesAddUp) {
  for (const Named& row : Rows("triangle_ggx", 3, 60)) {
    const auto inner = [&](const char* axis) {
      const std::string a = axis;
      return 0.2 * row.at("p0" + a) + 0.3 * row.at("p1" + a) + 0.5 * row.at("p2" + a);
    };
    double parts = 0;
    for (const char* corner : {"p0", "p1", "p2"}) {
      const std::string c = corner;
      parts += Evaluated("triangle_ggx", With(row, {{c + "x", inner("x")}, {c + "y", inner("y")}}))["integral"];
    }
    const double whole = Evaluated("triangle_ggx", row)["integral"];
    EXPECT_NEAR(parts, whole, 1e-13) << row.at("p0x");
    const Named flipped =
        With(row, {{"p1x", row.at("p2x")}, {"p1y", row.at("p2y")}, {"p2x", row.at("p1x")}, {"p2y", row.at("p1y")}});
    EXPECT_NEAR(Evaluated("triangle_ggx", flipped)["integral"], whole, 1e-15);
    EXPECT_TRUE(whole >= 0 && whole <= 1);
  }
  // All slopes; and half of them.
  const Named all = {{"alpha_x", 0.3}, {"alpha_y", 0.01}, {"p0x", -1e6}, {"p0y", -1e6}, {"p1x", 3e6}, {"p2y", 3e6}};
  EXPECT_NEAR(Evaluated("triangle_ggx", all)["integral"], 1, 1e-9);
  const Named half = With(all, {{"p0x", 0}, {"p0y", -1e7}, {"p1x", 1e7}, {"p1y", 0}, {"p2x", 0}, {"p2y", 1e7}});
  EXPECT_NEAR(Evaluated("triangle_ggx", half)["integral"], 0.5, 1e-7);
}

// V is the share of the mass between the radii that the radius leaves inside.
TEST(LobeLaws, RadiiFollowTheirDistribution) {
  for (const Named& row : Rows("truncated_radius", 4, 60)) {
    Named drawn = Evaluated("truncated_radius", row);
    EXPECT_TRUE(drawn["s_r"] >= row.at("r_min") && drawn["s_r"] <= row.at("r_max"));
    const double below = Evaluated("truncated_radius", With(row, {{"r_max", drawn["s_r"]}}))["N_R"];
    EXPECT_NEAR(below, row.at("V") * drawn["N_R"], 1e-13 * drawn["N_R"]);
  }
  const Named disc = {{"alpha", 0.2}, {"r_max", 0.2}, {"V", 1}};
  EXPECT_DOUBLE_EQ(2 * kPi * Evaluated("truncated_radius", disc)["N_R"], 0.5);  // half of GGX lies within alpha
  EXPECT_DOUBLE_EQ(Evaluated("truncated_radius", disc)["s_r"], 0.2);
  EXPECT_EQ(Evaluated("truncated_radius", With(disc, {{"V", 0}}))["s_r"], 0);
}

// No other gain has a smaller cost, in either metric.
TEST(LobeLaws, GainsAreTheBest) {
  for (const Named& row : Rows("gain_profile", 5, 20)) {
    Named best = Evaluated("gain_profile", row);
    const auto cost = [&](double gain, bool linear) {
      const double prior = (linear ? gain - 1 : std::log(gain)) / row.at("s");
      double sum = prior * prior;
      for (int k = 0; k < 8; ++k) {
        const std::string n = std::to_string(k);
        const double f = gain * row.at("f" + n), y = row.at("y" + n), knee = row.at("knee");
        const double r =
            linear ? (f - y) / row.at("sd" + n) : (std::asinh(f / knee) - std::asinh(y / knee)) / row.at("rho");
        sum += r * r;
      }
      return sum;
    };
    ExpectClose(best["cost"], cost(best["g"], true), 1e-10, "linear");
    ExpectClose(best["cost_asinh"], cost(std::exp(best["ln_g"]), false), 1e-10, "asinh");
    for (const double factor : {0.5, 0.99, 1.01, 2.0}) {
      EXPECT_LE(best["cost"], cost(best["g"] * factor, true) * (1 + 1e-12));
      EXPECT_LE(best["cost_asinh"], cost(std::exp(best["ln_g"]) * factor, false) * (1 + 1e-12));
    }
  }
}

// A floor alone leaves the linear residual, a relative noise alone that of logarithms.
TEST(LobeLaws, ResidualsHaveTheirLimits) {
  Named floor = Evaluated("asinh_residual", {{"m", 0.3}, {"v", 0.2}, {"s0", 1e4}, {"rho", 0.01}});
  ExpectClose(floor["r"] / 0.01, (0.2 - 0.3) / 1e4, 1e-6, "linear");
  Named relative = Evaluated("asinh_residual", {{"m", 3}, {"v", 2}, {"s0", 1e-9}, {"rho", 0.01}});
  ExpectClose(relative["r"], std::log(2.0 / 3), 1e-9, "logarithm");
  for (const Named& row : Rows("asinh_residual", 6, 30)) {
    Named r = Evaluated("asinh_residual", row);
    EXPECT_EQ(r["r"] > 0, row.at("v") > row.at("m"));
    ExpectClose(r["sd"], std::hypot(row.at("s0"), row.at("rho") * row.at("v")), 1e-14, "sd");
    EXPECT_EQ(Evaluated("asinh_residual", With(row, {{"m", row.at("v")}}))["r"], 0);
  }
}

}  // namespace
}  // namespace lobefit

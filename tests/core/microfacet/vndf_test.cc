#include "lobefit/core/microfacet/vndf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/reference_table.h"
#include "tests/support/table_check.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

Ellipsoid RowEllipsoid(const ReferenceTable& table, std::size_t row) {
  return {table(row, "alpha_x"), table(row, "alpha_y"), table(row, "theta_x"), table(row, "theta_y"),
          table(row, "theta_z")};
}

// The tables' directions are unit to rounding and normalised exactly inside the reference.
Vec3 RowDirection(const ReferenceTable& table, std::size_t row, const std::string& name) {
  return Normalized(Vec3{table(row, name + "x"), table(row, name + "y"), table(row, name + "z")});
}

TEST(Vndf, PdfTable) {
  const ReferenceTable table("vndf_pdf");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Ellipsoid e = RowEllipsoid(table, row);
    const Vec3 psi = RowDirection(table, row, "psi"), m = RowDirection(table, row, "m");
    const double cond = table(row, "cond");
    double g[kEllipsoidParameters];
    const double pdf = EllipsoidVndfPdf(e, psi, m, g);
    ExpectTableValue(table, row, "pdf", pdf, cond);
    ExpectTableDerivatives(table, row,
                           {"dpdf_dalpha_x", "dpdf_dalpha_y", "dpdf_dtheta_x", "dpdf_dtheta_y", "dpdf_dtheta_z"},
                           {g[0], g[1], g[2], g[3], g[4]}, 1e-9 * std::fmax(1, cond));
    EXPECT_EQ(EllipsoidVndfPdf(e, psi, m), pdf);
  }
}

TEST(Vndf, MomentsTable) {
  const ReferenceTable table("vndf_moments");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Vec3 mean = EllipsoidMeanVisibleNormal(RowEllipsoid(table, row), RowDirection(table, row, "psi"));
    EXPECT_LT(Norm(mean - Vec3{table(row, "Em_x"), table(row, "Em_y"), table(row, "Em_z")}), 1e-9) << row;
  }
}

TEST(Vndf, SampleMeansMeetTheMomentsTable) {
  const ReferenceTable table("vndf_moments");
  constexpr int kSide = 400;  // stratified: the error of the mean is far below 1 / sqrt(samples)
  for (std::size_t row = 0; row < table.size(); row += 2) {
    const EllipsoidVndfSampler sampler(RowEllipsoid(table, row), RowDirection(table, row, "psi"));
    Vec3 sum = {0, 0, 0};
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) sum = sum + sampler.Sample((i + 0.5) / kSide, (j + 0.5) / kSide);
    }
    const Vec3 mean = (1.0 / (kSide * kSide)) * sum;
    EXPECT_LT(Norm(mean - Vec3{table(row, "Em_x"), table(row, "Em_y"), table(row, "Em_z")}), 2e-5) << row;
  }
}

TEST(Vndf, PdfGradientEqualsJets) {
  using Jet = ceres::Jet<double, 11>;
  std::mt19937_64 random(61);
  std::uniform_real_distribution<double> unit(0, 1);
  int seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const Ellipsoid e = {0.05 + unit(random), 0.05 + unit(random), unit(random) - 0.5, unit(random) - 0.5,
                         6 * unit(random)};
    const Vec3 psi = FromSpherical(1.5 * unit(random), 6 * unit(random));
    const Vec3 m = EllipsoidVndfSampler(e, psi).Sample(unit(random), unit(random));
    const Jet p[5] = {Jet(e.alpha_x, 0), Jet(e.alpha_y, 1), Jet(e.theta_x, 2), Jet(e.theta_y, 3), Jet(e.theta_z, 4)};
    const Vec3T<Jet> jpsi = {Jet(psi.x, 5), Jet(psi.y, 6), Jet(psi.z, 7)},
                     jm = {Jet(m.x, 8), Jet(m.y, 9), Jet(m.z, 10)};
    const Jet jet = EllipsoidDFormula(p, jm) * Dot(jm, jpsi) / EllipsoidSigmaFormula(p, jpsi);
    if (m.z < 1e-3 || jet.a < 1e-6) continue;
    ++seen;
    double g[5];
    Vec3 dpsi, dm;
    EXPECT_NEAR(EllipsoidVndfPdf(e, psi, m, g, &dpsi, &dm), jet.a, 1e-12 * jet.a);
    const double values[11] = {g[0], g[1], g[2], g[3], g[4], dpsi.x, dpsi.y, dpsi.z, dm.x, dm.y, dm.z};
    for (int k = 0; k < 11; ++k) EXPECT_NEAR(values[k], jet.v[k], 1e-10 * jet.v.norm()) << k;
  }
  EXPECT_GT(seen, 500);
}

TEST(Vndf, MeanGradientByDifferences) {
  const Vec3 psi = FromSpherical(1.1, 0.7);
  const Ellipsoid e = {0.4, 0.25, 0.3, -0.2, 0.9};
  std::array<Vec3, kEllipsoidParameters> gradient;
  const Vec3 mean = EllipsoidMeanVisibleNormal(e, psi, &gradient);
  EXPECT_LT(Norm(mean - EllipsoidMeanVisibleNormal(e, psi)), 1e-12);
  for (int i = 0; i < kEllipsoidParameters; ++i) {
    Ellipsoid up = e, down = e;
    double Ellipsoid::*const member[] = {&Ellipsoid::alpha_x, &Ellipsoid::alpha_y, &Ellipsoid::theta_x,
                                         &Ellipsoid::theta_y, &Ellipsoid::theta_z};
    const double h = 1e-4;
    up.*member[i] += h;
    down.*member[i] -= h;
    const Vec3 difference = (0.5 / h) * (EllipsoidMeanVisibleNormal(up, psi) - EllipsoidMeanVisibleNormal(down, psi));
    EXPECT_LT(Norm(difference - gradient[i]), 1e-6) << i;
  }
}

// The density integrates to 1 for every parameter: E[d log pdf / dparameter] = 0.
TEST(Vndf, NormalisationHasNoDerivative) {
  const Vec3 psi = FromSpherical(1.1, 0.7);
  const Ellipsoid e = {0.4, 0.25, 0.3, -0.2, 0.9};
  const EllipsoidVndfSampler sampler(e, psi);
  constexpr int kSide = 600;
  std::array<double, kEllipsoidParameters> sum{}, absolute{};
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      double g[kEllipsoidParameters];
      const double pdf = EllipsoidVndfPdf(e, psi, sampler.Sample((i + 0.5) / kSide, (j + 0.5) / kSide), g);
      for (int k = 0; k < kEllipsoidParameters; ++k) {
        sum[k] += g[k] / pdf;
        absolute[k] += std::fabs(g[k] / pdf);
      }
    }
  }
  for (int k = 0; k < kEllipsoidParameters; ++k) EXPECT_NEAR(sum[k], 0, 1e-4 * absolute[k]) << k;
}

struct Configuration {
  Ellipsoid ellipsoid;
  double theta, phi;  // of psi
};

std::vector<Configuration> Configurations() {
  return {{{0.5, 0.5, 0, 0, 0}, 0, 0},          // everything along n
          {{0.3, 0.6, 0, 0, 0.4}, 0.5, 1},      // no tilt
          {{1, 1, 0.3, 0.2, 0}, 1.2, 2},        // the sphere
          {{0.2, 0.4, 0.4, -0.3, 1}, 0.9, -2},  // leaning towards and away
          {{0.2, 0.4, 0.4, -0.3, 1}, 0.9, 1.1},
          {{0.15, 0.3, -0.6, 0.5, 2}, 1.45, 0.3},    // grazing
          {{0.3, 0.3, 1.2, 0.1, 0}, 0.7, -1.6},      // tilted by 70 degrees
          {{0.3, 0.3, 1.2, 0.1, 0}, 0.7, 1.6},       // mean normal behind: cos < 0
          {{0.01, 0.02, 0.2, 0.1, 0.5}, 0.8, 0},     // narrow
          {{1e-4, 1e-3, 0.3, -0.2, 0.7}, 1.0, 2.5},  // very narrow
          {{0.7, 0.05, 0, 0.3, -1}, 1.3, -0.4},      // strongly anisotropic
          {{1, 0.1, 0.2, 0, 0.3}, 0.4, 0.9},
          {{0.25, 0.5, 0.1, 0.1, 0.1}, 1.5707, 0.2},  // 1e-4 above the horizon
          {{0.4, 0.8, -1.3, 0.2, 0}, 1.2, 1.0}};
}

// Bins of equal solid angle on the sphere x = S^-1 R m / |.|, in which every ellipsoid is round: kZ heights by kPhi
// azimuths. What a bin expects is the midpoint sum of pdf(m(x)) dm/dx, dm/dx = alpha_x alpha_y / |A^T x|^3, not the
// sampler's own geometry.
constexpr int kZ = 8, kPhi = 12;

std::vector<double> ExpectedShares(const Ellipsoid& e, const Vec3& psi) {
  constexpr int kCells = 40;
  std::vector<double> share(kZ * kPhi, 0.0);
  const Mat3 back = Transposed(EllipsoidRotation(e));
  const double cell = 4 * kPi / (kZ * kPhi * kCells * kCells);
  for (int i = 0; i < kZ * kCells; ++i) {
    const double z = -1 + 2 * (i + 0.5) / (kZ * kCells), r = std::sqrt(1 - z * z);
    for (int j = 0; j < kPhi * kCells; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / (kPhi * kCells);
      const Vec3 v = back * Vec3{e.alpha_x * r * std::cos(phi), e.alpha_y * r * std::sin(phi), z};
      const double length = Norm(v);
      share[(i / kCells) * kPhi + j / kCells] +=
          cell * e.alpha_x * e.alpha_y / (length * length * length) * EllipsoidVndfPdf(e, psi, (1 / length) * v);
    }
  }
  return share;
}

int BinOf(const Ellipsoid& e, const Vec3& m) {
  const Vec3 v = EllipsoidRotation(e) * m;
  const Vec3 x = Normalized(Vec3{v.x / e.alpha_x, v.y / e.alpha_y, v.z});
  const double phi = std::atan2(x.y, x.x);
  const int i = std::clamp(static_cast<int>((x.z + 1) / 2 * kZ), 0, kZ - 1);
  const int j = std::clamp(static_cast<int>((phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi) * kPhi), 0, kPhi - 1);
  return i * kPhi + j;
}

template <class Draw>
double PValue(const Configuration& c, int samples, const Draw& draw) {
  const Vec3 psi = FromSpherical(c.theta, c.phi);
  std::vector<double> expected = ExpectedShares(c.ellipsoid, psi);
  double total = 0;
  for (const double share : expected) total += share;
  EXPECT_NEAR(total, 1, 2e-3);  // the density is normalised
  for (double& share : expected) share *= samples / total;
  std::vector<double> counts(expected.size(), 0.0);
  const EllipsoidVndfSampler sampler(c.ellipsoid, psi);
  int stray = 0;
  for (int i = 0; i < samples; ++i) {
    const Vec3 m = draw(sampler);
    EXPECT_NEAR(Norm(m), 1, 1e-14);
    EXPECT_GE(m.z, 0);
    EXPECT_GT(Dot(m, psi), -1e-12);
    const int bin = BinOf(c.ellipsoid, m);
    // A bin that the midpoints see just outside the lune, and a sample on its rim.
    if (expected[bin] <= 0) {
      ++stray;
      continue;
    }
    counts[bin] += 1;
  }
  EXPECT_LE(stray, samples / 5000);
  return ChiSquarePValue(counts, expected);
}

TEST(Vndf, ChiSquareOfVersion3) {
  const std::vector<Configuration> configurations = Configurations();
  const double threshold = SidakThreshold(0.01, static_cast<int>(configurations.size()));
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    std::mt19937_64 random(700 + i);
    std::uniform_real_distribution<double> unit(0, 1);
    const double p = PValue(configurations[i], 100000, [&](const EllipsoidVndfSampler& sampler) {
      const double u = unit(random);
      return sampler.Sample(u, unit(random));
    });
    EXPECT_GT(p, threshold) << i;
  }
}

TEST(Vndf, ChiSquareOfVersions1And2) {
  const std::vector<Configuration> configurations = Configurations();
  const std::vector<std::size_t> rough = {0, 1, 2, 3, 4, 6, 13};
  const double threshold = SidakThreshold(0.01, static_cast<int>(configurations.size() + rough.size()));
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    std::mt19937_64 random(800 + i);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    EXPECT_GT(
        PValue(configurations[i], 30000, [&](const EllipsoidVndfSampler& s) { return s.SampleByEllipsoid(uniform); }),
        threshold)
        << i;
  }
  for (const std::size_t i : rough) {
    std::mt19937_64 random(900 + i);
    const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    EXPECT_GT(
        PValue(configurations[i], 30000, [&](const EllipsoidVndfSampler& s) { return s.SampleBySphere(uniform); }),
        threshold)
        << i;
  }
}

TEST(Vndf, RejectionRates) {
  // Version 2 draws 2 / (1 + cos) times on average, version 1 more often by the ratio of the two discs.
  const Ellipsoid e = {0.5, 0.7, 0.4, -0.2, 0.3};
  const Vec3 psi = FromSpherical(1.2, 0.5);
  const EllipsoidVndfSampler sampler(e, psi);
  std::mt19937_64 random(62);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  double by_ellipsoid = 0, by_sphere = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    int tries = 0;
    sampler.SampleByEllipsoid(uniform, &tries);
    by_ellipsoid += tries;
    sampler.SampleBySphere(uniform, &tries);
    by_sphere += tries;
  }
  const Mat3 r = EllipsoidRotation(e);
  const auto length = [&](const Vec3& w) {
    const Vec3 v = r * w;
    return Norm(Vec3{e.alpha_x * v.x, e.alpha_y * v.y, v.z});
  };
  const Vec3 n = {0, 0, 1};
  // sigma = |A psi| (1 + cos) / (2 |A n|)
  const double share = EllipsoidSigma(e, psi) * length(n) / length(psi);
  EXPECT_NEAR(by_ellipsoid / kSamples, 1 / share, 0.05);
  // Area of the visible lune across psi, pi |A psi| (1 + cos) / (2 |A|), against the bounding disc pi / min(alpha)^2.
  EXPECT_NEAR(by_sphere / kSamples, e.alpha_x * e.alpha_y / (share * length(psi) * 0.5 * 0.5), 0.2);
}

TEST(Vndf, WeightsNeverAboveOneAndEqualToTheRatio) {
  std::mt19937_64 random(63);
  std::uniform_real_distribution<double> unit(0, 1);
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double tilt = i % 3 == 0 ? 0 : 1.35;
    const Ellipsoid e = {std::pow(10.0, -4 * unit(random)), i % 5 == 0 ? 1.0 : std::pow(10.0, -4 * unit(random)),
                         tilt * (2 * unit(random) - 1), tilt * (2 * unit(random) - 1), 6 * unit(random)};
    const double theta = i % 7 == 0 ? kPi / 2 - 1e-6 : 1.57 * unit(random);
    const Vec3 psi = FromSpherical(theta, 6 * unit(random));
    const EllipsoidVndfSampler sampler(e, psi);
    for (int k = 0; k < 20; ++k) {
      const Vec3 m = sampler.Sample(unit(random), unit(random));
      ASSERT_TRUE(std::isfinite(m.x + m.y + m.z));
      EXPECT_GE(Dot(m, psi), -1e-15);
      const Vec3 omega = Normalized(Reflect(psi, m));
      const double weight = EllipsoidReflectionWeight(e, psi, omega);
      largest = std::fmax(largest, weight);
      EXPECT_LE(weight, 1 + 1e-15);
      EXPECT_GE(weight, 0);
      if (omega.z <= 1e-6 || psi.z <= 1e-5 || Dot(m, psi) < 1e-3 || m.z < 1e-3) continue;
      // f_r cos / pdf with Fresnel 1
      const double brdf =
          EllipsoidD(e, HalfVector(psi, omega)) * EllipsoidG1(e, psi) * EllipsoidG1(e, omega) / (4 * psi.z * omega.z);
      EXPECT_NEAR(brdf * omega.z / EllipsoidReflectionPdf(e, psi, omega), weight, 1e-9);
      const double cos_d = Dot(HalfVector(psi, omega), psi);
      EXPECT_NEAR(EllipsoidReflectionPdf(e, psi, omega) * 4 * cos_d / EllipsoidVndfPdf(e, psi, HalfVector(psi, omega)),
                  1, 1e-12);
    }
  }
  EXPECT_GT(largest, 0.9);
  EXPECT_EQ(EllipsoidReflectionWeight({0.3, 0.3, 0, 0, 0}, {0, 0, 1}, FromSpherical(1.6, 0)), 0);
}

TEST(Vndf, RimOfTheSquareIsFinite) {
  for (const Configuration& c : Configurations()) {
    const EllipsoidVndfSampler sampler(c.ellipsoid, FromSpherical(c.theta, c.phi));
    for (const double u1 : {0.0, 1e-300, 0.5, 1 - 1e-16, 1.0}) {
      for (const double u2 : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Vec3 m = sampler.Sample(u1, u2);
        EXPECT_TRUE(std::isfinite(m.x + m.y + m.z)) << u1 << " " << u2;
        EXPECT_GE(m.z, 0);
      }
    }
  }
}

}  // namespace
}  // namespace lobefit

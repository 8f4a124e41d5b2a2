#include "lobefit/core/axial/cross_section.h"

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/reference_table.h"
#include "tests/support/table_check.h"
#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// Cosines: uniform, next to the poles, next to the equator.
double RandomCosine(std::mt19937_64* random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double kind = unit(*random), sign = unit(*random) < 0.5 ? -1 : 1;
  if (kind < 0.6) return sign * unit(*random);
  const double small = std::pow(10.0, -1 - 8 * unit(*random));
  return kind < 0.8 ? sign * (1 - small) : sign * small;
}

TEST(CrossSection, RingTable) {
  const ReferenceTable table("sigma_ring");
  for (std::size_t row = 0; row < table.size(); ++row) {
    double du = 0, dun = 0;
    const double u = table(row, "u"), u_n = table(row, "un");
    const double sigma = RingCrossSection(u, u_n, &du, &dun);
    EXPECT_NEAR(sigma, table(row, "sigma"), 1e-12 * table(row, "sigma")) << row;
    EXPECT_NEAR(2 * kPi * sigma, table(row, "sigma_printed"), 1e-12 * table(row, "sigma_printed"));
    ExpectTableDerivatives(table, row, {"dsigma_du", "dsigma_dun"}, {du, dun}, 1e-12);
    EXPECT_EQ(RingCrossSection(u, u_n), sigma);
  }
}

TEST(CrossSection, BeckmannGgxKagiwadaKalabaTables) {
  struct Family {
    const char *name, *parameter;
    double (*sigma)(double, double, double*, double*);
  };
  for (const Family& family :
       {Family{"sigma_beckmann", "alpha", BeckmannCrossSection}, Family{"sigma_ggx", "alpha", GgxCrossSection},
        Family{"sigma_kk", "b", KagiwadaKalabaCrossSection}}) {
    SCOPED_TRACE(family.name);
    const ReferenceTable table(family.name);
    for (std::size_t row = 0; row < table.size(); ++row) {
      double dp = 0, du = 0;
      const double parameter = table(row, family.parameter), u = table(row, "u"), cond = table(row, "cond");
      const double sigma = family.sigma(parameter, u, &dp, &du);
      EXPECT_EQ(family.sigma(parameter, u, nullptr, nullptr), sigma);
      ExpectTableValue(table, row, "sigma", sigma, cond);
      if (table.Has("sigma_printed")) ExpectTableValue(table, row, "sigma_printed", 2 * kPi * sigma, cond);
      ExpectTableDerivatives(table, row, {std::string("dsigma_d") + family.parameter, "dsigma_du"}, {dp, du},
                             1e-9 * std::fmax(1, cond));
    }
  }
}

TEST(CrossSection, GradientsEqualJets) {
  using Jet = ceres::Jet<double, 2>;
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto check = [](double value, double dp, double du, const Jet& jet) {
    EXPECT_NEAR(value, jet.a, 1e-13 * std::fabs(jet.a) + 2e-16);
    EXPECT_NEAR(dp, jet.v[0], 1e-10 * jet.v.norm());
    EXPECT_NEAR(du, jet.v[1], 1e-10 * jet.v.norm());
  };
  for (int i = 0; i < 2000; ++i) {
    // Inside the domain in which the definitions do not cancel themselves.
    const double u = 1.98 * unit(random) - 0.99, p = 0.05 + 0.9 * unit(random), u_n = 1.98 * unit(random) - 0.99;
    double dp = 0, du = 0;
    if (u > -0.5 * p) {
      const double beckmann = BeckmannCrossSection(p, u, &dp, &du);
      check(beckmann, dp, du, BeckmannCrossSectionFormula(Jet(p, 0), Jet(u, 1)));
    }
    const double ggx = GgxCrossSection(p, u, &dp, &du);
    if (u > -p) check(ggx, dp, du, GgxCrossSectionFormula(Jet(p, 0), Jet(u, 1)));
    if (p > 0.3 && (u > 0 || p < 0.7)) {
      const double kk = KagiwadaKalabaCrossSection(p, u, &dp, &du);
      check(kk, dp, du, KagiwadaKalabaCrossSectionFormula(Jet(p, 0), Jet(u, 1)));
    }
    if (std::fabs(1 - u * u - u_n * u_n) > 0.05) {
      double dun = 0;
      const double ring = RingCrossSection(u, u_n, &du, &dun);
      const Jet jet = RingCrossSectionFormula(Jet(u, 0), Jet(u_n, 1));
      EXPECT_NEAR(ring, jet.a, 1e-13);
      EXPECT_NEAR(du, jet.v[0], 1e-10 * jet.v.norm());
      EXPECT_NEAR(dun, jet.v[1], 1e-10 * jet.v.norm());
    }
  }
}

TEST(CrossSection, RingIsSymmetricAndNormalised) {
  std::mt19937_64 random(32);
  for (int i = 0; i < 5000; ++i) {
    const double u = RandomCosine(&random), u_n = RandomCosine(&random);
    double du = 0, dun = 0, du_swapped = 0, dun_swapped = 0;
    const double sigma = RingCrossSection(u, u_n, &du, &dun);
    EXPECT_NEAR(RingCrossSection(u_n, u, &dun_swapped, &du_swapped), sigma, 4 * kEps * sigma);  // eq 13
    EXPECT_NEAR(du, du_swapped, 1e-14);
    EXPECT_NEAR(dun, dun_swapped, 1e-14);
    EXPECT_GE(sigma, 0);
    // Front minus back is the signed projection; convexity bounds the rest.
    EXPECT_NEAR(sigma - RingCrossSection(-u, u_n), u * u_n, 4 * kEps);
    EXPECT_GE(sigma, u * u_n * (1 - 2 * kEps));
    const RingParts parts = RingCrossSectionParts(u, u_n);
    EXPECT_NEAR(parts.sigma1 + parts.sigma2 + parts.sigma3, 2 * kPi * sigma, 1e-14);  // eq 9
  }
  for (const double u_n : {-0.9, 0.0, 0.3, 0.999}) {
    const double band = std::sqrt(1 - u_n * u_n);
    const QuadratureResult<1> integral = IntegrateAdaptive<1>(
        [&](double u) { return std::array<double, 1>{2 * kPi * RingCrossSection(u, u_n)}; }, {-1, -band, band, 1});
    EXPECT_NEAR(integral.value[0], kPi, 1e-10);  // eq 14
  }
}

TEST(CrossSection, FlatSurfaceIsTheRingAtThePole) {
  for (const double u : {-0.7, -1e-9, 0.0, 1e-9, 0.3, 1.0}) EXPECT_EQ(RingCrossSection(u, 1), std::fmax(0.0, u));
}

TEST(CrossSection, EveryFamilyAgainstTheRingIntegral) {
  // Eq 15 with the distribution itself: neither the closed forms nor their stable versions enter on this side.
  const auto compare = [](const char* name, double p, double u, double sigma, double dp, double du,
                          const auto& distribution) {
    SCOPED_TRACE(testing::Message() << name << " " << p << " at " << u);
    const QuadratureResult<3> result = AxialCrossSection<2>(distribution, u, {1e-11, 1e-15, 1000});
    EXPECT_NEAR(result.value[0], sigma, 1e-9 * sigma + 1e-14);
    const double scale = std::fabs(dp) + std::fabs(du);
    EXPECT_NEAR(result.value[1], dp, 1e-8 * scale + 1e-13);
    EXPECT_NEAR(result.value[2], du, 1e-8 * scale + 1e-13);
  };
  for (const double u : {-0.9, -0.2, -0.01, 0.0, 0.05, 0.6, 0.99, 1.0}) {
    for (const double alpha : {0.001, 0.05, 0.4, 1.0, 3.0}) {
      double dp = 0, du = 0;
      double sigma = BeckmannCrossSection(alpha, u, &dp, &du);
      compare("Beckmann", alpha, u, sigma, dp, du, [&](double u_n, double d) {
        if (u_n <= 1e-9) return std::array<double, 2>{0, 0};
        const double tan2 = d * (2 - d) / (u_n * u_n), t = tan2 / (alpha * alpha);
        const double value = std::exp(-t) / (kPi * alpha * alpha * std::pow(u_n, 4));
        return std::array<double, 2>{value, value * (2 * t - 2) / alpha};
      });
      sigma = GgxCrossSection(alpha, u, &dp, &du);
      compare("GGX", alpha, u, sigma, dp, du, [&](double u_n, double d) {
        if (u_n <= 0) return std::array<double, 2>{0, 0};
        const double den = alpha * alpha * u_n * u_n + d * (2 - d);
        const double value = alpha * alpha / (kPi * den * den);
        return std::array<double, 2>{value, value * (2 / alpha - 4 * alpha * u_n * u_n / den)};
      });
    }
    for (const double b : {1e-3, 0.2, 0.49, 0.51, 0.9, 0.9999}) {
      double dp = 0, du = 0;
      const double sigma = KagiwadaKalabaCrossSection(b, u, &dp, &du);
      compare("Kagiwada-Kalaba", b, u, sigma, dp, du, [&](double u_n, double d) {
        const double one = (1 - b) + b * d, l = std::atanh(b);
        const double value = b / (4 * kPi * one * l);
        return std::array<double, 2>{value, value * (1 / b + u_n / one - 1 / ((1 - b) * (1 + b) * l))};
      });
    }
  }
}

TEST(CrossSection, NarrowLobesSeeTheFlatSurface) {
  for (const double u : {-0.8, -0.1, 0.2, 0.9}) {
    EXPECT_NEAR(BeckmannCrossSection(1e-4, u), std::fmax(0.0, u), 1e-9);
    EXPECT_NEAR(GgxCrossSection(1e-4, u), std::fmax(0.0, u), 1e-7);
  }
  EXPECT_NEAR(KagiwadaKalabaCrossSection(1e-9, 0.3), 0.25, 1e-9);
}

TEST(CrossSection, LawsForHostileParameters) {
  std::mt19937_64 random(33);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 5000; ++i) {
    const double u = RandomCosine(&random), alpha = std::pow(10.0, -4 + 5 * unit(random));
    const double b =
        i % 2 == 0 ? std::pow(10.0, -6 * unit(random)) * 0.999 : 1 - std::pow(10.0, -8 * unit(random)) * 0.999;
    // sigma(u) - sigma(-u) is u times the signed projected area: 1 for surfaces, 1/b - 1/atanh(b) here.
    EXPECT_NEAR(BeckmannCrossSection(alpha, u) - BeckmannCrossSection(alpha, -u), u, 4 * kEps * (1 + alpha));
    EXPECT_NEAR(GgxCrossSection(alpha, u) - GgxCrossSection(alpha, -u), u, 4 * kEps * (1 + alpha));
    const double odd = b < 1e-2 ? b / 3 + 4 * b * b * b / 45 + 44 * std::pow(b, 5) / 945 : 1 / b - 1 / std::atanh(b);
    EXPECT_NEAR(KagiwadaKalabaCrossSection(b, u) - KagiwadaKalabaCrossSection(b, -u), u * odd, 1e-11 * b + 2 * kEps);
    for (const double sigma :
         {BeckmannCrossSection(alpha, u), GgxCrossSection(alpha, u), KagiwadaKalabaCrossSection(b, u)}) {
      EXPECT_TRUE(std::isfinite(sigma));
      EXPECT_GE(sigma, 0);
    }
    EXPECT_GE(GgxCrossSection(alpha, u), std::fmax(0.0, u) * (1 - kEps));
    EXPECT_GE(BeckmannCrossSection(alpha, u), std::fmax(0.0, u) * (1 - kEps));
  }
  // Mean over the sphere of directions: int sigma du = int D dm / 2 (a convex body's mean shadow), so 1/2 where int D
  // dm = 1.
  for (const double b : {0.01, 0.5, 0.97}) {
    EXPECT_NEAR(IntegrateAdaptive([&](double u) { return KagiwadaKalabaCrossSection(b, u); }, -1, 1), 0.5, 1e-12);
  }
  EXPECT_EQ(BeckmannCrossSection(0.3, 1), 1);
  EXPECT_EQ(BeckmannCrossSection(0.3, -1), 0);
  EXPECT_EQ(GgxCrossSection(0.3, 1), 1);
  EXPECT_EQ(GgxCrossSection(0.3, -1), 0);
}

TEST(CrossSection, KagiwadaKalabaEndpoints) {
  // MATH.md section 2, [dEon] 27: sigma(1) = (-b - ln(1-b)) / (2 b atanh b), sigma(-1) = (b - ln(1+b)) / (2 b atanh b),
  // sphere convention.
  for (const double b : {0.05, 0.4, 0.6, 0.99}) {
    const double scale = 2 * b * std::atanh(b);
    EXPECT_NEAR(KagiwadaKalabaCrossSection(b, 1), (-b - std::log1p(-b)) / scale, 1e-13);
    EXPECT_NEAR(KagiwadaKalabaCrossSection(b, -1), (b - std::log1p(b)) / scale, 1e-13);
  }
}

TEST(CrossSection, PolynomialsOfTable1) {
  std::mt19937_64 random(34);
  for (int i = 0; i < 200; ++i) {
    const double u = RandomCosine(&random), v = std::fabs(u), u2 = u * u;
    const auto expect = [&](int p, double s1, double s2, double s3) {
      const RingParts parts = MonomialCrossSectionParts(p, u);
      EXPECT_NEAR(parts.sigma1, s1, 4e-15);
      EXPECT_NEAR(parts.sigma2, s2, 4e-15);
      EXPECT_NEAR(parts.sigma3, s3, 8e-15) << p << " " << u;
    };
    expect(0, kPi * v, kPi * (1 - u2), kPi * (u2 - v));
    expect(1, 2 * kPi / 3 * u, 0, 0);
    expect(2, kPi / 2 * v, kPi / 4 * (u2 - 1) * (u2 - 1), -kPi / 4 * (2 * v + u2 * u2 - 3 * u2));
    expect(4, kPi / 3 * v, -kPi / 8 * std::pow(u2 - 1, 3),
           kPi / 24 * (3 * std::pow(u2, 3) - 10 * u2 * u2 + 15 * u2 - 8 * v));
    expect(7, 2 * kPi / 9 * u, 0, 0);
    EXPECT_NEAR(PolynomialCrossSection({0, 0, 0, 0, 1}, u), -kPi / 24 * (u2 * u2 - 6 * u2 - 3), 4e-15);
    EXPECT_NEAR(PolynomialCrossSection({0, 0, 1}, u), kPi / 4 * (u2 + 1), 4e-15);
  }
}

TEST(CrossSection, PolynomialGradientAndHighPowers) {
  const std::vector<double> coefficients = {0.3, -0.2, 1.1, 0.4, 0.05, -0.7, 0.9};
  for (const double u : {-1.0, -0.43, 0.0, 0.2, 0.8, 1.0}) {
    double du = 0;
    std::vector<double> dc;
    const double sigma = PolynomialCrossSection(coefficients, u, &du, &dc);
    EXPECT_EQ(PolynomialCrossSection(coefficients, u), sigma);
    double linear = 0;
    for (std::size_t p = 0; p < dc.size(); ++p) linear += coefficients[p] * dc[p];
    EXPECT_NEAR(linear, sigma, 1e-14);
    const QuadratureResult<2> ring = AxialCrossSection<1>(
        [&](double u_n, double) {
          double value = 0;
          for (std::size_t p = coefficients.size(); p-- > 0;) value = value * u_n + coefficients[p];
          return std::array<double, 1>{value};
        },
        u, {1e-12, 0, 1000});
    EXPECT_NEAR(ring.value[0], sigma, 1e-11);
    EXPECT_NEAR(ring.value[1], du, 1e-9);
    const QuadratureResult<2> high = AxialCrossSection<1>(
        [&](double u_n, double) { return std::array<double, 1>{std::pow(u_n, 40)}; }, u, {1e-12, 0, 1000});
    std::vector<double> power(41, 0.0);
    power[40] = 1;
    EXPECT_NEAR(PolynomialCrossSection(power, u, &du), high.value[0], 1e-12);
    EXPECT_NEAR(du, high.value[1], 1e-9);
  }
}

// The parts of the ring integrated against the rational rows of Table 1, lost absolute values restored.
TEST(CrossSection, RationalRowsOfTable1) {
  const auto part = [](const auto& d, double u, double RingParts::*which) {
    const double band = std::sqrt(1 - u * u);
    return IntegrateAdaptive<1>(
               [&](double t) { return std::array<double, 1>{d(t) * (RingCrossSectionParts(u, t).*which)}; },
               {-1, -band, 0, band, 1}, {1e-11, 0, 4000})
        .value[0];
  };
  for (const double u : {-0.8, -0.3, 0.2, 0.9}) {
    const double v = std::fabs(u);
    EXPECT_NEAR(part([](double t) { return 1 / (1 + t); }, u, &RingParts::sigma2), 2 * kPi * (1 - v), 1e-8);
    EXPECT_NEAR(part([](double t) { return 1 / (1 - t); }, u, &RingParts::sigma2), 2 * kPi * (1 - v), 1e-8);
    EXPECT_NEAR(part([](double t) { return 1 / ((1 - t) * (1 - t)); }, u, &RingParts::sigma2), 2 * kPi * (1 / v - 1),
                1e-8);
    EXPECT_NEAR(part([](double t) { return 1 / (1 + t * t); }, u, &RingParts::sigma1), kPi * v * std::log(2.0), 1e-8);
    EXPECT_NEAR(part([](double t) { return 1 / (1 + t * t); }, u, &RingParts::sigma2),
                2 * kPi * (std::sqrt(2 - u * u) - 1), 1e-8);
    // Eq 18 corrected: (-1)^(p/2) pi (u^2 - 1)^(p/2 + 1) / (p/2 + 1) |u|, at p = 4.
    const double band = std::sqrt(1 - u * u);
    const double theta =
        IntegrateAdaptive([&](double t) { return t * u > 0 ? -2 * kPi * t * u * std::pow(t, 4) : 0; }, -band, 0) +
        IntegrateAdaptive([&](double t) { return t * u > 0 ? -2 * kPi * t * u * std::pow(t, 4) : 0; }, 0, band);
    EXPECT_NEAR(theta, kPi * std::pow(u * u - 1, 3) / 3 * v, 1e-11);
  }
}

}  // namespace
}  // namespace lobefit

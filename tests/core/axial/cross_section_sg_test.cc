#include "lobefit/core/axial/cross_section_sg.h"

#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "tests/support/reference_table.h"
#include "tests/support/table_check.h"
#include <gtest/gtest.h>

#include "lobefit/core/axial/cross_section.h"
#include "lobefit/math/special.h"

namespace lobefit {
namespace {

using Form = double (*)(double, double, double*, double*);

double Exact(double alpha, double u, double* da, double* du) { return SgCrossSection(alpha, u, da, du); }
double Harmonics11(double alpha, double u, double* da, double* du) {
  return SgCrossSectionHarmonics(alpha, u, 11, da, du);
}
double Harmonics2(double alpha, double u, double* da, double* du) {
  return SgCrossSectionHarmonics(alpha, u, 2, da, du);
}
double Harmonics60(double alpha, double u, double* da, double* du) {
  return SgCrossSectionHarmonics(alpha, u, 60, da, du);
}

TEST(SgCrossSection, Table) {
  const ReferenceTable table("sigma_sg");
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double alpha = table(row, "alpha"), u = table(row, "u");
    double da = 0, du = 0;
    const double sigma = SgCrossSection(alpha, u, &da, &du);
    EXPECT_NEAR(sigma, table(row, "sigma"), 1e-14) << row;
    ExpectTableDerivatives(table, row, {"dsigma_dalpha", "dsigma_du"}, {da, du}, 1e-9);
    EXPECT_NEAR(SgCrossSectionOdd(alpha, u), table(row, "sigma_odd"), 1e-14) << row;
    EXPECT_NEAR(SgCrossSection2(alpha, u), table(row, "sigma_2"), 1e-14) << row;
    EXPECT_NEAR(SgCrossSectionEq40(alpha, u), table(row, "approx_eq40"), 1e-14) << row;
    EXPECT_NEAR(SgCrossSectionEq41(alpha, u), table(row, "approx_eq41"), 1e-14) << row;
    EXPECT_NEAR(SgCrossSectionHarmonics(alpha, u, 2), table(row, "approx_eq44"), 1e-14) << row;
    EXPECT_NEAR(SgCrossSectionHarmonics(alpha, u, 11), table(row, "sh_l_le_11"), 1e-14) << row;
  }
}

TEST(SgCrossSection, NarrowLobesAgainstHighPrecision) {
  // Eq 29 by quadrature with 40 digits (mpmath 1.3), derivatives by central differences.
  const std::array<std::array<double, 5>, 8> reference = {
      {{0.001, 0.0005, 5.998203760662175e-4, 2.1969516505929868e-1, 7.6024946953022287e-1},
       {0.001, -0.0005, 9.9820626066217486e-5, 2.1969566505929868e-1, 2.3975003046977713e-1},
       {0.001, -0.003, 1.677488364394027e-9, 3.4812728232675761e-5, 1.104509937229033e-5},
       {0.0001, 2e-05, 3.9330395456417249e-5, 2.7103369408207125e-1, 6.1135129107959446e-1},
       {0.0001, -0.0002, 4.8901134534304137e-8, 5.166746252902487e-3, 2.3388674659124292e-3},
       {0.01, 0.5, 4.99975e-1, -5.0000000000000001e-3, 9.9995e-1},
       {0.01, -0.03, 1.6746062368806812e-8, 3.475980338702628e-5, 1.1030339083559004e-5},
       {0.015, 0.999, 9.988876125e-1, -1.4984999999999999e-2, 9.998875e-1}}};
  for (const auto& [alpha, u, sigma, by_alpha, by_u] : reference) {
    double da = 0, du = 0;
    EXPECT_NEAR(SgCrossSection(alpha, u, &da, &du), sigma, 1e-14 * sigma) << alpha << " " << u;
    EXPECT_NEAR(da, by_alpha, 1e-13 * std::fabs(by_alpha));
    EXPECT_NEAR(du, by_u, 1e-13 * std::fabs(by_u));
  }
}

TEST(SgCrossSection, DerivativesByDifferences) {
  for (const Form form : {Exact, SgCrossSectionOdd, SgCrossSection2, SgCrossSectionEq40, SgCrossSectionEq41, Harmonics2,
                          Harmonics11, Harmonics60}) {
    for (const double alpha : {0.01, 0.05, 0.29, 0.31, 0.9, 4.0}) {
      for (const double t : {-2.0, -0.3, 0.01, 0.4, 1.5}) {
        const double u = std::fmax(-0.99, std::fmin(0.99, alpha * t));
        double da = 0, du = 0;
        const double sigma = form(alpha, u, &da, &du);
        EXPECT_EQ(form(alpha, u, nullptr, nullptr), sigma);
        const double h = 1e-5 * std::fmin(alpha, 1 - std::fabs(u));
        const auto at = [&](double a, double x) { return form(a, x, nullptr, nullptr); };
        EXPECT_NEAR((at(alpha + h, u) - at(alpha - h, u)) / (2 * h), da, 1e-7 + 1e-5 * std::fabs(da))
            << alpha << " " << u;
        EXPECT_NEAR((at(alpha, u + h) - at(alpha, u - h)) / (2 * h), du, 1e-7 + 1e-5 * std::fabs(du))
            << alpha << " " << u;
      }
    }
  }
}

TEST(SgCrossSection, BothExactMethodsAgree) {
  for (const double alpha : {0.05, 0.1, 0.2, 0.299}) {
    const int full = static_cast<int>(std::sqrt(160.0) / alpha) + 24;
    for (double u = -1; u <= 1; u += 0.0625) {
      double da = 0, du = 0, da_sum = 0, du_sum = 0;
      EXPECT_NEAR(SgCrossSection(alpha, u, &da, &du), SgCrossSectionHarmonics(alpha, u, full, &da_sum, &du_sum), 2e-15);
      // -4/alpha^3 turns a rounding of 7e-18 in dsigma/dk of the sum (alpha = 0.05) into 2.4e-13.
      EXPECT_NEAR(da, da_sum, 4e-13);
      EXPECT_NEAR(du, du_sum, 1e-12);
    }
  }
}

TEST(SgCrossSection, AgainstTheRingIntegral) {
  for (const double alpha : {0.002, 0.1, 0.29, 0.31, 1.0, 5.0}) {
    const double k = 2 / (alpha * alpha);
    for (const double u : {-0.7, -0.02, 0.0, 0.3, 0.95, 1.0}) {
      const QuadratureResult<2> ring = AxialCrossSection<1>(
          [&](double, double d) {
            return std::array<double, 1>{-k * std::exp(-k * d) / (2 * kPi * std::expm1(-2 * k))};
          },
          u, {1e-12, 1e-16, 2000});
      double du = 0;
      EXPECT_NEAR(SgCrossSection(alpha, u, nullptr, &du), ring.value[0], 1e-11) << alpha << " " << u;
      EXPECT_NEAR(du, ring.value[1], 1e-9);
    }
  }
}

TEST(SgCrossSection, Laws) {
  for (double alpha = 1e-4; alpha < 100; alpha *= 1.31) {
    const double k = 2 / (alpha * alpha);
    for (const double u : {1e-6, 0.01, 0.4, 0.99, 1.0}) {
      const double front = SgCrossSection(alpha, u), back = SgCrossSection(alpha, -u);
      EXPECT_NEAR(front - back, u * Langevin(k), 2e-15);
      EXPECT_NEAR(SgCrossSectionOdd(alpha, u), 0.5 * (front - back), 2e-15);
      EXPECT_GE(back, -1e-16);
      EXPECT_LE(front, 1);
      EXPECT_GE(front, u * SgCrossSection(alpha, 1) * (1 - 1e-13));  // so that G1 <= 1
    }
    // MATH.md section 2 with the labels of (30) and (32) put right: sigma(1), and (31): sigma(0) = csch(k) I1(k) / 2.
    if (k < 300) {
      EXPECT_NEAR(SgCrossSection(alpha, 1), (alpha * alpha - std::exp(k) * (alpha * alpha - 2)) / (4 * std::sinh(k)),
                  1e-12 * (1 + alpha * alpha));
    }
    EXPECT_NEAR(SgCrossSection(alpha, 0), -BesselIScaled(k).i1 / std::expm1(-2 * k), 2e-15);
  }
  // Mean shadow: int sigma du = 1/2 where int D dm = 1.
  for (const double alpha : {0.05, 0.5, 2.0}) {
    const double left = IntegrateAdaptive([&](double u) { return SgCrossSection(alpha, u); }, -1, 0);
    const double right = IntegrateAdaptive([&](double u) { return SgCrossSection(alpha, u); }, 0, 1);
    EXPECT_NEAR(left + right, 0.5, 1e-12);
  }
  EXPECT_NEAR(SgCrossSection(1000, 0.3), 0.25, 1e-6);
}

double MaximalError(const SgForm& form, double alpha) {
  double worst = 0;
  for (int i = 0; i <= 1200; ++i) {
    const double u = -1 + i / 600.0;
    worst = std::fmax(worst, std::fabs(SgCrossSection(form, alpha, u) - SgCrossSection(alpha, u)));
  }
  return worst;
}

TEST(SgForms, ErrorBoundsHoldAndAreTight) {
  for (const double alpha : {0.004, 0.01, 0.013, 0.044, 0.1, 0.17, 0.25, 0.3, 0.47, 0.8, 1.1, 1.6, 2.9}) {
    for (const SgForm::Kind kind : {SgForm::kBeckmann, SgForm::kEq40, SgForm::kEq41}) {
      const double bound = SgFormError({kind, 0}, alpha), error = MaximalError({kind, 0}, alpha);
      EXPECT_LE(error, bound) << kind << " " << alpha;
      EXPECT_LE(bound, 1.25 * error + 5e-15) << kind << " " << alpha;
    }
    for (const int l_max : {1, 2, 4, 7, 11, 22, 50}) {
      const SgForm form = {SgForm::kHarmonics, l_max};
      EXPECT_LE(MaximalError(form, alpha), SgFormError(form, alpha)) << l_max << " " << alpha;
    }
  }
  EXPECT_EQ(SgFormError({SgForm::kEq41, 0}, 3.01), std::numeric_limits<double>::infinity());
}

TEST(SgForms, ClaimsOfThePaperAsMeasured) {
  // MATH.md section 2: (22) 1e-3 to .0447, (40) 1e-3 to .254, (41) 1e-4 to .3024, (44) 1.03e-3 above 1.
  EXPECT_LT(MaximalError({SgForm::kBeckmann, 0}, 0.044), 1e-3);
  EXPECT_LT(MaximalError({SgForm::kEq40, 0}, 0.253), 1e-3);
  EXPECT_LT(MaximalError({SgForm::kEq41, 0}, 0.302), 1e-4);
  EXPECT_GT(MaximalError({SgForm::kEq41, 0}, 0.31), 1e-4);
  EXPECT_LT(MaximalError({SgForm::kHarmonics, 2}, 1.0), 1.04e-3);
  EXPECT_NEAR(MaximalError({SgForm::kHarmonics, 11}, 0.3), 4.4e-4, 1e-5);
}

TEST(SgForms, CheapestMeetsTheErrorAskedFor) {
  std::set<int> kinds;
  for (double alpha = 0.003; alpha < 20; alpha *= 1.7) {
    for (const double max_error : {1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-13, 1e-18}) {
      const SgForm form = CheapestSgForm(alpha, max_error);
      kinds.insert(form.kind);
      if (form.kind != SgForm::kExact) {
        EXPECT_LE(SgFormError(form, alpha), max_error);
      }
      EXPECT_LE(MaximalError(form, alpha), max_error) << alpha << " " << form.kind << " " << form.l_max;
    }
  }
  EXPECT_EQ(kinds.size(), 5U);  // every form is the best one somewhere
  EXPECT_EQ(CheapestSgForm(0.03, 1e-3).kind, SgForm::kBeckmann);
  EXPECT_EQ(CheapestSgForm(0.2, 1e-3).kind, SgForm::kEq40);
  EXPECT_EQ(CheapestSgForm(1.2, 2e-3).l_max, 2);
  EXPECT_EQ(CheapestSgForm(0.3, 1e-18).kind, SgForm::kExact);
  // However narrow: neither memory nor time grows with 1 / alpha.
  EXPECT_EQ(CheapestSgForm(1e-9, 1e-3).kind, SgForm::kBeckmann);
  EXPECT_NEAR(SgFormError({SgForm::kHarmonics, 2}, 1e-9), SgFormError({SgForm::kHarmonics, 2}, 0.002), 0.05);
  EXPECT_LE(MaximalError({SgForm::kHarmonics, 30}, 1e-9), SgFormError({SgForm::kHarmonics, 30}, 1e-9));
  EXPECT_NEAR(SgCrossSection(1e-9, 0.3), 0.3, 1e-15);
}

}  // namespace
}  // namespace lobefit

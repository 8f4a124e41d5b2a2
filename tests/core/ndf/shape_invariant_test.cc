#include "lobefit/core/ndf/shape_invariant.h"

#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"
#include "lobefit/core/ndf/smith.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

std::shared_ptr<const ShapeInvariantMasking> Masking(SlopeProfile profile) {
  return std::make_shared<const ShapeInvariantMasking>(std::move(profile));
}

// The tabulated Lambda of the two profiles that have a closed form, over the whole range of a, with its derivative.
TEST(ShapeInvariantMasking, ReproducesBeckmannAndGgx) {
  const ShapeInvariantMasking beckmann(BeckmannProfile()), ggx(GgxProfile());
  ShapeGenerator random(91);
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const double a = (i % 2 == 0 ? 1 : -1) * random.LogUniform(1e-3, i % 3 == 0 ? 1e6 : 10);
    for (const auto& [masking, kind] : {std::pair{&beckmann, SlopeKind::kBeckmann}, std::pair{&ggx, SlopeKind::kGgx}}) {
      double expected_derivative, derivative;
      const double Lambda = SmithLambdaOfA(kind, a, &expected_derivative);
      EXPECT_NEAR(masking->Lambda(a, &derivative), Lambda, 1e-12 * (1 + std::abs(1 / a))) << a;
      EXPECT_NEAR(derivative, expected_derivative, 1e-10 * (1 + std::abs(expected_derivative))) << a;
      // M(|a|) by the closed form for positive a, where it does not cancel.
      const double expected_sigma = std::abs(a) * SmithLambdaOfA(kind, std::abs(a)) + std::fmax(0, a);
      const double error = std::abs(masking->Sigma(a) - expected_sigma) / std::fmax(1, a);
      EXPECT_LE(error, 1e-12) << a;
      worst = std::fmax(worst, error);
    }
  }
  RecordProperty("worst_sigma", FormatDouble(worst));
}

TEST(ShapeInvariantMasking, DerivativeIsThatOfTheInterpolant) {
  const ShapeInvariantMasking student(StudentProfile(2.7));
  for (const double a : {-3.0, -0.4, 0.02, 0.7, 2.5, 40.0}) {
    double derivative, lambda_derivative;
    const double h = 1e-5 * std::abs(a);
    student.Sigma(a, &derivative);
    EXPECT_NEAR(derivative, (student.Sigma(a + h) - student.Sigma(a - h)) / (2 * h), 1e-9 * (1 + 1 / std::abs(a)));
    student.Lambda(a, &lambda_derivative);
    EXPECT_NEAR(lambda_derivative, (student.Lambda(a + h) - student.Lambda(a - h)) / (2 * h),
                1e-8 * (1 + std::abs(lambda_derivative)));
  }
}

// The same distribution on the sphere as the closed forms, value and gradient.
TEST(ShapeInvariantDistribution, EqualsTheClosedForms) {
  const auto beckmann = Masking(BeckmannProfile()), ggx = Masking(GgxProfile());
  ShapeGenerator random(92);
  for (int i = 0; i < 500; ++i) {
    const SlopeKind kind = i % 2 == 0 ? SlopeKind::kGgx : SlopeKind::kBeckmann;
    const SlopeDistribution s = {kind,
                                 random.LogUniform(0.1, 1),
                                 random.LogUniform(0.1, 1),
                                 random.Uniform(-0.8, 0.8),
                                 random.Uniform(-0.5, 0.5),
                                 random.Uniform(-0.5, 0.5)};
    const ShapeInvariantDistribution general(kind == SlopeKind::kGgx ? ggx : beckmann, s);
    const SlopeNormalDistribution closed(s);
    const Vec3 m = Normalized(Vec3{random.Uniform(-1, 1), random.Uniform(-1, 1), 1}), u = random.Sphere();
    double a[5], b[5];
    const double D = closed.D(m, a);
    EXPECT_NEAR(general.D(m, b), D, 1e-12 * D);
    ExpectSameGradient(b, a, 5, 1e-11);
    EXPECT_NEAR(general.Sigma(u, b), closed.Sigma(u, a), 2e-12);
    ExpectSameGradient(b, a, 5, 1e-9, 1e3);
  }
}

// A compact profile, (1 - t) inside the unit circle of slopes: P2(x) = 8 / (3 pi) (1 - x^2)^(3/2), and nothing outside.
TEST(ShapeInvariantMasking, CompactProfile) {
  const ShapeInvariantMasking dome(
      {[](double t) { return t < 1 ? 1 - t : 0.0; }, [](double t) { return t < 1 ? -1.0 : 0.0; }, 1.0});
  EXPECT_NEAR(dome.Density(0), 2 * kInvPi, 1e-12);
  EXPECT_EQ(dome.Density(1.5), 0);
  EXPECT_EQ(dome.Sigma(-1.01), 0);
  EXPECT_NEAR(dome.Sigma(1.01), 1.01, 1e-15);
  for (const double a : {-0.999, -0.7, -0.2, -1e-3, 0.1, 0.5, 0.95}) {
    const auto p2 = [](double x) { return 8 / (3 * kPi) * std::pow(1 - x * x, 1.5); };
    double derivative;
    EXPECT_NEAR(dome.Sigma(a, &derivative), IntegrateAdaptive([&](double x) { return (x + a) * p2(x); }, -a, 1.0),
                2e-12)
        << a;
    EXPECT_NEAR(derivative, IntegrateAdaptive(p2, -a, 1.0), 2e-9) << a;
  }
}

TEST(ShapeInvariantMasking, RefusesProfilesWithoutAMean) {
  EXPECT_THROW(StudentProfile(1.5), InputError);
  EXPECT_THROW(StudentProfile(std::nan("")), InputError);
  EXPECT_THROW(ShapeInvariantMasking({[](double t) { return 1 / (1 + t); }, [](double) { return 0.0; }}), InputError);
  EXPECT_THROW(ShapeInvariantMasking({[](double) { return -1.0; }, [](double) { return 0.0; }}), InputError);
}

}  // namespace
}  // namespace lobefit

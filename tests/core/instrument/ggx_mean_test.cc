// The closed form against its table, quadrature, Jets by differences, the point model, and its bits on every
// instruction set.
#include "lobefit/core/instrument/ggx_mean.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tests/support/shapes.h"
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/instrument/ellipsoid_means.h"

namespace lobefit {
namespace {

struct Row {
  Ellipsoid ellipsoid;
  Vec3 wo, wi;
  Aperture aperture;
  ConductorIndex index;
};
Row RowOf(const ReferenceTable& table, std::size_t row) {
  return {EllipsoidOfRow(table, row),
          DirectionOfRow(table, row, "o"),
          DirectionOfRow(table, row, "i"),
          {table(row, "delta_s"), table(row, "delta_d")},
          {table(row, "eta"), table(row, "k")}};
}

// Gradient by the five angles from that by the slope coordinates.
void ToAngles(const double* gradient, const double* jacobian, double* to) {
  for (std::size_t j = 0; j < 5; ++j) {
    to[j] = 0;
    for (std::size_t k = 0; k < 5; ++k) to[j] += gradient[k] * jacobian[5 * k + j];
  }
}

TEST(GgxMean, TableOfD) {
  const ReferenceTable table("aperture_ggx");
  std::vector<double> errors;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Row r = RowOf(table, row);
    double jacobian[25], by_slope[5], gradient[5];
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(r.ellipsoid, jacobian);
    const GgxMeanRule rule = MakeGgxMeanRule(r.aperture, 8, FresnelArgument::kCosine);
    const double mean = GgxMeanD(r.wi, r.wo, shape, rule, by_slope);
    ToAngles(by_slope, jacobian, gradient);
    EXPECT_NEAR(mean, table(row, "D_closed"), 1e-12 * mean) << row;
    EXPECT_EQ(GgxMeanD(r.wi, r.wo, shape, rule, nullptr), mean);
    if (r.aperture.source == 0) {
      EXPECT_NEAR(mean, table(row, "D_mean"), 1e-12 * mean) << row;
      ExpectGradient(gradient, table, row, "dD_mean_d", kEllipsoidNames, 1e-2);
    } else {
      errors.push_back(std::fabs(mean / table(row, "D_mean") - 1));
    }
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 5e-7);
  EXPECT_LT(errors.back(), 5e-5);
}

// The flux mean with the smooth factors' weighted mean and n by the rule: what a fit evaluates.
TEST(GgxMean, TableOfTheFlux) {
  const ReferenceTable table("aperture_ggx");
  std::vector<double> one, both;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const Row r = RowOf(table, row);
    const double cos_d = 0.5 * Norm(r.wi + r.wo);
    const GgxMeanRule rule =
        MakeGgxMeanRule(r.aperture, DiscNodeCount(r.aperture, r.ellipsoid.alpha_y, cos_d), FresnelArgument::kCosine);
    double argument;
    const double specular = GgxMeanLobe(r.wi, r.wo, SlopeCoordinatesFromEllipsoid(r.ellipsoid),
                                        Masking::kSmithSeparable, rule, &argument, nullptr, nullptr);
    const double f = specular * FresnelConductor(argument, r.index);
    (r.aperture.source == 0 ? one : both).push_back(std::fabs(f / table(row, "flux_mean") - 1));
  }
  std::sort(one.begin(), one.end());
  std::sort(both.begin(), both.end());
  EXPECT_LT(one[one.size() / 2], 2e-5);
  EXPECT_LT(one.back(), 1e-3);
  EXPECT_LT(both[both.size() / 2], 1e-4);
  EXPECT_LT(both.back(), 1e-2);
}

// A pair whose half vector lies `widths` lobe widths off the lobe's peak, at an incidence; false where a disc would
// reach the horizon.
bool PairNear(const Ellipsoid& e, double widths, double theta_i, double margin, ShapeGenerator* random, Vec3* wi,
              Vec3* wo) {
  const double phi = random->Uniform(-kPi, kPi), turn = random->Uniform(-kPi, kPi);
  *wi = {std::sin(theta_i) * std::cos(phi), std::sin(theta_i) * std::sin(phi), std::cos(theta_i)};
  const Vec3 w = {widths * e.alpha_x * std::cos(turn), widths * e.alpha_y * std::sin(turn), 1};
  const Vec3 m = Normalized(Transposed(EllipsoidRotation(e)) * w);
  *wo = 2 * Dot(*wi, m) * m - *wi;
  return wo->z > std::sin(margin) + 0.02 && wi->z > std::sin(margin) + 0.02;
}

// Alpha 0.005 to 0.5, half angles 0.25 to 5 degrees: the closed form of one disc against quadrature that does not use
// it, the whole flux within the errors that the header states.
TEST(GgxMean, EqualsQuadrature) {
  ShapeGenerator random(11);
  std::vector<double> errors[2];  // median over widths of the disc below and above the lobe's
  for (int trial = 0; trial < 400; ++trial) {
    const double alpha = random.LogUniform(0.005, 0.5);
    const Ellipsoid e = {alpha, alpha * random.Uniform(0.3, 1), random.Uniform(-0.08, 0.08),
                         random.Uniform(-0.08, 0.08), random.Uniform(-3, 3)};
    const double half_angle = DegreesToRadians(random.LogUniform(0.25, 5));
    Vec3 wi, wo;
    if (!PairNear(e, random.Uniform(0, 6), random.Uniform(0, 1.2), half_angle, &random, &wi, &wo)) continue;
    const Aperture aperture = trial % 2 == 0 ? Aperture{0, half_angle} : Aperture{half_angle, 0};
    const ConductorIndex index = {0.4, 2.5};
    const EllipsoidMeans exact = QuadratureMeans(e, index, wo, wi, aperture);
    const GgxMeanRule rule = MakeGgxMeanRule(aperture, 1, FresnelArgument::kCosine);
    double jacobian[25], by_slope[5], gradient[5];
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e, jacobian);
    const double D = GgxMeanD(wi, wo, shape, rule, by_slope);
    ToAngles(by_slope, jacobian, gradient);
    EXPECT_NEAR(D, exact.D.value, 1e-10 * D) << trial;
    ExpectSameGradient(gradient, exact.D.gradient, 5, 1e-9, D);
    double argument;
    const double specular = GgxMeanLobe(wi, wo, shape, Masking::kSmithSeparable, rule, &argument, nullptr, nullptr);
    const double error = std::fabs(specular * FresnelConductor(argument, index) / exact.flux.value - 1);
    EXPECT_LT(error, 5e-3) << trial;
    errors[RelativeDiscWidth(half_angle, e.alpha_y, Dot(wi, Normalized(wi + wo))) < 1 ? 0 : 1].push_back(error);
  }
  for (std::vector<double>& group : errors) {
    ASSERT_GT(group.size(), 50U);
    std::sort(group.begin(), group.end());
    EXPECT_LT(group[group.size() / 2], 1e-5);
  }
}

// A disc that shrinks to a point: the point model, with an error of the square of the disc's width over the lobe's.
TEST(GgxMean, SmallDiscsAreThePointModel) {
  ShapeGenerator random(12);
  int used = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Ellipsoid e = random.Hostile();
    const Vec3 wi = random.Upper(), wo = trial % 7 == 0 ? wi : random.Upper();
    if (wi.z < 1e-3 || wo.z < 1e-3) continue;
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
    const double half_angle = 1e-5 * std::min({e.alpha_x, e.alpha_y, wi.z, wo.z});
    const Aperture aperture = trial % 3 == 0   ? Aperture{half_angle, half_angle}
                              : trial % 3 == 1 ? Aperture{0, half_angle}
                                               : Aperture{half_angle, 0};
    const GgxMeanRule rule = MakeGgxMeanRule(aperture, 3, FresnelArgument::kCosine);
    double gradient[5], point[5], argument, argument_gradient[5], cos_d;
    const double mean =
        GgxMeanLobe(wi, wo, shape, Masking::kSmithUnclamped, rule, &argument, gradient, argument_gradient);
    const double value = GgxLobe(wi, wo, shape, Masking::kSmithUnclamped, &cos_d, point);
    EXPECT_NEAR(mean, value, 1e-8 * value) << trial;
    EXPECT_NEAR(argument, cos_d, 1e-8);
    ExpectSameGradient(gradient, point, 5, 1e-6, value);
    ++used;
  }
  EXPECT_GT(used, 100);
}

// Gradients of value and Fresnel argument against central differences (1e-6 steps in coordinates of order 1).
TEST(GgxMean, GradientsEqualDifferences) {
  ShapeGenerator random(13);
  int used = 0;
  for (int trial = 0; trial < 150; ++trial) {
    const Ellipsoid e = {random.LogUniform(0.02, 0.6), random.LogUniform(0.02, 0.6), random.Uniform(-0.2, 0.2),
                         random.Uniform(-0.2, 0.2), random.Uniform(-3, 3)};
    Vec3 wi, wo;
    if (!PairNear(e, random.Uniform(0, 4), random.Uniform(0, 1.1), 0.1, &random, &wi, &wo)) continue;
    if (trial % 10 == 0) wo = wi;
    Aperture aperture = {trial % 3 == 0 ? 0.0 : 0.03, trial % 3 == 1 ? 0.0 : 0.05};
    if (trial % 4 == 0) aperture.mean = ApertureMean::kPlain;
    const FresnelArgument kind = trial % 2 == 0 ? FresnelArgument::kCosine : FresnelArgument::kSchlickPower;
    const GgxMeanRule rule = MakeGgxMeanRule(aperture, 5, kind);
    const Masking masking = trial % 5 == 0 ? Masking::kSmithHeight : Masking::kSmithUnclamped;
    const SlopeCoordinates at = SlopeCoordinatesFromEllipsoid(e);
    double argument, gradient[5], argument_gradient[5], expected[5], expected_argument[5];
    const double value = GgxMeanLobe(wi, wo, at, masking, rule, &argument, gradient, argument_gradient);
    for (int j = 0; j < 5; ++j) {
      const double step = 1e-6 * (j == 2 || j == 4 ? 1 : e.alpha_y);
      double values[2], arguments[2];
      for (int side = 0; side < 2; ++side) {
        SlopeCoordinates moved = at;
        moved.v[j] += side == 0 ? -step : step;
        values[side] = GgxMeanLobe(wi, wo, moved, masking, rule, &arguments[side], nullptr, nullptr);
      }
      expected[j] = (values[1] - values[0]) / (2 * step);
      expected_argument[j] = (arguments[1] - arguments[0]) / (2 * step);
    }
    ExpectSameGradient(gradient, expected, 5, 1e-6, 1e6 * value);
    ExpectSameGradient(argument_gradient, expected_argument, 5, 1e-5, 1e7);
    ++used;
  }
  EXPECT_GT(used, 60);
}

// Reciprocal: the discs trade places with the directions.
TEST(GgxMean, IsReciprocal) {
  ShapeGenerator random(14);
  for (int trial = 0; trial < 60; ++trial) {
    const Ellipsoid e = random.Moderate();
    const Vec3 wi = random.Upper(), wo = random.Upper();
    if (wi.z < 0.1 || wo.z < 0.1) continue;
    const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(e);
    double argument;
    const double a =
        GgxMeanLobe(wi, wo, shape, Masking::kSmithSeparable, MakeGgxMeanRule({0.02, 0.05}, 4, FresnelArgument::kCosine),
                    &argument, nullptr, nullptr);
    const double b =
        GgxMeanLobe(wo, wi, shape, Masking::kSmithSeparable, MakeGgxMeanRule({0.05, 0.02}, 4, FresnelArgument::kCosine),
                    &argument, nullptr, nullptr);
    EXPECT_NEAR(a, b, 1e-13 * a);
  }
}

TEST(GgxMeanArrays, HaveTheBitsOfTheScalarPathOnEveryTarget) {
  const auto body = [] {
    ShapeGenerator random(15);
    for (int trial = 0; trial < 40; ++trial) {
      const SlopeCoordinates shape = SlopeCoordinatesFromEllipsoid(random.Hostile());
      constexpr std::size_t kMost = 17;
      std::vector<double> d[6];
      for (std::size_t k = 0; k < kMost; ++k) {
        const Vec3 wi = random.Upper(), wo = k % 5 == 0 ? wi : random.Upper();
        const double all[6] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
        for (std::size_t j = 0; j < 6; ++j) d[j].push_back(all[j]);
      }
      const std::size_t count = static_cast<std::size_t>(trial) % (kMost + 1);
      const DirectionArrays directions = {d[0].data(), d[1].data(), d[2].data(), d[3].data(),
                                          d[4].data(), d[5].data(), count};
      const Aperture aperture = {trial % 2 == 0 ? 0.0 : 0.01, 0.02};
      const Masking masking = static_cast<Masking>(trial % 3);
      const GgxMeanRule rule = MakeGgxMeanRule(aperture, 3, FresnelArgument::kSchlickPower);
      std::vector<double> specular(count + 1, -7), argument(count + 1, -7), gradient(5 * count + 1, -7),
          argument_gradient(5 * count + 1, -7), again(count + 1, -7);
      GgxMeanLobe(directions, shape, masking, rule,
                  {specular.data(), argument.data(), gradient.data(), argument_gradient.data()});
      GgxMeanLobe(directions, shape, masking, rule, {again.data(), argument.data(), nullptr, nullptr});
      for (std::size_t i = 0; i < count; ++i) {
        double one_argument, one[5], one_by_argument[5];
        const double value = GgxMeanLobe({d[0][i], d[1][i], d[2][i]}, {d[3][i], d[4][i], d[5][i]}, shape, masking, rule,
                                         &one_argument, one, one_by_argument);
        EXPECT_EQ(std::memcmp(&value, &specular[i], sizeof value), 0);
        EXPECT_EQ(std::memcmp(&value, &again[i], sizeof value), 0);
        EXPECT_EQ(std::memcmp(&one_argument, &argument[i], sizeof value), 0);
        for (std::size_t j = 0; j < 5; ++j) {
          EXPECT_EQ(std::memcmp(&one[j], &gradient[j * count + i], sizeof value), 0);
          EXPECT_EQ(std::memcmp(&one_by_argument[j], &argument_gradient[j * count + i], sizeof value), 0);
        }
      }
      EXPECT_EQ(specular[count], -7);
      EXPECT_EQ(gradient[5 * count], -7);
    }
  };
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
    SCOPED_TRACE(hwy::TargetName(target));
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace
}  // namespace lobefit

// Means over discs that the horizon cuts and over rectangles: against sums over a fine grid of directions, the closed
// form of whole discs, and differences.
#include "lobefit/core/instrument/region_mean.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

struct Axes {
  Vec3 along, across;
};
Axes AxesOf(const Vec3& w) {
  const double sine = std::hypot(w.x, w.y);
  const Vec3 across = {-w.y / sine, w.x / sine, 0};
  return {Cross(across, w), across};
}

// The flux mean of a function of the direction over what is above the horizon of a disc, by equal solid angles.
template <class Function>
double SumOverDisc(const Vec3& w, double half_angle, int rings, int azimuths, const Function& f) {
  const Axes axes = AxesOf(w);
  const double tau = 2 * std::pow(std::sin(0.5 * half_angle), 2);
  double sum = 0;
  for (int r = 0; r < rings; ++r) {
    const double cosine = 1 - tau * (r + 0.5) / rings, sine = std::sqrt(1 - cosine * cosine);
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / azimuths;
      const Vec3 at = cosine * w + sine * std::cos(phi) * axes.along + sine * std::sin(phi) * axes.across;
      if (at.z > 0) sum += f(at) * at.z;
    }
  }
  return sum / (rings * azimuths) / ((1 - 0.5 * tau) * w.z);
}

SlopeCoordinates Lobe(double alpha, double ratio, double tilt) {
  SlopeCoordinates shape;
  shape.v[0] = tilt, shape.v[1] = -0.5 * tilt;
  shape.v[2] = std::log(alpha), shape.v[3] = 0.2 * alpha, shape.v[4] = std::log(ratio * alpha);
  return shape;
}

// Light so that the lobe's middle, `widths` aside, is seen at wo.
Vec3 LightFor(const Vec3& wo, double alpha, double widths) {
  const Vec3 h = Normalized(Vec3{widths * alpha, 0.3 * widths * alpha, 1});
  return 2 * Dot(h, wo) * h - wo;
}

// alpha 0.005 to 0.5, half angles 0.25 to 5 degrees, whole and cut by the horizon, light in and off the lobe. The
// largest errors are those of the polygon and of the mean of what is smooth beside D.
TEST(RegionMean, DiscsAgainstSumsOverDirections) {
  for (const bool cut : {false, true}) {
    for (const double degrees : {0.25, 1., 2., 5.}) {
      std::vector<double> errors;
      double of_wide = 0;  // of the lobes that the disc is at most five times as wide as
      for (const double alpha : {0.005, 0.02, 0.05, 0.1, 0.2, 0.5}) {
        for (const double place : {-1.0, 0.0, 2.5}) {
          const double half_angle = DegreesToRadians(degrees);
          const double theta = cut ? kPi / 2 - 0.4 * half_angle : DegreesToRadians(55);
          const Vec3 wo = {std::sin(theta) * std::cos(0.4), std::sin(theta) * std::sin(0.4), std::cos(theta)};
          // Beside a grazing direction the light is in the lobe of no sample that is fitted.
          const double theta_i = DegreesToRadians(45 + 8 * place), phi_i = 0.4 + kPi + 0.3 * place;
          const Vec3 aside = {std::sin(theta_i) * std::cos(phi_i), std::sin(theta_i) * std::sin(phi_i),
                              std::cos(theta_i)};
          const Vec3 wi = cut ? aside : LightFor(wo, alpha, place);
          const SlopeCoordinates shape = Lobe(alpha, 0.6, 0.01);
          double argument;
          const double mean = GgxRegionMean(wi, wo, shape, Masking::kSmithHeight, DiscRegion(half_angle),
                                            FresnelArgument::kSchlickPower, &argument, nullptr, nullptr);
          const double expected = SumOverDisc(wo, half_angle, 260, 500, [&](const Vec3& at) {
            double cos_d;
            return GgxLobe(wi, at, shape, Masking::kSmithHeight, &cos_d, nullptr);
          });
          errors.push_back(std::fabs(mean / expected - 1));
          const double width = RelativeDiscWidth(half_angle, 0.6 * alpha, 0.5 * Norm(wi + wo));
          if (width < 5) of_wide = std::max(of_wide, errors.back());
        }
      }
      std::sort(errors.begin(), errors.end());
      EXPECT_LT(errors[errors.size() / 2], 2e-4) << degrees << " degrees, cut " << cut;
      EXPECT_LT(of_wide, 3e-3) << degrees << " degrees, cut " << cut;
      EXPECT_LT(errors.back(), 3e-2) << degrees << " degrees, cut " << cut;
    }
  }
}

// Where the horizon is far, the polygon of a disc is the closed form of the disc.
TEST(RegionMean, WholeDiscsAgreeWithTheClosedForm) {
  for (const double alpha : {0.02, 0.1, 0.4}) {
    const Aperture aperture = {0, DegreesToRadians(2)};
    const GgxMeanRule rule = MakeGgxMeanRule(aperture, 1, FresnelArgument::kSchlickPower);
    const Vec3 wo = {std::sin(0.7), 0, std::cos(0.7)}, wi = LightFor(wo, alpha, 0.8);
    const SlopeCoordinates shape = Lobe(alpha, 0.6, 0.02);
    double argument, closed_argument;
    const double closed =
        GgxMeanLobe(wi, wo, shape, Masking::kSmithSeparable, rule, &closed_argument, nullptr, nullptr);
    const double mean = GgxRegionMean(wi, wo, shape, Masking::kSmithSeparable, DiscRegion(aperture.detector),
                                      FresnelArgument::kSchlickPower, &argument, nullptr, nullptr);
    EXPECT_NEAR(mean / closed, 1, 5e-5) << alpha;
    EXPECT_NEAR(argument / closed_argument, 1, 1e-3) << alpha;
  }
}

TEST(RegionMean, RectanglesAgainstAProductRule) {
  const double along = DegreesToRadians(0.5), across = DegreesToRadians(3);
  const QuadratureRule x = GaussLegendre(120), y = GaussLegendre(160);
  for (const double theta_deg : {30., 75., 89.8}) {
    for (const double alpha : {0.02, 0.1, 0.4}) {
      const double theta = DegreesToRadians(theta_deg);
      const Vec3 wo = {std::sin(theta) * std::cos(1.1), std::sin(theta) * std::sin(1.1), std::cos(theta)};
      const Vec3 wi = theta_deg > 89 ? Vec3{-std::sin(0.9) * std::cos(1), -std::sin(0.9) * std::sin(1), std::cos(0.9)}
                                     : LightFor(wo, alpha, 0.4);
      const SlopeCoordinates shape = Lobe(alpha, 0.5, 0);
      const Axes axes = AxesOf(wo);
      double sum = 0, cosine = 0;
      for (std::size_t a = 0; a < x.nodes.size(); ++a) {
        for (std::size_t b = 0; b < y.nodes.size(); ++b) {
          const Vec3 flat =
              wo + std::tan(along) * x.nodes[a] * axes.along + std::tan(across) * y.nodes[b] * axes.across;
          const double length = Norm(flat), weight = x.weights[a] * y.weights[b] / std::pow(length, 3);
          const Vec3 at = (1 / length) * flat;
          cosine += weight / length;
          double cos_d;
          if (at.z > 0) sum += weight * at.z * GgxLobe(wi, at, shape, Masking::kSmithHeight, &cos_d, nullptr);
        }
      }
      double argument;
      const double mean = GgxRegionMean(wi, wo, shape, Masking::kSmithHeight, RectangleRegion(along, across),
                                        FresnelArgument::kCosine, &argument, nullptr, nullptr);
      // The product rule itself has a step at the horizon.
      EXPECT_NEAR(mean / (sum / (cosine * wo.z)), 1, theta_deg > 89 ? 2e-2 : 1e-3) << theta_deg << " " << alpha;
    }
  }
}

TEST(RegionMean, GradientsEqualDifferences) {
  for (const DirectionRegion& region : {DiscRegion(0.05), RectangleRegion(0.01, 0.06)}) {
    for (const double theta : {0.8, kPi / 2 - 0.02}) {
      const Vec3 wo = {std::sin(theta) * std::cos(0.4), std::sin(theta) * std::sin(0.4), std::cos(theta)};
      const double alpha = 0.08;
      const Vec3 wi = theta > 1.2 ? Vec3{-std::sin(0.8) * std::cos(0.5), -std::sin(0.8) * std::sin(0.5), std::cos(0.8)}
                                  : LightFor(wo, alpha, 1);
      SlopeCoordinates shape = Lobe(alpha, 0.6, 0.02);
      double argument, gradient[5], argument_gradient[5];
      const auto mean = [&](double* g, double* ga) {
        return GgxRegionMean(wi, wo, shape, Masking::kSmithHeight, region, FresnelArgument::kSchlickPower, &argument, g,
                             ga);
      };
      const double value = mean(gradient, argument_gradient);
      EXPECT_EQ(mean(nullptr, nullptr), value);
      for (int j = 0; j < 5; ++j) {
        const double step = 1e-6, kept = shape.v[j];
        shape.v[j] = kept + step;
        const double above = mean(nullptr, nullptr), argument_above = argument;
        shape.v[j] = kept - step;
        const double below = mean(nullptr, nullptr), argument_below = argument;
        shape.v[j] = kept;
        // Points that follow the lobe: 1e-4 of the value's change over a width.
        EXPECT_NEAR(gradient[j], (above - below) / (2 * step), 1e-4 * value / alpha) << j;
        EXPECT_NEAR(argument_gradient[j], (argument_above - argument_below) / (2 * step), 1e-4 / alpha) << j;
      }
    }
  }
}

// What is constant is read as itself until the horizon cuts.
TEST(RegionMean, ConstantsAgainstSumsOverDirections) {
  const double half_angle = DegreesToRadians(3);
  for (const double above_deg : {20., 4., 2., 0.5}) {
    const double theta = kPi / 2 - DegreesToRadians(above_deg);
    const Vec3 wo = {std::sin(theta), 0, std::cos(theta)};
    const double expected = SumOverDisc(wo, half_angle, 500, 900, [](const Vec3&) { return 1.0; });
    EXPECT_NEAR(ConstantMean(wo, DiscRegion(half_angle)), expected, 2e-3 * expected) << above_deg;
    if (above_deg > 3) {
      EXPECT_NEAR(expected, 1, 1e-9) << above_deg;
    } else {
      EXPECT_GT(expected, 1.01);
    }
  }
}

}  // namespace
}  // namespace lobefit

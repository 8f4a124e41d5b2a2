// The albedo of a model is the integral of what the same model reflects.
#include "lobefit/core/brdf/model_energy.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr std::size_t kChannels = 3;

// By the midpoints of cells of equal projected solid angle.
std::vector<double> Integral(const Model& model, const ParameterValues& values, const Vec3& wi) {
  constexpr int kRings = 300, kSteps = 600;
  const Reflectance reflectance(model, values, kChannels);
  std::vector<double> sum(kChannels, 0.0), f(kChannels);
  for (int j = 0; j < kRings; ++j) {
    const double sine = std::sqrt((j + 0.5) / kRings);
    for (int k = 0; k < kSteps; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / kSteps;
      reflectance.Evaluate(wi, {sine * std::cos(phi), sine * std::sin(phi), std::sqrt((1 - sine) * (1 + sine))},
                           f.data());
      for (std::size_t c = 0; c < kChannels; ++c) sum[c] += f[c] * kPi / (kRings * kSteps);
    }
  }
  return sum;
}

// A curve of its own in each channel: its basis is summed once for all of them.
TEST(ModelEnergy, CurvesOfSeveralChannels) {
  for (const LobeDirection direction : {LobeDirection::kSpecular, LobeDirection::kRetro}) {
    Model model = {{{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCurve}}, Diffuse::kLambert};
    model.lobes[0].direction = direction;
    const ParameterValues values = {{0.35},
                                    {0.35},
                                    {0},
                                    {0},
                                    {0},
                                    {0.9, 0.1, 0},
                                    {0.5, 0.2, 0},
                                    {0.3, 0.4, 0.7},
                                    {0.2, 0.8, 0.1},
                                    {0.2, 0.3, 0.6},
                                    {0.1, 0.5, 0.5},
                                    {0.2, 0.05, 0}};
    for (const double degrees : {0., 40., 70.}) {
      const Vec3 wi = FromSpherical(DegreesToRadians(degrees), 0.7);
      const std::vector<double> albedo = DirectionalAlbedo(model, values, kChannels, wi),
                                expected = Integral(model, values, wi);
      for (std::size_t c = 0; c < kChannels; ++c) EXPECT_NEAR(albedo[c] / expected[c], 1, 1e-3) << degrees << " " << c;
    }
  }
}

// A curve whose coefficients are one number is that number.
TEST(ModelEnergy, AConstantCurveIsAFactor) {
  const Model curve = {{{Ndf::kGgxAnisotropic, Masking::kSmithSeparable, Fresnel::kCurve}}, Diffuse::kNone},
              factor = {{{Ndf::kGgxAnisotropic, Masking::kSmithSeparable, Fresnel::kNone}}, Diffuse::kNone};
  const std::vector<double> scale = {0.3, 0.7, 1.1};
  const Vec3 wi = FromSpherical(DegreesToRadians(55), 0.7);
  const ParameterValues shape = {{0.4}, {0.1}, {0}, {0}, {0.3}};
  ParameterValues of_curve = shape, of_factor = shape;
  of_curve.insert(of_curve.end(), 6, scale);
  of_factor.push_back(scale);
  const std::vector<double> a = DirectionalAlbedo(curve, of_curve, kChannels, wi),
                            b = DirectionalAlbedo(factor, of_factor, kChannels, wi);
  for (std::size_t c = 0; c < kChannels; ++c) EXPECT_NEAR(a[c], b[c], 1e-12 * b[c]);
}

}  // namespace
}  // namespace lobefit

// The 95 % intervals of curves that are drawn from the parameters of a fit.
#include "lobefit/report/panels/curve_interval.h"

#include <cmath>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/math/student_t.h"

namespace lobefit {
namespace {

constexpr double kAlphaError = 0.01, kF0Error = 0.02;
constexpr double kAlphaFreedom = 3, kF0Freedom = 40;

// alpha_x and f0 of the first channel have errors, which are not correlated.
Material WithErrors() {
  Material material = test::MakeMaterial(1, false);
  material.covariance_names.clear();
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const bool is_alpha = parameters[p].json_name == "alpha_x", is_f0 = parameters[p].json_name == "f0";
    if (!is_alpha && !is_f0) continue;
    material.covariance_names.push_back(is_f0 ? "f0[" + material.channels[0] + "]" : "alpha_x");
    material.parameters[p].freedom = {is_alpha ? kAlphaFreedom : kF0Freedom};
    material.parameters[p].independent_freedom = {HUGE_VAL};
  }
  material.covariance_clustered = {kAlphaError * kAlphaError, 0, 0, kF0Error * kF0Error};
  material.covariance = {4 * kAlphaError * kAlphaError, 0, 0, 4 * kF0Error * kF0Error};
  return material;
}

std::size_t IndexOf(const Material& material, const char* name) {
  const std::vector<Parameter> parameters = Parameters(material.model);
  std::size_t p = 0;
  while (parameters[p].json_name != name) ++p;
  return p;
}

const auto kEvery = [](std::size_t, std::size_t) { return true; };

TEST(HalfIntervals, AreThoseOfTheParametersThemselves) {
  Material material = WithErrors();
  const std::size_t alpha = IndexOf(material, "alpha_x"), f0 = IndexOf(material, "f0");
  const auto curve = [&](const ParameterValues& values) {
    // The last depends on f0, and on alpha for a hundred-thousandth of its variance.
    return std::vector<double>{values[alpha][0], 3 * values[f0][0], values[f0][0] + 0.006 * values[alpha][0],
                               values[f0][0] + values[alpha][0]};
  };
  const double few = StudentTQuantile(0.975, kAlphaFreedom), many = StudentTQuantile(0.975, kF0Freedom);
  const std::vector<double> half = HalfIntervals(material, curve, kEvery);
  ASSERT_EQ(half.size(), 4U);
  EXPECT_NEAR(half[0], few * kAlphaError, 1e-9);
  EXPECT_NEAR(half[1], many * 3 * kF0Error, 1e-9);
  EXPECT_NEAR(half[2], many * std::hypot(kF0Error, 0.006 * kAlphaError), 1e-9);
  EXPECT_NEAR(half[3], few * std::hypot(kF0Error, kAlphaError), 1e-9);
  // Without clusters the errors are those of independent samples, with their freedom.
  material.covariance_clustered.clear();
  EXPECT_NEAR(HalfIntervals(material, curve, kEvery)[0], StudentTQuantile(0.975, HUGE_VAL) * 2 * kAlphaError, 1e-9);
}

TEST(HalfIntervals, AreNoneOfWhatHasNoError) {
  const Material material = WithErrors();
  const std::size_t diffuse = IndexOf(material, "diffuse");
  const auto curve = [&](const ParameterValues& values) { return std::vector<double>{values[diffuse][0]}; };
  EXPECT_TRUE(HalfIntervals(material, curve, [&](std::size_t p, std::size_t) { return p == diffuse; }).empty());
}

}  // namespace
}  // namespace lobefit

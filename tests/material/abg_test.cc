#include "lobefit/material/abg.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

// alpha, g and the scales of two channels with errors that depend on each other.
Material Mirror(double alpha, double g, double scale_a, double scale_b) {
  Material material;
  material.model = {{{Ndf::kAbg, Masking::kNone, Fresnel::kNone}}, Diffuse::kNone};
  material.channels = {"a", "b"};
  for (const std::vector<double>& values :
       std::vector<std::vector<double>>{{alpha}, {alpha}, {0}, {0}, {0}, {g}, {scale_a, scale_b}})
    material.parameters.push_back({values, {}, {}, {}});
  material.covariance_names = {"alpha_x", "g", "scale[a]", "scale[b]"};
  material.covariance = {4e-10, 3e-8,  1e-9, 2e-9,   //
                         3e-8,  9e-6,  4e-8, -1e-8,  //
                         1e-9,  4e-8,  1e-8, 1e-9,   //
                         2e-9,  -1e-8, 1e-9, 2.5e-9};
  return material;
}

TEST(AbgNumbers, AreThoseOfTheFormula) {
  const std::vector<AbgNumbers> numbers = AbgNumbersOf(Mirror(0.003, 1.7, 0.001, 0.0004));
  ASSERT_EQ(numbers.size(), 2U);
  EXPECT_EQ(numbers[1].channel, "b");
  EXPECT_DOUBLE_EQ(numbers[0].B, std::pow(0.006, 1.7));
  // f_r at the mirror direction is A / B.
  EXPECT_NEAR(numbers[0].A / numbers[0].B, 0.001 / (4 * 3.14159265358979324 * 9e-6), 1e-9);
  EXPECT_NEAR(numbers[1].A / numbers[0].A, 0.4, 1e-12);
  Material without = Mirror(0.003, 1.7, 0.001, 0.0004);
  without.covariance_names.clear();
  without.covariance.clear();
  EXPECT_TRUE(std::isnan(AbgNumbersOf(without)[0].A_error));
  without.model.lobes[0] = {Ndf::kGgx};
  without.parameters.erase(without.parameters.begin() + 5);
  EXPECT_TRUE(AbgNumbersOf(without).empty());
}

// To first order by differences: g^T C g with each derivative taken of the numbers themselves.
TEST(AbgNumbers, ErrorsAreThoseOfTheCovariance) {
  const double at[4] = {0.003, 1.7, 0.001, 0.0004};
  const Material material = Mirror(at[0], at[1], at[2], at[3]);
  const std::vector<AbgNumbers> numbers = AbgNumbersOf(material);
  for (std::size_t c = 0; c < 2; ++c) {
    double by[3][4];
    for (std::size_t k = 0; k < 4; ++k) {
      const double h = 1e-5 * at[k];
      double up[4], down[4];
      for (std::size_t i = 0; i < 4; ++i) up[i] = at[i] + (i == k ? h : 0), down[i] = at[i] - (i == k ? h : 0);
      const AbgNumbers a = AbgNumbersOf(Mirror(up[0], up[1], up[2], up[3]))[c],
                       b = AbgNumbersOf(Mirror(down[0], down[1], down[2], down[3]))[c];
      by[0][k] = (a.A - b.A) / (2 * h), by[1][k] = (a.B - b.B) / (2 * h), by[2][k] = (a.g - b.g) / (2 * h);
    }
    const double errors[3] = {numbers[c].A_error, numbers[c].B_error, numbers[c].g_error};
    for (std::size_t n = 0; n < 3; ++n) {
      double square = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) square += by[n][i] * material.covariance[4 * i + j] * by[n][j];
      }
      EXPECT_NEAR(errors[n] / std::sqrt(square), 1, 1e-6) << c << " " << n;
    }
  }
}

}  // namespace
}  // namespace lobefit

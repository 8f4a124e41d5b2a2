#include "lobefit/fit/coordinates/coordinates.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

const std::vector<std::string> kChannels = {"R", "G"};

Recipe OneLobeRecipe(Ndf ndf) {
  return DefaultRecipe({{Lobe{ndf, Masking::kSmithSeparable, Fresnel::kSchlick}}, Diffuse::kLambert}, "test");
}

// Flattened Report.
std::vector<double> Flat(const Layout& layout, const std::vector<double>& u) {
  std::vector<double> flat;
  for (const std::vector<double>& values : layout.Report(u.data()))
    flat.insert(flat.end(), values.begin(), values.end());
  return flat;
}

void ExpectJacobianOfReport(const Layout& layout, const std::vector<double>& u) {
  const Eigen::MatrixXd jacobian = layout.ReportJacobian(u.data());
  for (std::size_t k = 0; k < u.size(); ++k) {
    std::vector<double> up = u, down = u;
    up[k] += 1e-6;
    down[k] -= 1e-6;
    const std::vector<double> high = Flat(layout, up), low = Flat(layout, down);
    for (std::size_t i = 0; i < high.size(); ++i) {
      EXPECT_NEAR(jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)), (high[i] - low[i]) / 2e-6, 1e-6)
          << i << " " << k;
    }
  }
}

// The kernel's shape Jacobian against differences of its shape.
void ExpectJacobianOfShape(const Layout& layout, const std::vector<double>& u) {
  const KernelModel kernel = layout.ToKernel(u.data());
  for (std::size_t k = 0; k < layout.shape_size(); ++k) {
    std::vector<double> up = u, down = u;
    up[k] += 1e-6;
    down[k] -= 1e-6;
    const KernelModel high = layout.ToKernel(up.data()), low = layout.ToKernel(down.data());
    for (std::size_t j = 0; j < 5; ++j) {
      const double difference = (high.lobes[0].shape.slope.v[j] - low.lobes[0].shape.slope.v[j]) / 2e-6;
      EXPECT_NEAR(kernel.lobes[0].jacobian[j * kernel.lobes[0].columns + k], difference, 1e-8) << j << " " << k;
    }
  }
}

TEST(Layout, CoordinatesOfEachNdf) {
  // Shape coordinates + 2 f0 + 2 diffuse.
  EXPECT_EQ(Layout(OneLobeRecipe(Ndf::kGgx), kChannels).size(), 1U + 4);
  EXPECT_EQ(Layout(OneLobeRecipe(Ndf::kGgxTilted), kChannels).size(), 2U + 4);
  EXPECT_EQ(Layout(OneLobeRecipe(Ndf::kGgxAnisotropic), kChannels).size(), 3U + 4);
  EXPECT_EQ(Layout(OneLobeRecipe(Ndf::kEllipsoid), kChannels).size(), 5U + 4);
}

TEST(Layout, FixedAndSharedParametersAreNotCoordinates) {
  Recipe recipe = OneLobeRecipe(Ndf::kEllipsoid);
  recipe.parameters[2].fixed = {0.1};
  recipe.parameters[5].shared = true;
  recipe.parameters[6].fixed = {0.3};
  const Layout layout(recipe, kChannels);
  EXPECT_EQ(layout.size(), 4U + 1);
  EXPECT_FALSE(layout.in_slope_space(0));
  std::vector<double> u = layout.FromShapes({{0.3, 0.2, 0.5, 0.02, 0.3}});
  u[4] = 0.4;
  const ParameterValues values = layout.Report(u.data());
  EXPECT_EQ(values[2][0], 0.1);
  EXPECT_EQ(values[5], (std::vector<double>{0.4, 0.4}));
  EXPECT_EQ(values[6], (std::vector<double>{0.3, 0.3}));
}

TEST(Layout, RoundTripThroughCoordinates) {
  const Layout layout(OneLobeRecipe(Ndf::kEllipsoid), kChannels);
  const std::vector<double> u = layout.FromShapes({{0.3, 0.1, 0.05, -0.1, 0.7}});
  const ParameterValues values = layout.Report(u.data());
  const double expected[] = {0.3, 0.1, 0.05, -0.1, 0.7};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(values[i][0], expected[i], 1e-13);
}

TEST(Layout, JacobiansAgreeWithDifferences) {
  for (const Ndf ndf : {Ndf::kGgx, Ndf::kGgxTilted, Ndf::kGgxAnisotropic, Ndf::kEllipsoid}) {
    Recipe recipe = OneLobeRecipe(ndf);
    recipe.plane_azimuth = 0.3;
    const Layout layout(recipe, kChannels);
    const std::vector<double> u = layout.FromShapes({{0.3, 0.1, 0.05, -0.1, 0.7}});
    ExpectJacobianOfShape(layout, u);
    ExpectJacobianOfReport(layout, u);
  }
  Recipe restricted = OneLobeRecipe(Ndf::kEllipsoid);
  restricted.parameters[0].low = 0.1;
  restricted.parameters[0].high = 0.5;
  const Layout layout(restricted, kChannels);
  const std::vector<double> u = layout.FromShapes({{0.3, 0.1, 0.05, -0.1, 0.7}});
  ExpectJacobianOfShape(layout, u);
  ExpectJacobianOfReport(layout, u);
}

TEST(Layout, RefusesARecipeWithNothingFree) {
  Recipe recipe = OneLobeRecipe(Ndf::kGgx);
  for (const std::size_t i : {0, 5, 6}) recipe.parameters[i].fixed = {0.1};
  EXPECT_THROW(Layout(recipe, kChannels), InputError);
  recipe.parameters[5].fixed = {0.1, 0.2, 0.3};
  recipe.parameters[6].fixed.clear();
  EXPECT_THROW(Layout(recipe, kChannels), InputError);
}

}  // namespace
}  // namespace lobefit

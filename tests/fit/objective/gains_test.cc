// Gains of incidences: what is left of the normal equations once they are taken out, against all unknowns at once.
#include "lobefit/fit/objective/gains.h"

#include <cmath>

#include "tests/support/reference_table.h"
#include "tests/support/synthetic.h"
#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

class GainsOf : public testing::TestWithParam<Metric> {
 protected:
  static Measurement Drifting() {
    GoniometerLayout layout;
    for (const double degrees : {15., 40., 60.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
    for (const double degrees : {0., 70.}) layout.azimuths.push_back(DegreesToRadians(degrees));
    layout.detector_step = DegreesToRadians(12);
    const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.35, 0.2, 1, 3, 25, {0.7, 0.5}, {0.1, 0.05});
    const Reflectance reflectance(truth.model, truth.values, truth.channels.size());
    Noise noise;
    noise.multiplicative = 0.05;
    noise.drift = 0.1;
    return Synthesise(
        Goniometer(layout), {truth.channels, {}},
        [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, noise, 5);
  }
  static Recipe RecipeWith(Metric metric) {
    Model model;
    model.lobes = {Lobe{Ndf::kEllipsoid, Masking::kSmithUnclamped, Fresnel::kSchlick}};
    Recipe recipe = DefaultRecipe(model, "drift");
    recipe.metric = metric;
    recipe.instrument.drift = DriftRecipe{0.1};
    if (metric == Metric::kAsinh) recipe.noise = {0.01, 0.05};
    return recipe;
  }
};

TEST_P(GainsOf, GradientAndStepAreThoseOfAllUnknownsTogether) {
  const Measurement measurement = Drifting();
  const Recipe recipe = RecipeWith(GetParam());
  const Layout layout(recipe, measurement.channels.names);
  const Incidences incidences = GroupByIncidence(measurement);
  Problem problem(measurement.samples, recipe);
  Gains gains(incidences);
  gains.SetPrior(0.003, 0.1);
  problem.AttachGains(&gains);
  ThreadPool pool(1);
  std::vector<double> u = layout.FromShapes({{0.3, 0.2, 0.02, 0.04, 0.3}});
  for (std::size_t k = layout.shape_size(); k < u.size(); ++k) u[k] = k < layout.shape_size() + 2 ? 0.6 : 0.07;
  const BoundedObjective objective = ObjectiveOf(problem, layout, &pool);
  const auto at = [&](const std::vector<double>& v) -> Eigen::VectorXd {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  objective.evaluate(at(u), &hessian, &gradient);

  // By differences of the cost where the gains follow.
  for (std::size_t k = 0; k < u.size(); ++k) {
    std::vector<double> low = u, high = u;
    low[k] -= 1e-5;
    high[k] += 1e-5;
    const double slope =
        (objective.evaluate(at(high), nullptr, nullptr) - objective.evaluate(at(low), nullptr, nullptr)) / 2e-5;
    EXPECT_NEAR(gradient(static_cast<Eigen::Index>(k)), slope, 1e-6 * gradient.cwiseAbs().maxCoeff()) << k;
  }

  // The dense Jacobian of model and gains.
  objective.evaluate(at(u), &hessian, &gradient);
  const auto p = static_cast<Eigen::Index>(layout.size()), groups = static_cast<Eigen::Index>(gains.size());
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(p + groups, p + groups);
  std::vector<std::vector<double>> columns;
  Columns(problem.kernel_samples(), layout.ToKernel(u.data()), 0, problem.size(), &columns);
  for (std::size_t c = 0; c < layout.channels(); ++c) {
    const std::vector<int> index = layout.CoordinatesOfColumns(c);
    for (std::size_t i = 0; i < problem.size(); ++i) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(p + groups);
      for (std::size_t j = 0; j < index.size(); ++j) {
        const double value = columns[c][j * problem.size() + i];
        row(j + 1 == index.size() ? p + incidences.group[i] : index[j]) += value;
      }
      joint += row * row.transpose();
    }
  }
  joint.bottomRightCorner(groups, groups).diagonal().array() += gains.precision();
  const Eigen::MatrixXd schur =
      joint.topLeftCorner(p, p) -
      joint.topRightCorner(p, groups) *
          joint.bottomRightCorner(groups, groups).ldlt().solve(joint.bottomLeftCorner(groups, p));
  EXPECT_LT((hessian - schur).cwiseAbs().maxCoeff(), 1e-10 * joint.cwiseAbs().maxCoeff());
}

TEST_P(GainsOf, AreTheSameWithManyThreads) {
  const Measurement measurement = Drifting();
  const Recipe recipe = RecipeWith(GetParam());
  const Layout layout(recipe, measurement.channels.names);
  const Incidences incidences = GroupByIncidence(measurement);
  const std::vector<double> u = layout.FromShapes({{0.3, 0.2, 0.02, 0.04, 0.3}});
  std::vector<std::vector<double>> found;
  for (const int threads : {1, 8}) {
    Problem problem(measurement.samples, recipe);
    Gains gains(incidences);
    problem.AttachGains(&gains);
    ThreadPool pool(threads);
    gains.Profile(problem, layout.ToKernel(u.data()), &pool);
    found.push_back(gains.logarithms());
  }
  EXPECT_EQ(found[0], found[1]);
}

// The table's profiled gains under asinh, by the kernel itself: a Lambert part of eight channels, whose albedos are the
// table's eight values.
TEST(ReferenceTable, GainsOfTheKernel) {
  const ReferenceTable table("gain_profile");
  constexpr std::size_t kValues = 8;
  Samples samples;
  samples.values.resize(kValues);
  const double readings[kValues] = {};
  samples.Append({0, 0, 1}, {0.6, 0, 0.8}, readings, 0);
  Recipe recipe = DefaultRecipe(Model{}, "black");
  recipe.metric = Metric::kLog;
  const Incidences incidences = {{Vec3{0, 0, 1}}, {0}};
  ThreadPool pool(1);
  for (std::size_t row = 0; row < table.size(); ++row) {
    KernelModel model;
    model.channels = kValues;
    model.gains = true;
    model.transform = {Curve::kAsinh, table(row, "knee")};
    double largest = 0;
    for (std::size_t c = 0; c < kValues; ++c) {
      model.diffuse.push_back(kPi * table(row, "f" + std::to_string(c)));
      samples.values[c][0] = table(row, "y" + std::to_string(c));
      largest = std::max(largest, std::fabs(table(row, "dcost_asinh_df" + std::to_string(c))));
    }
    Problem problem(samples, recipe);
    Gains gains(incidences);
    const double square = table(row, "rho") * table(row, "rho");
    gains.SetPrior(square, table(row, "s"));
    problem.AttachGains(&gains);
    gains.Profile(problem, model, &pool);
    EXPECT_NEAR(gains.logarithms()[0], table(row, "ln_g"), 1e-9 * table(row, "s")) << row;
    const KernelSums sums = problem.Sum(model, true, &pool);
    const double cost = table(row, "cost_asinh");
    EXPECT_NEAR(sums.sum_rho / square, cost, 1e-12 * std::max(1.0, cost)) << row;
    for (std::size_t c = 0; c < kValues; ++c) {
      // Columns of a channel: albedo, gain, residual.
      const double slope = 2 * kPi * sums.gram[c][2] / square;
      EXPECT_NEAR(slope, table(row, "dcost_asinh_df" + std::to_string(c)), 1e-9 * largest) << row << " " << c;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Metrics, GainsOf, testing::Values(Metric::kLog, Metric::kCubeRoot, Metric::kAsinh));

}  // namespace
}  // namespace lobefit

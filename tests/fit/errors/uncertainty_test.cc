#include "lobefit/fit/errors/uncertainty.h"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "tests/fit/ceres_loss.h"
#include "tests/support/jet_model.h"
#include "tests/support/synthetic.h"
#include <Eigen/Dense>
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "lobefit/fit/errors/file_clusters.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

constexpr int kSize = 5 + 6;
using Jet = ceres::Jet<double, kSize>;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

// 60 samples of 5 incidences, 3 channels.
Measurement SixtySamples() {
  GoniometerLayout layout = StandardLayout();
  layout.polar_angles.clear();
  for (const double degrees : {10., 30., 50., 65., 75.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  layout.azimuths = {0};
  Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), layout, 0.1, 5);
  const Incidences incidences = GroupByIncidence(measurement);
  std::vector<std::size_t> kept;
  for (std::size_t g = 0; g < incidences.wi.size(); ++g) {
    std::size_t seen = 0, taken = 0;
    for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
      if (incidences.group[i] != g) continue;
      if (seen++ % 6 == 0 && taken++ < 12) kept.push_back(i);
    }
  }
  measurement.samples = measurement.samples.Subset(kept);
  return measurement;
}

Matrix Power(const Matrix& symmetric, double power) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(symmetric);
  const Vector values = eigen.eigenvalues().array().pow(power);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

// The covariances of the solver's coordinates by the textbook, every matrix of all residuals written out.
struct Textbook {
  Matrix hc3, cr2;
  Vector hc3_freedom;  // of each row of `numbers`
  Vector freedom;      // of `cr2`, likewise
};

Textbook EvaluateTextbook(const Recipe& recipe, const Layout& layout, const Samples& samples,
                          const Incidences& incidences, const std::vector<double>& u, const Matrix& numbers) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  const KernelModel kernel = layout.ToKernel(u.data());
  std::array<Jet, kSize> jets;
  for (int k = 0; k < kSize; ++k) jets[static_cast<std::size_t>(k)] = Jet(u[static_cast<std::size_t>(k)], k);
  Vector weight(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const double sin_i = std::sqrt(1 - samples.wi_z[s] * samples.wi_z[s]),
                 sin_o = std::sqrt(1 - samples.wo_z[s] * samples.wo_z[s]);
    weight(i) = samples.weight.empty() ? 1.0 : samples.weight[s];
    if (recipe.weighting == Weighting::kSolidAngle) weight(i) *= samples.solid_angle[s];
    if (recipe.metric == Metric::kNgan) weight(i) *= sin_i * sin_o;
    if (recipe.metric == Metric::kLowLog) weight(i) *= sin_i;
  }
  weight *= static_cast<double>(count) / weight.sum();
  Matrix j(3 * count, kSize), score(count, kSize);
  Vector r(3 * count);
  std::vector<Matrix> part(samples.size());  // of A, a sample
  Matrix a = Matrix::Zero(kSize, kSize);
  const std::unique_ptr<ceres::LossFunction> loss = CeresLoss(recipe.loss, kernel.loss_scale);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto s = static_cast<std::size_t>(i);
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const Jet residual =
          JetResidual(kernel.transform, JetModelValue(jets.data(), channel, samples.wi(s), samples.wo(s)),
                      samples.values[channel][s], samples.wi(s));
      j.row(3 * i + c) = std::sqrt(weight(i)) * residual.v.transpose();
      r(3 * i + c) = std::sqrt(weight(i)) * residual.a;
    }
    double rho[3];
    loss->Evaluate(r.segment(3 * i, 3).squaredNorm(), rho);
    const Matrix rows = j.middleRows(3 * i, 3);
    const Vector gradient = rows.transpose() * r.segment(3 * i, 3);
    score.row(i) = rho[1] * gradient.transpose();
    part[s] = rho[1] * rows.transpose() * rows + 2 * rho[2] * gradient * gradient.transpose();
    a += part[s];
  }
  Textbook textbook;
  textbook.cr2.setZero(kSize, kSize);
  Matrix moves(kSize, count);
  for (Eigen::Index i = 0; i < count; ++i)
    moves.col(i) = (a - part[static_cast<std::size_t>(i)]).fullPivLu().solve(score.row(i).transpose());
  textbook.hc3 = moves * moves.transpose();
  const Matrix squares = (numbers * moves).cwiseAbs2();
  textbook.hc3_freedom = 3 * squares.rowwise().sum().array().square() / squares.cwiseAbs2().rowwise().sum().array();
  const Matrix inverse = a.inverse(), root = Power(a, -0.5);
  const Matrix hat = j * inverse * j.transpose(), residual_maker = Matrix::Identity(3 * count, 3 * count) - hat;
  // Each sample's residuals as noise: those of a fit without it.
  Matrix noise = Matrix::Zero(3 * count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    noise.block(3 * i, i, 3, 1) = residual_maker.block(3 * i, 3 * i, 3, 3).fullPivLu().solve(r.segment(3 * i, 3));
  const auto groups = static_cast<Eigen::Index>(incidences.wi.size());
  // What each sample's noise gives to the part of a cluster in a number.
  std::vector<Matrix> parts(static_cast<std::size_t>(numbers.rows()), Matrix::Zero(groups, count));
  for (Eigen::Index g = 0; g < groups; ++g) {
    std::vector<Eigen::Index> rows;
    Matrix curvature = Matrix::Zero(kSize, kSize);
    Vector sum = Vector::Zero(kSize);
    for (Eigen::Index i = 0; i < count; ++i) {
      if (incidences.group[static_cast<std::size_t>(i)] != g) continue;
      for (int c = 0; c < 3; ++c) rows.push_back(3 * i + c);
      curvature += part[static_cast<std::size_t>(i)];
      sum += score.row(i).transpose();
    }
    Vector move;
    if (recipe.loss == Loss::kNone) {
      // Bell and McCaffrey, with the residuals themselves.
      const Matrix x = j(rows, Eigen::all);
      const Matrix adjust = Power(residual_maker(rows, rows), -0.5);
      move = inverse * x.transpose() * adjust * r(rows);
      for (Eigen::Index k = 0; k < numbers.rows(); ++k) {
        const Vector of_residuals =
            residual_maker(Eigen::all, rows) * adjust * x * inverse * numbers.row(k).transpose();
        parts[static_cast<std::size_t>(k)].row(g) = of_residuals.transpose() * noise;
      }
    } else {
      const Matrix whitened = root * curvature * root;
      const Matrix inflate = Power(Matrix::Identity(kSize, kSize) - whitened, -0.5);
      move = root * inflate * root * sum;
      for (Eigen::Index k = 0; k < numbers.rows(); ++k) {
        const Vector y = inflate * root * numbers.row(k).transpose();
        for (Eigen::Index i = 0; i < count; ++i) {
          const bool own = incidences.group[static_cast<std::size_t>(i)] == g;
          const Vector influence = (own ? y : Vector::Zero(kSize)) - whitened * y;
          parts[static_cast<std::size_t>(k)](g, i) = influence.dot(root.inverse() * moves.col(i));
        }
      }
    }
    textbook.cr2 += move * move.transpose();
  }
  textbook.freedom.resize(numbers.rows());
  for (Eigen::Index k = 0; k < numbers.rows(); ++k) {
    const Matrix& of_number = parts[static_cast<std::size_t>(k)];
    const Matrix covariance = of_number * of_number.transpose();
    double square = covariance.squaredNorm();
    for (Eigen::Index g = 0; g < groups; ++g) {
      double sum = 0, fourths = 0;
      for (Eigen::Index i = 0; i < count; ++i) {
        if (incidences.group[static_cast<std::size_t>(i)] != g) continue;
        sum += squares(k, i);
        fourths += squares(k, i) * squares(k, i);
      }
      square -= 2 * fourths / 3 * std::pow(covariance(g, g) / sum, 2);
    }
    textbook.freedom(k) = std::min(covariance.trace() * covariance.trace() / square, static_cast<double>(groups));
  }
  return textbook;
}

enum class Weights { kNone, kOwn, kSolidAngle, kBoth };

class EveryResidual : public testing::TestWithParam<std::tuple<Metric, Weights, Loss>> {};

// Catches HC2 for HC3, CR1 for CR2, rho'' left out, a weight left out, a standard error wrong by any factor.
TEST_P(EveryResidual, ErrorsAreTheTextbooks) {
  const auto [metric, weights, loss] = GetParam();
  Measurement measurement = SixtySamples();
  Samples& samples = measurement.samples;
  ASSERT_EQ(samples.size(), 60U);
  Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  recipe.metric = metric;
  recipe.noise = {0.01, 0.05};
  recipe.loss = loss;
  // Tukey's, five times as wide: with many samples on its flank, one incidence has more curvature than all together,
  // and CR2 is not defined.
  recipe.loss_scale = loss == Loss::kTukey ? 0.5 : 0.1;
  recipe.weighting = Weighting::kCells;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto x = static_cast<double>(i);
    if (weights == Weights::kOwn || weights == Weights::kBoth) samples.weight.push_back(1 + 0.5 * std::sin(x));
    if (weights == Weights::kSolidAngle || weights == Weights::kBoth)
      samples.solid_angle.push_back(1 + 0.7 * std::cos(x));
  }
  if (!samples.solid_angle.empty()) recipe.weighting = Weighting::kSolidAngle;
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(samples, recipe);
  const Incidences incidences = GroupByIncidence(measurement);
  ASSERT_EQ(incidences.wi.size(), 5U);
  // Beside the truth, so that some residuals are beyond the loss's scale and some within.
  std::vector<double> u = layout.FromShapes({{0.32, 0.13, 0.07, -0.03, -0.3}});
  for (std::size_t c = 0; c < 3; ++c) {
    u[5 + c] = 0.65 - 0.1 * static_cast<double>(c);
    u[8 + c] = 0.1 - 0.03 * static_cast<double>(c);
  }
  ThreadPool pool(2);
  // At a minimum: elsewhere the second derivatives of a loss that flattens out may bend the cost down.
  if (loss == Loss::kCauchy || loss == Loss::kTukey) u = Solve(problem, layout, u, {}, &pool).u;
  const Uncertainty got = EstimateUncertainty(problem, layout, u, incidences, &pool);
  const Matrix jacobian = layout.ReportJacobian(u.data());
  const Textbook expected = EvaluateTextbook(recipe, layout, samples, incidences, u, jacobian);
  const Matrix hc3 = jacobian * expected.hc3 * jacobian.transpose(),
               cr2 = jacobian * expected.cr2 * jacobian.transpose();
  ASSERT_TRUE(got.determined()) << got.degenerate[0];
  for (Eigen::Index i = 0; i < kSize; ++i) {
    for (Eigen::Index k = 0; k < kSize; ++k) {
      EXPECT_NEAR(got.covariance(i, k), hc3(i, k), 1e-10 * std::sqrt(hc3(i, i) * hc3(k, k))) << i << ' ' << k;
      EXPECT_NEAR(got.clustered(i, k), cr2(i, k), 1e-10 * std::sqrt(cr2(i, i) * cr2(k, k))) << i << ' ' << k;
    }
    const double independent = got.independent_freedom[static_cast<std::size_t>(i)];
    EXPECT_NEAR(independent, expected.hc3_freedom(i), 1e-8 * independent) << i;
    const double freedom = got.freedom[static_cast<std::size_t>(i)];
    EXPECT_NEAR(freedom, expected.freedom(i), 1e-8 * freedom) << i;
  }
}

Incidences GroupsOf(const std::vector<std::uint32_t>& group) {
  return {std::vector<Vec3>(*std::max_element(group.begin(), group.end()) + 1U), group};
}

// Files in which whole incidences lie, and files that share them, against the textbook's sums over each.
TEST(ErrorsByFile, AreTheTextbooksOneWayAndTwo) {
  const Measurement measurement = SixtySamples();
  const Samples& samples = measurement.samples;
  const Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(samples, recipe);
  const Incidences incidences = GroupByIncidence(measurement);
  std::vector<double> u = layout.FromShapes({{0.32, 0.13, 0.07, -0.03, -0.3}});
  for (std::size_t c = 0; c < 3; ++c) {
    u[5 + c] = 0.65 - 0.1 * static_cast<double>(c);
    u[8 + c] = 0.1 - 0.03 * static_cast<double>(c);
  }
  ThreadPool pool(2);
  const Matrix jacobian = layout.ReportJacobian(u.data());
  const auto variances = [&](const Incidences& groups) {
    const Matrix cr2 = EvaluateTextbook(recipe, layout, samples, groups, u, jacobian).cr2;
    return Vector((jacobian * cr2 * jacobian.transpose()).diagonal());
  };
  std::vector<std::uint32_t> nested, crossed, both, within;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint32_t incidence = incidences.group[i];
    nested.push_back(incidence / 2);
    crossed.push_back(static_cast<std::uint32_t>(i % 4));
    both.push_back(4 * incidence + crossed.back());
    within.push_back(2 * incidence + static_cast<std::uint32_t>(i % 2));
  }
  const auto by_file = [&](const std::vector<std::uint32_t>& files) {
    return EstimateErrorsByFile(problem, layout, u, incidences, files, &pool);
  };
  const FileErrors one_way = by_file(nested), two_ways = by_file(crossed);
  const Vector of_nested = variances(GroupsOf(nested)), of_crossed = variances(GroupsOf(crossed)),
               of_both = variances(GroupsOf(both)), of_incidences = variances(incidences);
  const Vector freedom =
      EvaluateTextbook(recipe, layout, samples, GroupsOf(crossed), u, jacobian)
          .freedom.cwiseMin(EvaluateTextbook(recipe, layout, samples, incidences, u, jacobian).freedom);
  ASSERT_EQ(one_way.variance.size(), static_cast<std::size_t>(kSize));
  int sums = 0;
  for (Eigen::Index k = 0; k < kSize; ++k) {
    const auto entry = static_cast<std::size_t>(k);
    EXPECT_NEAR(one_way.variance[entry], of_nested(k), 1e-9 * of_nested(k)) << k;
    const double sum = of_crossed(k) + of_incidences(k) - of_both(k);
    const double expected = std::max({sum, of_crossed(k), of_incidences(k)});
    sums += expected == sum ? 1 : 0;
    EXPECT_NEAR(two_ways.variance[entry], expected, 1e-9 * expected) << k;
    EXPECT_NEAR(two_ways.freedom[entry], freedom(k), 1e-8 * freedom(k)) << k;
  }
  EXPECT_GT(sums, 0) << "the sum of both ways is tried";
  // Files that say nothing that incidences do not.
  EXPECT_TRUE(by_file({}).variance.empty());
  EXPECT_TRUE(by_file(std::vector<std::uint32_t>(samples.size(), 3)).variance.empty());
  EXPECT_TRUE(by_file(incidences.group).variance.empty());
  EXPECT_TRUE(by_file(within).variance.empty());
}

std::string NameOfCase(const testing::TestParamInfo<EveryResidual::ParamType>& info) {
  const char* const weights[] = {"Even", "Own", "SolidAngle", "Both"};
  std::string name = std::string(NameOf(MetricChoices(), std::get<0>(info.param))) + "_" +
                     weights[static_cast<int>(std::get<1>(info.param))] + "_" +
                     NameOf(LossChoices(), std::get<2>(info.param));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryResidual,
    testing::Combine(testing::Values(Metric::kLog, Metric::kCubeRoot, Metric::kRelative, Metric::kCosineL2,
                                     Metric::kNgan, Metric::kLowLog, Metric::kAsinh),
                     testing::Values(Weights::kNone, Weights::kOwn, Weights::kSolidAngle, Weights::kBoth),
                     testing::Values(Loss::kNone, Loss::kHuber, Loss::kCauchy, Loss::kTukey)),
    NameOfCase);

Matrix AsMatrix(const EntryCovariance& covariance) {
  return Matrix::NullaryExpr(covariance.size(), covariance.size(),
                             [&](Eigen::Index i, Eigen::Index k) { return covariance(i, k); });
}

// Every incidence cut at a run's end is put together again; any number of threads adds in the same order.
TEST(Uncertainty, SameBitsOnOneAndEightThreads) {
  GoniometerLayout layout = StandardLayout();
  layout.detector_step = DegreesToRadians(6);
  const Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), layout, 0.1, 5);
  ASSERT_GT(measurement.samples.size(), 4096U);  // several runs
  for (const Loss loss : {Loss::kNone, Loss::kHuber}) {
    Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
    recipe.loss = loss;
    const Layout coordinates(recipe, measurement.channels.names);
    const Problem problem(measurement.samples, recipe);
    const std::vector<double> u = coordinates.FromShapes({{0.3, 0.12, 0.07, -0.03, -0.35}});
    const Incidences incidences = GroupByIncidence(measurement);
    ThreadPool one(1), eight(8);
    const Uncertainty a = EstimateUncertainty(problem, coordinates, u, incidences, &one),
                      b = EstimateUncertainty(problem, coordinates, u, incidences, &eight);
    EXPECT_TRUE(AsMatrix(a.covariance) == AsMatrix(b.covariance));
    EXPECT_TRUE(AsMatrix(a.clustered) == AsMatrix(b.clustered));
    EXPECT_EQ(a.freedom, b.freedom);
  }
}

// The same samples in another order are the same measurement: nothing is lost where an incidence goes over the end of a
// run.
TEST(Uncertainty, DoesNotDependOnTheOrderOfTheSamples) {
  GoniometerLayout layout = StandardLayout();
  layout.detector_step = DegreesToRadians(6);
  Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20), layout, 0.1, 5);
  Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  const Layout coordinates(recipe, measurement.channels.names);
  const std::vector<double> u = coordinates.FromShapes({{0.3, 0.12, 0.07, -0.03, -0.35}});
  ThreadPool pool(2);
  Uncertainty results[2];
  for (Uncertainty& result : results) {
    const Problem problem(measurement.samples, recipe);
    result = EstimateUncertainty(problem, coordinates, u, GroupByIncidence(measurement), &pool);
    std::vector<std::size_t> shuffled;
    for (std::size_t i = 0; i < measurement.samples.size(); ++i)
      shuffled.push_back(i * 7919 % measurement.samples.size());
    measurement.samples = measurement.samples.Subset(shuffled);
  }
  const Matrix covariance = AsMatrix(results[0].covariance), clustered = AsMatrix(results[0].clustered);
  EXPECT_LT((covariance - AsMatrix(results[1].covariance)).norm(), 1e-10 * covariance.norm());
  EXPECT_LT((clustered - AsMatrix(results[1].clustered)).norm(), 1e-10 * clustered.norm());
}

// Of hundreds of channels what two of them share is not kept, and nothing else is another number.
TEST(Uncertainty, WithoutPairsOfChannelsVariancesAreTheSame) {
  GoniometerLayout layout = StandardLayout();
  layout.polar_angles.clear();
  layout.azimuths.clear();
  for (int k = 0; k < 11; ++k) layout.polar_angles.push_back(DegreesToRadians(5.0 * k + 5));
  for (int k = 0; k < 10; ++k) layout.azimuths.push_back(DegreesToRadians(36.0 * k));
  layout.detector_step = DegreesToRadians(20);
  SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 4, -2, 20, {0.6, 0.4, 0.2}, {0.1, 0.2, 0.3});
  const Measurement measurement = Synthetic(truth, layout, 0.1, 5);
  const Incidences incidences = GroupByIncidence(measurement);
  ASSERT_GT(incidences.wi.size(), 100U);  // degrees of freedom by one formula
  Recipe recipe = DefaultRecipe({{Lobe{}}, Diffuse::kLambert}, "test");
  const Layout coordinates(recipe, measurement.channels.names);
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(2);
  const std::vector<double> u =
      Solve(problem, coordinates, coordinates.FromShapes({{0.3, 0.12, 0.07, -0.03, -0.35}}), {}, &pool).u;
  const Uncertainty full = EstimateUncertainty(problem, coordinates, u, incidences, &pool),
                    arrow = EstimateUncertainty(problem, coordinates, u, incidences, &pool, 0);
  ASSERT_TRUE(full.covariance.full());
  ASSERT_FALSE(arrow.covariance.full());
  constexpr Eigen::Index kShape = 5;
  for (Eigen::Index i = 0; i < full.covariance.size(); ++i) {
    const auto entry = static_cast<std::size_t>(i);
    EXPECT_NEAR(arrow.covariance.Variance(i) / full.covariance.Variance(i), 1, 1e-10) << i;
    EXPECT_NEAR(arrow.clustered.Variance(i) / full.clustered.Variance(i), 1, 1e-10) << i;
    EXPECT_NEAR(arrow.freedom[entry] / full.freedom[entry], 1, 1e-10) << i;
    EXPECT_NEAR(arrow.independent_freedom[entry] / full.independent_freedom[entry], 1, 1e-10) << i;
    EXPECT_FALSE(std::isnan(full.covariance(i, 6)));
    EXPECT_EQ(std::isnan(arrow.covariance(i, 6)), i != 6) << i;
    for (Eigen::Index k = 0; k < kShape && i < kShape; ++k) {
      const double unit = std::sqrt(full.clustered.Variance(i) * full.clustered.Variance(k));
      EXPECT_NEAR(arrow.covariance(i, k), full.covariance(i, k), 1e-10 * unit) << i << " " << k;
      EXPECT_NEAR(arrow.clustered(i, k), full.clustered(i, k), 1e-10 * unit) << i << " " << k;
    }
  }
  for (Eigen::Index k = 0; k < full.coordinate_variance.size(); ++k)
    EXPECT_NEAR(arrow.coordinate_variance(k) / full.coordinate_variance(k), 1, 1e-10) << k;
}

}  // namespace
}  // namespace lobefit

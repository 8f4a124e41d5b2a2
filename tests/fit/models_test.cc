// Every choice of the model table, fitted to noise-free data of its own and found again.
#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/core/fresnel/optical_constants.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"

namespace lobefit {
namespace {

// Values for any model: shapes that the NDF has, Fresnel parameters that differ between the two channels.
SyntheticCase TruthOf(const Model& model) {
  SyntheticCase truth;
  truth.model = model;
  truth.channels = {"A", "B"};
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    const Ndf ndf = model.lobes[l].ndf;
    const double alpha = l == 0 ? 0.12 : 0.5;
    const double theta_x = IsTilted(ndf) ? 0.03 : 0, theta_y = IsTilted(ndf) ? -0.05 : 0;
    if (IsRound(ndf)) {
      truth.values.insert(truth.values.end(), {{alpha}, {alpha}, {0}, {0}, {0}});
    } else {
      truth.values.insert(truth.values.end(), {{2 * alpha}, {alpha}, {theta_x}, {theta_y}, {0.4}});
    }
    if (HasExponent(ndf)) truth.values.push_back({2.8});
    if (FamilyOf(ndf) == Family::kProfile) truth.values.insert(truth.values.end(), {{0.5}, {-0.4}, {0.3}});
    switch (model.lobes[l].fresnel) {
      case Fresnel::kSchlick:
        truth.values.push_back({0.5, 0.3});
        break;
      case Fresnel::kConductor:
        truth.values.insert(truth.values.end(), {{0.4, 1.5}, {3.5, 2.5}});
        break;
      case Fresnel::kDielectric:
        truth.values.push_back({1.5, 1.8});
        break;
      case Fresnel::kSchlickF82:
        truth.values.insert(truth.values.end(), {{0.5, 0.3}, {0.8, 0.9}});
        break;
      case Fresnel::kCurve:
        truth.values.insert(truth.values.end(),
                            {{0.9, 0.8}, {0.6, 0.5}, {0.3, 0.2}, {0.25, 0.1}, {0.3, 0.15}, {0.4, 0.2}});
        break;
      case Fresnel::kCoatLayered:
      case Fresnel::kCoatRefracted:
        truth.values.insert(truth.values.end(), {{1.6, 1.6}, {0, 0}});
        break;
      case Fresnel::kNone:
        truth.values.push_back({0.8, 0.4});
        break;
    }
  }
  if (model.diffuse == Diffuse::kInterfaced) truth.values.push_back({1.5, 1.5});
  if (model.diffuse == Diffuse::kOrenNayar) truth.values.push_back({0.6, 0.6});
  if (model.diffuse != Diffuse::kNone) truth.values.push_back({0.2, 0.1});
  return truth;
}

std::vector<Model> EveryChoice() {
  std::vector<Model> models;
  const auto add = [&](const Lobe& lobe, Diffuse diffuse) {
    Model model = {{lobe}, diffuse};
    if (FamilyOf(lobe.ndf) == Family::kProfile) model.lobes[0].grid = GridWithKnots({0, 1, 2, 4});
    if (WhyNotEvaluable(model).empty()) models.push_back(model);
  };
  for (const Choice<Ndf>& ndf : NdfChoices()) {
    if (IsInPlane(ndf.value)) continue;  // in-plane data: fit_test.cc
    Lobe lobe = {ndf.value};
    if (FamilyOf(ndf.value) == Family::kAbg) lobe.masking = Masking::kNone, lobe.fresnel = Fresnel::kNone;
    add(lobe, Diffuse::kLambert);
  }
  Lobe retro = {Ndf::kGgxAnisotropic};
  retro.direction = LobeDirection::kRetro;
  add(retro, Diffuse::kLambert);
  add({Ndf::kGgx}, Diffuse::kInterfaced);
  add({Ndf::kGgx}, Diffuse::kOrenNayar);
  for (const Choice<Masking>& masking : MaskingChoices()) {
    add({Ndf::kGgx, masking.value}, Diffuse::kLambert);
    add({Ndf::kBeckmannOffCenter, masking.value}, Diffuse::kNone);
  }
  for (const Choice<Fresnel>& fresnel : FresnelChoices())
    add({Ndf::kGgxAnisotropic, Masking::kSmithHeight, fresnel.value}, Diffuse::kLambert);
  add({Ndf::kGgx}, Diffuse::kMicrofacet);
  add({Ndf::kBeckmann}, Diffuse::kNone);
  Model two = {{{Ndf::kGgx}, {Ndf::kBeckmann, Masking::kSmithSeparable, Fresnel::kNone}}, Diffuse::kLambert};
  models.push_back(two);
  for (const Fresnel coat : {Fresnel::kCoatLayered, Fresnel::kCoatRefracted}) {
    models.push_back({{{Ndf::kGgx, Masking::kSmithSeparable, coat}, {Ndf::kGgxAnisotropic, Masking::kSmithHeight}},
                      Diffuse::kLambert});
    models.push_back({{{Ndf::kGgx, Masking::kSmithSeparable, coat}, {Ndf::kStudent}}, Diffuse::kNone});
  }
  return models;
}

class EveryModel : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryModel, IsFoundAgain) {
  const Model model = EveryChoice()[GetParam()];
  const SyntheticCase truth = TruthOf(model);
  GoniometerLayout layout = StandardLayout();
  // The last coefficient of a curve acts at grazing angles alone.
  layout.polar_angles = {0.1, 0.4, 0.7, 1.0, model.lobes[0].fresnel == Fresnel::kCurve ? 1.35 : 1.2};
  layout.azimuths = {0, 1.1};
  layout.detector_step = DegreesToRadians(12);
  Measurement measurement = Synthetic(truth, layout, 0, 1);
  FitOptions options;
  options.subsample = 400;
  const Material material = CheckedFit(DefaultRecipe(model, "test"), options, &measurement);
  EXPECT_TRUE(material.termination.converged) << material.termination.message;
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    for (std::size_t c = 0; c < truth.values[i].size(); ++c) {
      const double expected = truth.values[i][c];
      EXPECT_NEAR(material.parameters[i].values[c], expected, 1e-6 * (expected != 0 ? std::fabs(expected) : 1.0))
          << Parameters(model)[i].name << " " << c;
    }
  }
}

// Of data with noise: every minimum on all samples is one within the bounds, with the cost that it states.
TEST_P(EveryModel, EndsWhereNoCoordinateGains) {
  const Model model = EveryChoice()[GetParam()];
  const SyntheticCase truth = TruthOf(model);
  GoniometerLayout goniometer = StandardLayout();
  goniometer.polar_angles = {0.1, 0.6, 1.1};
  goniometer.azimuths = {0, 1.1};
  goniometer.detector_step = DegreesToRadians(15);
  Measurement measurement = Synthetic(truth, goniometer, 0.1, 1);
  const Recipe recipe = DefaultRecipe(model, "test");
  SetAsideForRecipe(recipe, &measurement);
  const Layout layout(recipe, truth.channels);
  const Problem problem(measurement.samples, recipe);
  FitOptions options;
  options.subsample = 300;
  ThreadPool pool(1);
  const std::vector<DistinctMinimum> minima = FindMinima(problem, layout, measurement.samples, options, &pool);
  ASSERT_FALSE(minima.empty());
  EXPECT_TRUE(minima[0].solution.converged) << minima[0].solution.message;
  const BoundedObjective objective = ObjectiveOf(problem, layout, &pool);
  for (const DistinctMinimum& minimum : minima) {
    if (!minimum.on_all_samples) continue;
    const Solution& solution = minimum.solution;
    const Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(solution.u.data(), objective.low.size());
    Eigen::MatrixXd gram;
    Eigen::VectorXd gradient;
    EXPECT_EQ(objective.evaluate(u, &gram, &gradient), solution.cost);
    if (!solution.converged) continue;
    for (Eigen::Index k = 0; k < u.size(); ++k) {
      EXPECT_GE(u(k), objective.low(k));
      EXPECT_LE(u(k), objective.high(k));
      // Masking of tilted lobes has kinks, at which the derivative is one-sided.
      if (IsTilted(model.lobes[0].ndf)) continue;
      const double most = 0.02 / static_cast<double>(objective.residuals);
      if (GainOf(objective, u, solution.cost, gram, gradient, k) <= most) continue;
      // The derivative promises more where the cost bends more than Gauss-Newton knows: what counts is the cost itself.
      for (const double share : {1.0, 0.3, 0.1, 0.03, 0.01}) {
        Eigen::VectorXd moved = u;
        moved(k) = std::clamp(u(k) - share * gradient(k) / gram(k, k), objective.low(k), objective.high(k));
        EXPECT_GE(objective.evaluate(moved, nullptr, nullptr), solution.cost * (1 - most))
            << layout.coordinates()[static_cast<std::size_t>(k)].name << " " << share;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel, testing::Range<std::size_t>(0, EveryChoice().size()),
                         [](const testing::TestParamInfo<std::size_t>& p) {
                           const Model model = EveryChoice()[p.param];
                           std::string name = std::string(NameOf(NdfChoices(), model.lobes[0].ndf)) + "_" +
                                              NameOf(MaskingChoices(), model.lobes[0].masking) + "_" +
                                              NameOf(FresnelChoices(), model.lobes[0].fresnel) + "_" +
                                              NameOf(DiffuseChoices(), model.diffuse) + "_" +
                                              std::to_string(model.lobes.size());
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + "_" + std::to_string(p.param);
                         });

TEST(Metals, AreFixedAtTheirWavelengths) {
  Model model = {{{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kConductor, "Au"}}, Diffuse::kNone};
  SyntheticCase truth = TruthOf(model);
  truth.values[5] = {MetalIndexAt("Au", 450).index.eta, MetalIndexAt("Au", 650).index.eta};
  truth.values[6] = {MetalIndexAt("Au", 450).index.k, MetalIndexAt("Au", 650).index.k};
  Measurement measurement = Synthetic(truth, StandardLayout(), 0, 1);
  Recipe recipe = DefaultRecipe(model, "gold");
  EXPECT_THROW(CheckedFit(recipe, {}, &measurement), InputError);  // no wavelengths
  recipe.wavelengths_nm = {450, 650};
  const Material material = CheckedFit(recipe, {}, &measurement);
  EXPECT_EQ(material.parameters[5].values, truth.values[5]);
  EXPECT_EQ(material.parameters[6].values, truth.values[6]);
  EXPECT_FALSE(material.parameters[5].free);
  EXPECT_NEAR(material.parameters[0].values[0], 0.12, 1e-8);
}

}  // namespace
}  // namespace lobefit

#include "tests/support/checked_fit.h"

#include <algorithm>
#include <cmath>

#include "tests/support/jet_model.h"
#include <gtest/gtest.h>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/measurement/checks/isotropy.h"

namespace lobefit {
namespace {

// The cost of parameter values on the samples of a fit, one sample after the other.
class Cost {
 public:
  Cost(const Recipe& recipe, const Material& material, const Measurement& measurement)
      : model_(material.model), loss_(recipe.loss), scale_(recipe.loss_scale), samples_(measurement.samples) {
    const MetricRow& row = *std::find_if(MetricTable().begin(), MetricTable().end(),
                                         [&](const MetricRow& candidate) { return candidate.name == material.metric; });
    transform_ = TransformOf(row.metric, recipe.noise);
    const bool round = std::all_of(model_.lobes.begin(), model_.lobes.end(),
                                   [](const Lobe& lobe) { return IsRound(lobe.ndf) && !IsTilted(lobe.ndf); });
    if (measurement.isotropic && !measurement.sample_at_rest && !round) samples_ = SpreadOverAzimuths(samples_);
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      double weight = samples_.weight.empty() ? 1 : samples_.weight[i];
      if (material.weighting == "solid-angle") weight *= samples_.solid_angle[i];
      const Vec3 wi = samples_.wi(i), wo = samples_.wo(i);
      if (row.sin_i) weight *= std::hypot(wi.x, wi.y);
      if (row.sin_o) weight *= std::hypot(wo.x, wo.y);
      weight_.push_back(weight);
      sum += weight;
    }
    for (double& weight : weight_) weight *= static_cast<double>(weight_.size()) / sum;
  }

  double At(const ParameterValues& values) const {
    const Reflectance brdf(model_, values, samples_.values.size());
    std::vector<double> f_r(samples_.values.size());
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      brdf.Evaluate(samples_.wi(i), samples_.wo(i), f_r.data());
      double squares = 0;
      for (std::size_t c = 0; c < f_r.size(); ++c) {
        const double r = JetResidual(transform_, f_r[c], samples_.values[c][i], samples_.wi(i));
        squares += weight_[i] * r * r;
      }
      sum += loss_ == Loss::kNone ? squares : EvaluateLoss(loss_, scale_, squares).rho;
    }
    return sum / 2;
  }

  std::size_t residuals() const { return samples_.size() * samples_.values.size(); }

 private:
  Model model_;
  Loss loss_;
  double scale_;
  Samples samples_;
  Transform transform_;
  std::vector<double> weight_;
};

bool IsProfile(const Model& model) {
  return std::any_of(model.lobes.begin(), model.lobes.end(),
                     [](const Lobe& lobe) { return FamilyOf(lobe.ndf) == Family::kProfile; });
}

// The values with one of parameter `index` moved, and what is tied to it; empty where that leaves its bounds.
ParameterValues Moved(const Recipe& recipe, const Material& material, std::size_t index, std::size_t channel,
                      double by) {
  const std::vector<Parameter> table = Parameters(material.model);
  const ParameterRecipe& entry = recipe.parameters[index];
  ParameterValues values = material.Values();
  for (std::size_t c = 0; c < values[index].size(); ++c) {
    if (c != channel && !entry.shared) continue;
    values[index][c] += by;
    if (values[index][c] < entry.low.value_or(table[index].low) ||
        values[index][c] > entry.high.value_or(table[index].high)) {
      return {};
    }
  }
  const std::size_t dot = table[index].name.find("alpha_x");
  if (dot == std::string::npos || material.parameters[index + 1].free) return values;
  std::size_t lobe = 0;
  for (std::size_t k = 0; k < index; ++k) lobe += table[k].name.find("alpha_x") != std::string::npos ? 1 : 0;
  if (IsRound(material.model.lobes[lobe].ndf)) values[index + 1] = values[index];
  return values;
}

// Shapes whose coordinates, not their parameters, have bounds, and hold one.
bool IsHeld(const Material& material, const std::vector<Parameter>& table, std::size_t index) {
  if (table[index].group != ParameterGroup::kShape) return false;
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (table[k].group == ParameterGroup::kShape && material.parameters[k].at_bound) return true;
  }
  return false;
}

void ExpectMinimum(const Recipe& recipe, const Material& material, const Measurement& measurement) {
  const Cost cost(recipe, material, measurement);
  const double at = cost.At(material.Values());
  const bool with_prior = IsProfile(material.model);  // that of its coefficients is part of the document's cost
  // Exact values leave rounding.
  const double rounding = 1e-12 * static_cast<double>(cost.residuals());
  if (with_prior) {
    EXPECT_LE(at, material.cost * (1 + 1e-9) + rounding);
  } else {
    EXPECT_NEAR(at, material.cost, 1e-9 * material.cost + rounding) << "the cost of the parameters";
  }
  const double of_one_residual = 2 * at / static_cast<double>(cost.residuals());
  const std::vector<Parameter> table = Parameters(material.model);
  for (std::size_t p = 0; p < table.size(); ++p) {
    const FittedParameter& fitted = material.parameters[p];
    const bool has_prior = with_prior && table[p].group == ParameterGroup::kShape;
    if (!fitted.free || has_prior || IsHeld(material, table, p)) continue;
    for (std::size_t c = 0; c < fitted.values.size(); ++c) {
      const double error = fitted.standard_error[c];
      const double step = error > 0 ? 0.3 * error : 1e-4 * std::max(std::fabs(fitted.values[c]), 1e-2);
      for (const double by : {-step, step}) {
        const ParameterValues values = Moved(recipe, material, p, c, by);
        if (values.empty()) continue;
        EXPECT_GE(cost.At(values), at - 0.5 * 0.01 * of_one_residual - rounding)
            << table[p].json_name << " of channel " << c << " moved by " << by << " from " << fitted.values[c];
      }
    }
  }
}

}  // namespace

Material CheckedFit(const Recipe& recipe, const FitOptions& options, Measurement* measurement) {
  Material material = Fit(recipe, options, measurement);
  const bool other_cost = material.instrument.has_value() || !measurement->samples.sigma.empty() ||
                          recipe.energy == EnergyChoice::kConserving || (material.metric == "asinh");
  if (material.termination.converged && !other_cost) ExpectMinimum(recipe, material, *measurement);
  return material;
}

}  // namespace lobefit

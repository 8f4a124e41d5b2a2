#include "lobefit/fit/sel/fit.h"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/base/text/text.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/sel/envelope.h"
#include "lobefit/fit/sel/nodes.h"
#include "lobefit/fit/sel/raise.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

constexpr int kSweeps = 2;

// The first few, and that there are more.
std::string Shortened(std::vector<std::string> words) {
  constexpr std::size_t kMost = 5;
  if (words.size() > kMost) {
    words.resize(kMost);
    words.emplace_back("...");
  }
  return Join(words);
}

void DescribeEnd(const std::vector<SelNode>& nodes, Termination* termination) {
  std::size_t unfinished = 0;
  std::vector<std::string> angles;
  for (const SelNode& node : nodes) {
    termination->iterations += node.fit.iterations;
    if (node.fit.converged) continue;
    ++unfinished;
    const SelSlice& slice = node.fit.slice;
    angles.push_back(fmt::format("{:.1f}", RadiansToDegrees(slice.theta_i)));
    if (slice.phi_i != 0) angles.back() += fmt::format("/{:.1f}", RadiansToDegrees(slice.phi_i));
  }
  termination->converged = unfinished == 0;
  termination->determined = true;
  termination->message =
      unfinished == 0
          ? "every incident direction converged"
          : fmt::format("{} of {} incident directions did not converge (theta_i {} degrees); take fewer lobes",
                        unfinished, nodes.size(), Shortened(angles));
}

void DescribeSource(const Recipe& recipe, const Measurement& measurement, Material* material) {
  material->samples_used = measurement.samples.size();
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    if (measurement.set_aside[reason] > 0)
      material->set_aside[std::string(Key(reason))] = measurement.set_aside[reason];
  }
  material->source = {measurement.source, measurement.sha256, measurement.format, measurement.conventions};
  material->recipe_name = recipe.name;
  material->recipe_reason = recipe.reason;
  material->metric = NameOf(MetricChoices(), recipe.metric);
  material->weighting = NameOf(WeightingChoices(), recipe.weighting);
  material->loss = NameOf(LossChoices(), recipe.loss);
  material->theta_max_deg = RadiansToDegrees(recipe.theta_max);
}

void Describe(const Recipe& recipe, const Measurement& measurement, const std::vector<SelNode>& nodes, ThreadPool* pool,
              Material* material) {
  material->channels = measurement.channels.names;
  material->wavelengths_nm = measurement.channels.wavelengths_nm;
  material->model.diffuse = Diffuse::kNone;
  const std::vector<std::vector<double>> f_r = Predict(*material, measurement.samples, pool);
  material->errors = ErrorsUnderAllMetrics(recipe.noise, recipe.weighting, measurement.samples, f_r, pool);
  material->cost =
      SumSquares(recipe.metric, recipe.noise, recipe.weighting, true, measurement.samples, f_r).MeanSquare() *
      static_cast<double>(measurement.samples.size() * f_r.size()) / 2;
  DescribeEnd(nodes, &material->termination);
  material->remarks = measurement.remarks;
  const std::size_t groups = GroupByDirection(measurement, Beam::kLight).wi.size();
  if (groups > nodes.size()) {
    material->remarks.push_back(
        fmt::format("{} of {} incident directions have fewer values than {} lobes have parameters and are left to "
                    "interpolation between the others",
                    groups - nodes.size(), groups, recipe.sel->lobes));
  }
  const auto at_limit =
      std::count_if(nodes.begin(), nodes.end(), [](const SelNode& node) { return node.fit.at_limit; });
  if (at_limit > 0 && !recipe.sel->bound) {
    material->remarks.push_back(fmt::format(
        "{} of {} incident directions have a lobe at the limit of its width, offset or amplitude: fewer lobes "
        "would do there, or the samples do not determine them",
        at_limit, nodes.size()));
  }
  DescribeSource(recipe, measurement, material);
}

}  // namespace

Material FitSel(const Recipe& wanted, const FitOptions& options, Measurement* measurement) {
  const auto start_time = std::chrono::steady_clock::now();
  Material material;
  material.samples_read = measurement->samples.size() + measurement->set_aside.total();
  Recipe recipe = wanted;
  recipe.weighting = EffectiveWeighting(wanted.weighting, measurement->samples);
  SetAsideForRecipe(recipe, measurement);
  if (recipe.weighting == Weighting::kSolidAngle && measurement->samples.solid_angle.empty())
    Problem(measurement->samples, recipe);  // says what is missing
  if (recipe.metric == Metric::kAsinh)
    throw InputError("recipe '" + recipe.name +
                     "': metric 'asinh' is for models; tables of lobes take log or cube-root");
  const SelRecipe& sel = *recipe.sel;
  std::vector<SelNode> nodes = MakeSelNodes(*measurement, recipe);
  JoinNeighbours(&nodes);
  SelSliceOptions slice_options;
  slice_options.transform = TransformOf(recipe.metric, recipe.noise);
  slice_options.quantity = sel.quantity;
  ThreadPool pool(std::max(1, options.threads));
  Progress progress("fitting lobes", nodes.size() * (1 + kSweeps + (sel.bound ? 1 : 0)));

  pool.Run(nodes.size(), [&](std::size_t k) {
    SelNode& node = nodes[k];
    const double theta = PolarAngle(node.wi);
    node.fit = SearchSelSlice(node.fitted, theta, sel.lobes, slice_options);
    node.fit.slice.theta_i = theta;
    node.fit.slice.phi_i = measurement->isotropic ? 0.0 : Azimuth(node.wi);
    node.variance = node.fit.sum_squares / static_cast<double>(node.fitted.size() * node.fitted.channels());
    progress.Advance();
  });
  for (int sweep = 0; sweep < kSweeps; ++sweep) SweepSelNodes(slice_options, sel.drift, &pool, &progress, &nodes);
  if (sel.bound) {
    pool.Run(nodes.size(), [&](std::size_t k) {
      nodes[k].fit.slice = BoundSelSlice(nodes[k].samples, sel.quantity, nodes[k].fit.slice);
      progress.Advance();
    });
  }

  material.sel = SelTable{sel.quantity, measurement->isotropic, sel.bound, {}};
  for (const SelNode& node : nodes) material.sel->slices.push_back(node.fit.slice);
  material.channels = measurement->channels.names;
  if (sel.bound) RaiseAboveSamples(*measurement, &pool, &material);
  Describe(recipe, *measurement, nodes, &pool, &material);
  material.used = {ToToml(wanted), options.starts, options.seed, options.scouting_steps, {}};
  material.timings_s = {{"read", 0.0}, {"report", 0.0}};
  material.timings_s["fit"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time).count();
  return material;
}

}  // namespace lobefit

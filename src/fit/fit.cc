#include "lobefit/fit/fit.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/file_clusters.h"
#include "lobefit/fit/errors/uncertainty.h"
#include "lobefit/fit/found.h"
#include "lobefit/fit/inference/energy_balance.h"
#include "lobefit/fit/inference/misfit.h"
#include "lobefit/fit/inference/noise_bias.h"
#include "lobefit/fit/inference/rivals.h"
#include "lobefit/fit/inference/verdict.h"
#include "lobefit/fit/instrument.h"
#include "lobefit/fit/instrument_report.h"
#include "lobefit/fit/model_report.h"
#include "lobefit/fit/noise_rounds.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/profile_knots.h"
#include "lobefit/fit/sel/fit.h"
#include "lobefit/measurement/checks/isotropy.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The cost of a model that reflects nothing.
double CostOfBlack(const Problem& problem, KernelModel kernel, ThreadPool* pool) {
  for (KernelLobe& lobe : kernel.lobes) {
    lobe.kind.fresnel = Fresnel::kNone;
    lobe.fresnel.assign(kernel.channels, 0.0);
  }
  // The albedo is the last of a channel's diffuse parameters.
  const std::size_t size = DiffuseParameters(kernel.diffuse_kind);
  for (std::size_t k = size; k <= kernel.diffuse.size() && size > 0; k += size) kernel.diffuse[k - 1] = 0;
  return problem.Sum(kernel, false, pool).sum_rho / 2;
}

}  // namespace

MeasurementTraits TraitsOf(const Measurement& measurement) {
  MeasurementTraits traits;
  traits.isotropic = measurement.isotropic && !measurement.sample_at_rest;
  traits.samples = measurement.samples.size();
  // Isotropic tables are stored with the half vector in one plane, but their samples are not in a plane of incidence.
  const std::optional<double> plane = PlaneAzimuth(measurement.samples);
  traits.in_plane = !measurement.isotropic && plane;
  if (traits.in_plane) traits.plane_azimuth = *plane;
  return traits;
}

std::optional<Recipe> AutomaticAlternative(const Recipe& recipe, const Material& material) {
  if (recipe.model.lobes.size() != 1 || recipe.model.lobes[0].ndf != Ndf::kGgxTilted ||
      recipe.model.lobes[0].fresnel != Fresnel::kSchlick) {
    return std::nullopt;
  }
  const std::size_t f0 = 5;
  bool above = false;
  for (const double value : material.parameters[f0].values) above = above || value >= 1 - 1e-6;
  if (!above) return std::nullopt;
  Recipe alternative = recipe;
  alternative.name = "ggx-tilted-scaled";
  alternative.model.lobes[0].fresnel = Fresnel::kNone;
  alternative.reason = recipe.reason +
                       "; the lobe's width across the plane is not seen, and with equal widths f0 would exceed 1, so "
                       "the reflectance and that "
                       "width enter as one free scale";
  return alternative;
}

Material Fit(const Recipe& wanted, const FitOptions& options, Measurement* measurement) {
  const auto start_time = std::chrono::steady_clock::now();
  if (const std::string why = WhyNotEvaluable(wanted.model); !why.empty())
    throw InputError("recipe '" + wanted.name + "': " + why);
  Recipe recipe = WithMetals(wanted, measurement->channels.wavelengths_nm, measurement->channels.names.size());
  recipe = ThroughInstrument(recipe, *measurement);
  if (recipe.noise.IsKnown() && !recipe.metric_given) {
    recipe.metric = Metric::kAsinh;
    recipe.noise = NoiseForAsinh(recipe.noise);
  }
  recipe.weighting = EffectiveWeighting(recipe.weighting, measurement->samples);
  const std::size_t read = measurement->samples.size() + measurement->set_aside.total();
  SetAsideForRecipe(recipe, measurement);
  if (const std::optional<double> plane = PlaneAzimuth(measurement->samples); plane && !measurement->isotropic)
    recipe.plane_azimuth = *plane;
  bool any_azimuth = true;
  for (const Lobe& lobe : recipe.model.lobes) any_azimuth = any_azimuth && IsRound(lobe.ndf) && !IsTilted(lobe.ndf);
  Samples spread;
  if (measurement->isotropic && !measurement->sample_at_rest && !any_azimuth)
    spread = SpreadOverAzimuths(measurement->samples);
  const Samples& samples = spread.size() > 0 ? spread : measurement->samples;
  ThreadPool pool(std::max(1, options.threads));
  recipe = WithKnots(recipe, samples, measurement->channels.names, options, &pool);
  const Incidences incidences = GroupByIncidence(*measurement);
  std::vector<std::string> remarks = measurement->remarks;
  if (recipe.noise.IsKnown() && recipe.metric != Metric::kAsinh)
    remarks.push_back(std::string("the noise that is stated weighs nothing under metric ") + RowOf(recipe.metric).name +
                      "; metric asinh takes it");
  const auto search_time = std::chrono::steady_clock::now();
  // Tables with cells of known size are computed from readings; rows of a goniometer are readings.
  const bool readings = samples.solid_angle.empty() && spread.size() == 0;
  const std::unique_ptr<Found> found =
      FindUnderNoise({*measurement, samples, incidences, readings}, options, &pool, &recipe, &remarks);
  const double solve_s = SecondsSince(search_time);
  const Layout& layout = found->layout;
  const Problem& problem = found->problem;
  const std::vector<DistinctMinimum>& minima = found->minima;
  const Uncertainty& uncertainty = found->uncertainty;

  const Solution& best = minima[0].solution;
  Material material;
  material.model = recipe.model;
  material.channels = measurement->channels.names;
  material.wavelengths_nm = measurement->channels.wavelengths_nm;
  material.degenerate = uncertainty.degenerate;
  ReportParameters(layout, best.u, uncertainty, &material);
  FlagUndeterminedProfiles(problem, layout, best.u, samples, &pool, &material);
  const bool has_rival = FlagRivals(problem, layout, samples, minima, &pool, &material);
  material.remarks.insert(material.remarks.begin(), remarks.begin(), remarks.end());
  ReportByFile(EstimateErrorsByFile(problem, layout, best.u, incidences, measurement->samples.file, &pool), &material);
  material.misfit = TestMisfit(problem, layout, best.u, samples, incidences);
  if (material.misfit->flagged) material.remarks.push_back(ToRemark(*material.misfit));
  ReportInstrument(problem, layout, best.u, uncertainty, incidences, found->last, &pool, &material);
  material.samples_read = read;
  material.samples_used = samples.size();
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    if (measurement->set_aside[reason] > 0)
      material.set_aside[std::string(Key(reason))] = measurement->set_aside[reason];
  }
  const KernelModel kernel = layout.ToKernel(best.u.data());
  material.errors = ErrorsUnderAllMetrics(
      recipe.noise, recipe.weighting, samples,
      [&](std::size_t begin, std::size_t end, std::vector<std::vector<double>>* f_r) {
        ModelValues(problem.kernel_samples(), kernel, begin, end, f_r);
      },
      &pool);
  material.cost = best.cost;
  for (const DistinctMinimum& minimum : minima) material.minima.push_back(Describe(layout, minimum));
  // Values that are noise about zero, or zero, fit any lobe of no height.
  constexpr double kLeastExplained = 0.1;
  const double black = CostOfBlack(problem, kernel, &pool);
  const double explained = black > 0 ? 1 - best.cost / black : 0.0;
  if (explained < kLeastExplained) {
    material.degenerate.push_back(fmt::format(
        "everything: the model explains {:.1f} % of the measurement's squares, no more than noise about zero "
        "would leave it; are these values of a sample?",
        100 * std::max(0.0, explained)));
  }
  material.verdict = JudgeFit(problem, layout, best.u, samples, incidences, explained, material.misfit->flagged, &pool);
  material.energy = EnergyBalance{};
  material.energy->absolute = !recipe.free_scale;
  if (!recipe.free_scale) {
    material.energy = BalanceAt(SpreadIncidences(incidences, recipe.theta_max), recipe.model, material.Values(),
                                material.channels, &pool);
    JudgeEnergy(*material.energy, &*material.verdict);
    constexpr std::size_t kShown = 8;
    material.scatter = ScatterOfAbg(SpreadIncidences(incidences, recipe.theta_max, kShown), recipe.model,
                                    material.Values(), material.channels.size());
  }
  material.termination = {best.converged,
                          DeterminedButForCurves(uncertainty, layout) && !has_rival && !(explained < kLeastExplained),
                          best.message, best.iterations};
  material.source = {measurement->source, measurement->sha256, measurement->format, measurement->conventions};
  material.recipe_name = recipe.name;
  material.recipe_reason = recipe.reason;
  material.metric = NameOf(MetricChoices(), recipe.metric);
  material.weighting = NameOf(WeightingChoices(), recipe.weighting);
  material.loss = NameOf(LossChoices(), recipe.loss);
  material.theta_max_deg = RadiansToDegrees(recipe.theta_max);
  material.used = {ToToml(wanted), options.starts, options.seed, options.scouting_steps, {}};
  // "solve" is the part of "fit" that searches and descends.
  material.timings_s = {{"read", 0.0}, {"solve", solve_s}, {"fit", SecondsSince(start_time)}, {"report", 0.0}};
  return material;
}

Material FitRecipe(const Recipe& recipe, const FitOptions& options, Measurement* measurement) {
  return recipe.sel ? FitSel(recipe, options, measurement) : Fit(recipe, options, measurement);
}

}  // namespace lobefit

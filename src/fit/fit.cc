#include "lobefit/fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <Eigen/QR>
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/inference/energy_balance.h"
#include "lobefit/fit/inference/file_clusters.h"
#include "lobefit/fit/inference/misfit.h"
#include "lobefit/fit/inference/noise_bias.h"
#include "lobefit/fit/inference/outlier_pull.h"
#include "lobefit/fit/inference/rivals.h"
#include "lobefit/fit/inference/uncertainty.h"
#include "lobefit/fit/inference/verdict.h"
#include "lobefit/fit/instrument.h"
#include "lobefit/fit/instrument_report.h"
#include "lobefit/fit/keep_energy.h"
#include "lobefit/fit/last_descent.h"
#include "lobefit/fit/objective/coordinates.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/profile_knots.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/sel/fit.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/checks/isotropy.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/prepare/noise.h"

namespace lobefit {
namespace {

// Flattened entry names of Layout::Report: "alpha_x", "f0[R]".
std::vector<std::string> EntryNames(const std::vector<Parameter>& parameters,
                                    const std::vector<std::string>& channels) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    if (!parameter.per_channel) names.push_back(parameter.json_name);
    for (std::size_t c = 0; parameter.per_channel && c < channels.size(); ++c)
      names.push_back(parameter.json_name + "[" + channels[c] + "]");
  }
  return names;
}

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double SquareRoot(double variance) { return variance > 0 ? std::sqrt(variance) : kNan; }

// Angles that are not determined because two alphas agree within the error; their intervals would mean nothing.
void FlagEqualAlphas(const Eigen::MatrixXd& covariance, std::size_t first, Eigen::Index row, const std::string& prefix,
                     Material* material) {
  FittedParameter* p = material->parameters.data() + first;
  if (!p[0].free || !p[1].free || !p[4].free) return;
  const double gap = p[0].values[0] - p[1].values[0];
  const double variance = covariance(row, row) + covariance(row + 1, row + 1) - 2 * covariance(row, row + 1);
  const double sigmas = std::isfinite(variance) && variance > 0 ? gap / std::sqrt(variance) : 0.0;
  if (sigmas >= 2) return;
  p[4].standard_error = p[4].standard_error_clustered = p[4].freedom = {kNan};
  material->degenerate.push_back(
      fmt::format("{}theta_z: {}alpha_x and {}alpha_y agree within {:.1f} sigma, so the axes have no direction", prefix,
                  prefix, prefix, sigmas));
}

// Numbers of which a document holds the covariance: 400 take 6 MB. Their square would be 160 MB of 800 channels.
constexpr std::size_t kMostCovariances = 400;

// Parameters, errors and covariance in outside terms.
void Report(const Layout& layout, const std::vector<double>& u, const Uncertainty& uncertainty, Material* material) {
  const Recipe& recipe = layout.recipe();
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  const ParameterValues values = layout.Report(u.data());
  const Eigen::MatrixXd jacobian = layout.ReportJacobian(u.data());
  const Eigen::MatrixXd& covariance = uncertainty.covariance;
  const Eigen::MatrixXd& clustered = uncertainty.clustered;
  std::vector<Eigen::Index> free_rows;
  std::vector<double> factors;
  const std::vector<std::string> names = EntryNames(parameters, material->channels);
  const bool drift_estimated = recipe.instrument.drift && !recipe.instrument.drift->sd;
  Eigen::Index row = 0;
  std::size_t linear_seen = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    FittedParameter fitted;
    fitted.values = values[i];
    fitted.free = recipe.IsFree(i);
    const bool shape = parameters[i].group == ParameterGroup::kShape;
    for (std::size_t c = 0; c < values[i].size(); ++c, ++row) {
      fitted.standard_error.push_back(fitted.free ? SquareRoot(covariance(row, row)) : kNan);
      fitted.standard_error_clustered.push_back(
          fitted.free && uncertainty.has_clusters ? SquareRoot(clustered(row, row)) : kNan);
      fitted.freedom.push_back(std::isnan(fitted.standard_error_clustered.back())
                                   ? kNan
                                   : uncertainty.freedom[static_cast<std::size_t>(row)]);
      if (drift_estimated)
        fitted.independent_freedom.push_back(uncertainty.independent_freedom[static_cast<std::size_t>(row)]);
      if (fitted.free) {
        free_rows.push_back(row);
        factors.push_back(1 / InsideFactor(parameters[i]));
        const int index = shape ? -1 : layout.linear(c)[linear_seen].index;
        fitted.at_bound = fitted.at_bound || (index >= 0 && uncertainty.at_bound[static_cast<std::size_t>(index)]);
      }
    }
    if (!shape) ++linear_seen;
    if (shape && fitted.free) {
      // A shape coordinate held at a bound marks the parameters that depend on it.
      for (std::size_t k = 0; k < layout.shape_size(); ++k) {
        const double dependence = jacobian(row - 1, static_cast<Eigen::Index>(k));
        fitted.at_bound =
            fitted.at_bound || (uncertainty.at_bound[k] && (std::isnan(dependence) || std::fabs(dependence) > 1e-9));
      }
    }
    material->parameters.push_back(fitted);
  }
  Eigen::Index first_row = 0;
  for (std::size_t l = 0; l < recipe.model.lobes.size(); ++l) {
    const auto theta_z = static_cast<std::size_t>(first_row) + 4;
    if (!uncertainty.undetermined[theta_z]) {
      FlagEqualAlphas(covariance, FirstParameter(recipe.model, l), first_row,
                      l == 0 ? "" : fmt::format("lobe{}.", l + 1), material);
    }
    const KernelModel kernel = layout.ToKernel(u.data());
    const OffCenter off_center = OffCenterFromSlopeCoordinates(kernel.lobes[l].shape.slope);
    const double ax = std::sqrt(off_center.q11), ay = std::sqrt(off_center.q22);
    first_row += static_cast<Eigen::Index>(ShapeParameters(recipe.model.lobes[l]) +
                                           FresnelParameters(recipe.model.lobes[l].fresnel) * layout.channels());
    material->slope_space.push_back({off_center.slope_x, off_center.slope_y, ax, ay, off_center.q12 / (ax * ay)});
  }
  if (free_rows.size() > kMostCovariances) {
    material->remarks.push_back(fmt::format(
        "the covariance of {} numbers is too large for the document: it holds that of the shapes; each number "
        "has its standard error",
        free_rows.size()));
    std::vector<Eigen::Index> of_shapes;
    std::vector<double> their_factors;
    for (std::size_t a = 0; a < free_rows.size(); ++a) {
      if (names[static_cast<std::size_t>(free_rows[a])].ends_with(']')) continue;  // of one channel
      of_shapes.push_back(free_rows[a]);
      their_factors.push_back(factors[a]);
    }
    free_rows.swap(of_shapes);
    factors.swap(their_factors);
  }
  for (std::size_t a = 0; a < free_rows.size(); ++a) {
    material->covariance_names.push_back(names[static_cast<std::size_t>(free_rows[a])]);
    for (std::size_t b = 0; b < free_rows.size(); ++b) {
      material->covariance.push_back(covariance(free_rows[a], free_rows[b]) * factors[a] * factors[b]);
      if (uncertainty.has_clusters)
        material->covariance_clustered.push_back(clustered(free_rows[a], free_rows[b]) * factors[a] * factors[b]);
    }
  }
}

// Errors by file, and a remark where they are larger than those by incidence.
void ReportByFile(const FileErrors& errors, Material* material) {
  if (errors.variance.empty()) return;
  constexpr double kMuchLarger = 1.25;
  const std::vector<Parameter> parameters = Parameters(material->model);
  std::size_t row = 0;
  double largest = 0, freedom = 0;
  std::string of;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    FittedParameter& fitted = material->parameters[i];
    for (std::size_t c = 0; c < fitted.values.size(); ++c, ++row) {
      const bool has_error =
          fitted.free && !std::isnan(fitted.standard_error[std::min(c, fitted.standard_error.size() - 1)]);
      const double clustered = fitted.standard_error_clustered[std::min(c, fitted.standard_error_clustered.size() - 1)];
      // Those by incidence hold what the noise biases the metric by.
      const double error = has_error ? std::max(SquareRoot(errors.variance[row]), clustered) : kNan;
      const double ratio = error / clustered;
      fitted.standard_error_by_file.push_back(error);
      fitted.freedom_by_file.push_back(std::isnan(error) ? kNan : errors.freedom[row]);
      if (!(ratio > largest) || std::isinf(ratio)) continue;
      largest = ratio;
      of = parameters[i].json_name;
      freedom = errors.freedom[row];
    }
  }
  if (largest <= kMuchLarger) return;
  material->remarks.push_back(
      fmt::format("taking the samples of one file as dependent too makes standard errors up to {:.2g} times as large "
                  "(of {}, with {:.2g} degrees of freedom): stderr_by_file of the document",
                  largest, of, freedom));
}

// Coefficients of which the prior knows more than the samples: their posterior variance is more than half its own.
void FlagUndeterminedProfiles(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                              ThreadPool* pool, Material* material) {
  constexpr double kMostShare = 0.5;
  const std::vector<Coordinate>& coordinates = layout.coordinates();
  if (std::none_of(coordinates.begin(), coordinates.end(), [](const Coordinate& c) { return c.prior > 0; })) return;
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  const double cost = Linearise(problem, layout, u.data(), pool, &hessian, &gradient);
  const double square = 2 * cost / static_cast<double>(problem.size() * problem.channels());
  const Eigen::MatrixXd covariance = square * hessian.completeOrthogonalDecomposition().pseudoInverse();
  const std::vector<Parameter> parameters = Parameters(material->model);
  for (std::size_t l = 0; l < material->model.lobes.size(); ++l) {
    const Lobe& lobe = material->model.lobes[l];
    if (FamilyOf(lobe.ndf) != Family::kProfile) continue;
    const std::size_t first = FirstParameter(material->model, l) + kEllipseParameters;
    for (std::size_t k = 0; first + k < FirstFresnel(material->model, l); ++k) {
      FittedParameter& fitted = material->parameters[first + k];
      for (std::size_t i = 0; i < coordinates.size(); ++i) {
        if (coordinates[i].name != parameters[first + k].name) continue;
        const auto at = static_cast<Eigen::Index>(i);
        if (!(covariance(at, at) * coordinates[i].prior > kMostShare)) continue;
        fitted.standard_error = fitted.standard_error_clustered = {kNan};
        const double from = GridOf(lobe)->spline()->FirstRadius(k);
        material->degenerate.push_back(fmt::format(
            "{}: the density {} {:g} alphas is not determined by these samples; it is held near GGX's",
            parameters[first + k].name, from > 0 ? "beyond" : "from the mean slope on, within", from > 0 ? from : 1.0));
      }
    }
  }
}

// Coefficients of a free Fresnel curve at angles that were not measured change nothing that was: they are named, and
// the rest is determined without them.
bool DeterminedButForCurves(const Uncertainty& uncertainty, const Layout& layout) {
  if (uncertainty.determined()) return true;
  const Model& model = layout.recipe().model;
  std::vector<bool> curve(Parameters(model).size());
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    if (model.lobes[l].fresnel != Fresnel::kCurve) continue;
    const auto first = curve.begin() + static_cast<std::ptrdiff_t>(FirstFresnel(model, l));
    std::fill_n(first, FresnelParameters(Fresnel::kCurve), true);
  }
  std::size_t entry = 0;
  const std::vector<Parameter> parameters = Parameters(model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (std::size_t c = 0; c < (parameters[i].per_channel ? layout.channels() : 1); ++c, ++entry) {
      if (uncertainty.undetermined[entry] && !curve[i]) return false;
    }
  }
  return true;
}

Minimum Describe(const Layout& layout, const DistinctMinimum& minimum) {
  Minimum described;
  described.cost = minimum.solution.cost;
  described.starts = minimum.starts;
  const std::vector<Parameter> parameters = Parameters(layout.recipe().model);
  const ParameterValues values = layout.Report(minimum.solution.u.data());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].group == ParameterGroup::kShape) {
      described.parameters.emplace_back(parameters[i].json_name, values[i][0] / InsideFactor(parameters[i]));
    }
  }
  return described;
}

// A recipe's search on all samples, and what it found.
struct Found {
  Found(const Recipe& recipe, const Measurement& measurement, const Samples& samples, const Incidences& incidences,
        const FitOptions& options, ThreadPool* pool)
      : layout(WithoutLastDescent(recipe), measurement.channels.names), problem(samples, recipe) {
    if (samples.size() * layout.channels() < layout.size()) {
      throw InputError(
          fmt::format("{}: {} usable samples in {} channels are fewer than the {} free parameters of recipe '{}'; use "
                      "a simpler recipe",
                      measurement.source, samples.size(), layout.channels(), layout.size(), recipe.name));
    }
    minima = FindMinima(problem, layout, samples, options, pool);
    RefineRules(problem, measurement.channels.names, &layout, &minima, pool);
    DescendReweighted(layout, pool, &problem, &minima);
    last = DescendLast(recipe, measurement.channels.names, incidences, &layout, &problem, &minima, pool);
    if (minima.empty()) {
      throw InputError(measurement.source +
                       ": no start of the fit has a finite cost; look at the values with `lobefit info`");
    }
    energy = KeepEnergy(recipe, layout, incidences, measurement.channels.names, &problem, &minima, pool);
    uncertainty = EstimateUncertainty(problem, layout, best().u, incidences, pool);
  }
  const Solution& best() const { return minima[0].solution; }

  Layout layout;
  Problem problem;
  std::vector<DistinctMinimum> minima;
  LastDescent last;
  std::unique_ptr<EnergyRule> energy;
  Uncertainty uncertainty;
};

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
  const auto search_time = std::chrono::steady_clock::now();
  // Noise is estimated from a fit's residuals: first under a metric that takes every value.
  const bool needs_noise = recipe.metric == Metric::kAsinh && !recipe.noise.IsKnown();
  if (needs_noise) recipe.metric = Metric::kCubeRoot;
  std::optional<Found> found;
  found.emplace(recipe, *measurement, samples, incidences, options, &pool);
  // Tables with cells of known size are computed from readings; rows of a goniometer are readings.
  const bool readings = samples.solid_angle.empty() && spread.size() == 0;
  if (readings || needs_noise) {
    const auto predict = [&] {
      return PredictNoiseBias(found->layout, found->best().u, found->uncertainty.of_coordinates, samples, incidences,
                              &pool);
    };
    std::optional<NoiseBias> bias = predict();
    const bool may = needs_noise || (!recipe.metric_given && recipe.metric == Recipe().metric);
    if (needs_noise && !bias) {
      throw InputError(
          measurement->source +
          ": metric 'asinh' takes its knee from the noise of the values, and they show none that can be told "
          "from the model; use --metric log or cube-root");
    }
    // Where only the magnitudes of noise about zero were kept, no metric helps.
    if (bias && may && (needs_noise || (WantsAsinh(*bias) && !FindRectifiedNoise(*measurement)))) {
      const Metric before = recipe.metric;
      recipe.metric = Metric::kAsinh;
      // A fit that the noise has biased leaves residuals that look like noise of the value: that of the new fit tells
      // better.
      constexpr int kMostRounds = 4;
      std::optional<NoiseBias> again;
      for (int round = 0; round < kMostRounds; ++round) {
        recipe.noise = NoiseForAsinh(bias->noise);
        found.emplace(recipe, *measurement, samples, incidences, options, &pool);
        again = predict();
        if (!again || IsNear(NoiseForAsinh(again->noise), recipe.noise) || round + 1 == kMostRounds) break;
        bias->noise = again->noise;
      }
      if (!needs_noise) remarks.push_back(ToSwitchRemark(*bias, before));
      bias = again;
    }
    if (bias) {
      AddBias(*bias, found->layout, found->best().u, &found->uncertainty);
      const bool chosen = recipe.metric_given || recipe.loss != Loss::kNone;
      const std::string remark = chosen ? ToBiasRemark(*bias, recipe.metric, recipe.loss) : "";
      if (!remark.empty()) remarks.push_back(remark);
      const std::optional<OutlierPull> pull =
          PullOfOutliers(found->problem, found->layout, found->best().u, found->uncertainty, bias->noise, &pool);
      if (pull) {
        std::string of_outliers = ToPullRemark(*pull, recipe.loss, recipe.loss_scale);
        if (!of_outliers.empty()) remarks.push_back(std::move(of_outliers));
      }
    }
  }
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
  Report(layout, best.u, uncertainty, &material);
  FlagUndeterminedProfiles(problem, layout, best.u, &pool, &material);
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

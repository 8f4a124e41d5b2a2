#include "lobefit/fit/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/starts.h"
#include "lobefit/fit/sel/slice.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

double Seconds(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Measurement Part(const Measurement& measurement, const std::vector<std::size_t>& indices) {
  Measurement part;
  part.channels = measurement.channels;
  part.isotropic = measurement.isotropic;
  part.sample_at_rest = measurement.sample_at_rest;
  part.format = measurement.format;
  part.source = measurement.source;
  part.samples = measurement.samples.Subset(indices);
  return part;
}

// Root mean square of the measured values under the metric: the error of a model that is black everywhere.
double ErrorOfBlack(const Comparison& comparison, const Samples& samples) {
  if (comparison.metric == Metric::kRelative) return 1;
  const std::vector<std::vector<double>> black(samples.values.size(), std::vector<double>(samples.size()));
  return std::sqrt(SumSquares(comparison.metric, {}, comparison.weighting, true, samples, black).MeanSquare());
}

// Fits and held-out parts of one fold.
struct Fold {
  Measurement training, test;
};

std::vector<Fold> MakeFolds(const Measurement& measurement, const CompareOptions& options, Comparison* comparison) {
  const Incidences incidences = GroupByIncidence(measurement);
  comparison->incidences = incidences.wi.size();
  comparison->folds = std::min(options.folds, incidences.wi.size());
  if (comparison->folds < 2) {
    comparison->folds = 0;
    comparison->remarks.push_back(
        incidences.wi.size() < 2
            ? "the measurement has one incident direction, so none can be held out: there is no held-out error"
            : "no folds were asked for: there is no held-out error");
    return {};
  }
  const std::vector<std::size_t> dealt = DealFolds(incidences.wi.size(), comparison->folds, options.fit.seed);
  const std::vector<std::size_t> chosen =
      StratifiedSubsample(measurement.samples.size(), options.fold_samples, options.fit.seed);
  comparison->held_out_samples = chosen.size();
  if (measurement.isotropic)
    comparison->remarks.emplace_back("the table is isotropic: its incident directions are bins of one degree");
  std::vector<Fold> folds(comparison->folds);
  for (std::size_t k = 0; k < folds.size(); ++k) {
    std::vector<std::size_t> training, test;
    for (const std::size_t i : chosen) (dealt[incidences.group[i]] == k ? test : training).push_back(i);
    folds[k] = {Part(measurement, training), Part(measurement, test)};
  }
  return folds;
}

void FitAll(const Recipe& wanted, const CompareOptions& options, Metric judge, Measurement* measurement, Recipe* used,
            JudgedModel* model) {
  const auto start = std::chrono::steady_clock::now();
  Recipe recipe = wanted;
  recipe.metric_given = true;  // that of one fold must not differ from another's
  if (recipe.metric != judge) {
    model->remarks.push_back(fmt::format("is fitted under metric {} and judged under {}, which it does not minimise",
                                         RowOf(recipe.metric).name, RowOf(judge).name));
  }
  *used = WithMetals(recipe, measurement->channels.wavelengths_nm, measurement->channels.size());
  model->material = FitRecipe(recipe, options.fit, measurement);
  // A reason says that the recipe was chosen automatically.
  if (!recipe.reason.empty() && !recipe.sel) {
    if (const std::optional<Recipe> alternative = AutomaticAlternative(recipe, model->material)) {
      *used = *alternative;
      model->material = Fit(*used, options.fit, measurement);
    }
  }
  model->fit_s = Seconds(start);
  model->name = used->name;
  model->free_parameters =
      used->sel ? model->material.sel->slices.size() * SelFreeParameters(used->sel->lobes, measurement->channels.size())
                : Layout(*used, measurement->channels.names).size();
}

// f_r of the model at the samples, [channel][sample].
std::vector<std::vector<double>> PredictModel(const JudgedModel& model, const Samples& samples, ThreadPool* pool) {
  if (!model.brdf) return Predict(model.material, samples, pool);
  const std::size_t channels = samples.values.size(), count = samples.size();
  std::vector<std::vector<double>> f_r(channels, std::vector<double>(count));
  constexpr std::size_t kPiece = 1024;
  pool->Run((count + kPiece - 1) / kPiece, [&](std::size_t piece) {
    std::vector<double> values(channels);
    for (std::size_t i = piece * kPiece; i < std::min(count, (piece + 1) * kPiece); ++i) {
      model.brdf(samples.wi(i), samples.wo(i), values.data());
      for (std::size_t c = 0; c < channels; ++c) f_r[c][i] = values[c];
    }
  });
  return f_r;
}

// Errors on all samples, and the information criteria of fitted models.
void Judge(const Comparison& comparison, const Measurement& measurement, double black, ThreadPool* pool,
           JudgedModel* model) {
  const Samples& samples = measurement.samples;
  const std::vector<std::vector<double>> f_r = PredictModel(*model, samples, pool);
  model->errors = ErrorsUnderAllMetrics({}, comparison.weighting, samples, f_r, pool);
  const double mean_square = SumSquares(comparison.metric, {}, comparison.weighting, true, samples, f_r).MeanSquare();
  const double floor = 1e-12 * black;
  const double n = static_cast<double>(comparison.residuals), k = static_cast<double>(model->free_parameters) + 1;
  const double deviance = n * std::log(std::max(mean_square, floor * floor));
  model->aic = deviance + 2 * k;
  model->bic = deviance + k * std::log(n);
}

// One model on one fold: NaN and a remark where the rest cannot be fitted.
struct FoldResult {
  SquareSum sum;
  double seconds = 0;
  std::string remark;
};

FoldResult RunFold(const Comparison& comparison, const Fold& fold, const Recipe* recipe, const FitOptions& options,
                   const JudgedModel& given) {
  FoldResult result;
  const auto start = std::chrono::steady_clock::now();
  ThreadPool alone(1);
  try {
    Measurement training = fold.training;
    JudgedModel model = given;
    if (recipe != nullptr) model.material = FitRecipe(*recipe, options, &training);
    result.sum = SumSquares(comparison.metric, {}, comparison.weighting, true, fold.test.samples,
                            PredictModel(model, fold.test.samples, &alone));
  } catch (const InputError& error) {
    result.remark = error.what();
  }
  result.seconds = Seconds(start);
  return result;
}

// Index of the eligible model with the least `value`.
template <class Value>
std::size_t Least(const std::vector<std::size_t>& eligible, const Value& value) {
  return *std::min_element(eligible.begin(), eligible.end(),
                           [&](std::size_t a, std::size_t b) { return value(a) < value(b); });
}

std::vector<std::size_t> Eligible(const Comparison& comparison) {
  std::vector<std::size_t> sound, any;
  const bool only_lobes = std::all_of(comparison.models.begin(), comparison.models.end(),
                                      [](const JudgedModel& m) { return !m.fitted || m.material.sel.has_value(); });
  for (std::size_t m = 0; m < comparison.models.size(); ++m) {
    const JudgedModel& model = comparison.models[m];
    if (!model.fitted || (model.material.sel && !only_lobes)) continue;
    any.push_back(m);
    const bool judged = comparison.folds == 0 || std::isfinite(model.held_out);
    if (model.material.termination.converged && model.material.termination.determined && judged) sound.push_back(m);
  }
  return sound.empty() ? any : sound;
}

double MeanOverFolds(const JudgedModel& model) {
  return std::accumulate(model.fold_mean_square.begin(), model.fold_mean_square.end(), 0.0) /
         static_cast<double>(model.fold_mean_square.size());
}

void RecommendByBic(const std::vector<std::size_t>& eligible, Comparison* comparison) {
  comparison->recommended = Least(eligible, [&](std::size_t m) { return comparison->models[m].bic; });
  comparison->reason = fmt::format(
      "{} has the least BIC; without held-out directions that is all there is to go by, and it takes neighbouring "
      "samples for independent",
      comparison->models[comparison->recommended].name);
}

// Mean and standard error over folds of the difference to the best model.
void SetExcess(const JudgedModel& best, JudgedModel* model) {
  const std::size_t folds = best.fold_mean_square.size();
  const auto n = static_cast<double>(folds);
  model->excess = MeanOverFolds(*model) - MeanOverFolds(best);
  double square = 0;
  for (std::size_t k = 0; k < folds; ++k) {
    const double d = model->fold_mean_square[k] - best.fold_mean_square[k] - model->excess;
    square += d * d;
  }
  model->excess_error = std::sqrt(square / (n - 1) / n);
}

// Lobes of each incident direction stand beside the models to show what no model describes: said where they predict
// better than the model that is recommended.
std::string LobesBelow(const std::vector<JudgedModel>& models, double held_out) {
  for (const JudgedModel& model : models) {
    if (!model.fitted || !model.material.sel || !(model.held_out < 0.95 * held_out)) continue;
    return fmt::format(
        "; the lobes of {} have {:.3g}, so {:.0f} % of the model's error is structure that no model here fits",
        model.name, model.held_out, 100 * (1 - model.held_out / held_out));
  }
  return "";
}

void RecommendByFolds(const std::vector<std::size_t>& eligible, double black, Comparison* comparison) {
  std::vector<JudgedModel>& models = comparison->models;
  const std::size_t best = Least(eligible, [&](std::size_t m) { return MeanOverFolds(models[m]); });
  for (JudgedModel& model : models) SetExcess(models[best], &model);
  const double least = MeanOverFolds(models[best]);
  const auto tolerance = [&](const JudgedModel& model) {
    return std::max({model.excess_error, kWorthNothing * least, kRounding * kRounding * black * black});
  };
  std::size_t chosen = best;
  for (const std::size_t m : eligible) {
    if (!(models[m].excess <= tolerance(models[m]))) continue;
    const std::size_t numbers = models[m].free_parameters, before = models[chosen].free_parameters;
    if (numbers < before || (numbers == before && models[m].excess < models[chosen].excess)) chosen = m;
  }
  comparison->recommended = chosen;
  const JudgedModel& model = models[chosen];
  if (chosen != best) {
    comparison->reason = fmt::format(
        "{} predicts held-out incident directions with an error of {:.3g}; the least is {:.3g}, of {} with {} free "
        "parameters instead of {}, and that is no better than chance or one per cent",
        model.name, model.held_out, models[best].held_out, models[best].name, models[best].free_parameters,
        model.free_parameters);
    return;
  }
  std::size_t fitted = 0;
  for (const JudgedModel& any : models) fitted += any.fitted && !any.material.sel ? 1 : 0;
  const std::string lobes = LobesBelow(models, model.held_out);
  comparison->reason = fmt::format("{}{} has the least error on held-out incident directions, {:.3g}{}",
                                   lobes.empty() ? "" : "of the models, ", model.name, model.held_out,
                                   eligible.size() < fitted ? ", of those that converged and are determined" : "");
  std::vector<std::size_t> simpler;
  for (const std::size_t m : eligible) {
    if (models[m].free_parameters < model.free_parameters) simpler.push_back(m);
  }
  if (simpler.empty()) {
    comparison->reason += lobes;
    return;
  }
  const JudgedModel& next = models[Least(simpler, [&](std::size_t m) { return MeanOverFolds(models[m]); })];
  comparison->reason +=
      fmt::format(", and no simpler recipe comes within one standard error of it (the nearest, {}: {:.3g})", next.name,
                  next.held_out) +
      lobes;
}

// Before any fit, of which some take minutes.
void CheckChannels(const std::vector<GivenMaterial>& given, const Channels& channels) {
  for (const GivenMaterial& material : given) {
    const std::vector<std::string>& own = material.material.channels;
    if (own.size() == channels.size()) continue;
    throw InputError(
        fmt::format("{}: has {} channels ({}), the measurement {} ({}); choose channels of the measurement with "
                    "--channels",
                    material.name, own.size(), JoinSome(own), channels.size(), JoinSome(channels.names)));
  }
}

}  // namespace

std::vector<std::size_t> DealFolds(std::size_t incidences, std::size_t folds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::size_t> dealt(incidences), hand(folds);
  for (std::size_t i = 0; i < incidences; ++i) {
    if (i % folds == 0) {
      std::iota(hand.begin(), hand.end(), std::size_t{0});
      for (std::size_t k = folds; k > 1; --k) std::swap(hand[k - 1], hand[random() % k]);
    }
    dealt[i] = hand[i % folds];
  }
  return dealt;
}

Comparison Compare(const std::vector<Recipe>& recipes, const std::vector<GivenMaterial>& given,
                   const CompareOptions& options, Measurement* measurement) {
  CheckChannels(given, measurement->channels);
  Comparison comparison;
  comparison.metric = recipes.at(0).metric;
  comparison.weighting = EffectiveWeighting(recipes[0].weighting, measurement->samples);
  comparison.samples_read = measurement->samples.size() + measurement->set_aside.total();
  comparison.theta_max = kPi;
  if (comparison.metric == Metric::kAsinh)
    throw UsageError("metric 'asinh' is made for one fit's noise; compare under --metric log");
  for (const Recipe& recipe : recipes) {
    SetAsideForRecipe(recipe, measurement);
    comparison.theta_max = std::min(comparison.theta_max, recipe.theta_max);
  }
  const Samples& samples = measurement->samples;
  comparison.samples = samples.size();
  comparison.residuals = samples.size() * samples.values.size();
  const std::vector<Fold> folds = MakeFolds(*measurement, options, &comparison);
  const double black = ErrorOfBlack(comparison, samples);
  ThreadPool pool(std::max(1, options.fit.threads));
  Progress progress("comparing", (recipes.size() + given.size()) * (1 + folds.size()));

  std::vector<Recipe> used(recipes.size());
  comparison.models.resize(recipes.size() + given.size());
  for (std::size_t m = 0; m < comparison.models.size(); ++m) {
    JudgedModel& model = comparison.models[m];
    if (m < recipes.size()) {
      FitAll(recipes[m], options, comparison.metric, measurement, &used[m], &model);
    } else {
      const GivenMaterial& material = given[m - recipes.size()];
      model.name = material.name;
      model.fitted = false;
      model.material = material.material;
      model.brdf = material.brdf;
      if (!model.material.source.sha256.empty() && model.material.source.sha256 == measurement->sha256)
        model.remarks.emplace_back("was fitted to this measurement, so nothing was held out of it");
    }
    Judge(comparison, *measurement, black, &pool, &model);
    progress.Advance();
  }

  std::vector<FoldResult> results(comparison.models.size() * folds.size());
  FitOptions alone = options.fit;
  alone.threads = 1;
  pool.Run(results.size(), [&](std::size_t task) {
    const std::size_t m = task / folds.size();
    results[task] = RunFold(comparison, folds[task % folds.size()], m < recipes.size() ? &used[m] : nullptr, alone,
                            comparison.models[m]);
    progress.Advance();
  });
  for (std::size_t m = 0; m < comparison.models.size(); ++m) {
    JudgedModel& model = comparison.models[m];
    SquareSum total;
    for (std::size_t k = 0; k < folds.size(); ++k) {
      const FoldResult& result = results[m * folds.size() + k];
      model.fold_mean_square.push_back(result.sum.MeanSquare());
      total.square += result.sum.square;
      total.weight += result.remark.empty() ? result.sum.weight : kNan;
      model.folds_s += result.seconds;
      if (!result.remark.empty()) model.remarks.push_back(fmt::format("fold {}: {}", k + 1, result.remark));
    }
    model.held_out = std::sqrt(total.MeanSquare());
  }
  const std::vector<std::size_t> eligible = Eligible(comparison);
  if (folds.empty()) {
    RecommendByBic(eligible, &comparison);
  } else {
    RecommendByFolds(eligible, black, &comparison);
  }
  return comparison;
}

}  // namespace lobefit

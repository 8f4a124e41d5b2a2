// Comparison of models on one measurement: how well each recipe fits, how well it predicts incident directions that it
// has not seen, and which one to take.
//
// Held-out error. The incident directions are dealt into folds; every recipe is fitted without the directions of a fold
// and judged on them. Readings of one incident direction share alignment, stray light and the model's misfit, so they
// must not be split between fitting and judging.
//
// Information criteria. Likelihood: independent Gaussian residuals of the metric with one unknown variance, n samples
// times channels, k free parameters and the variance: AIC = n ln(RSS/n) + 2 (k + 1), BIC = n ln(RSS/n) + (k + 1) ln n.
// Residuals of measurements are neither independent nor noise alone, so n overstates what they are worth and both
// criteria favour the richer model; the recommendation rests on the held-out error where there is one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/fit/fit.h"
#include "lobefit/measurement/brdf_function.h"

namespace lobefit {

// Excess in mean square that is not worth a parameter: 1 % in root mean square.
inline constexpr double kWorthNothing = 0.02;
// Errors below this share of the measured values' own root mean square are rounding, and equal.
inline constexpr double kRounding = 1e-6;

struct CompareOptions {
  FitOptions fit;
  // Number of folds over incident directions, at most as many as there are; 0 or 1: none.
  std::size_t folds = 5;
  // Samples on which the folds are fitted and judged (a stratified subsample of more).
  std::size_t fold_samples = 20000;
};

// A material that is compared without being fitted.
struct GivenMaterial {
  std::string name;
  Material material;
  // f_r in place of the material's model, for materials of other programs: the material then has no more than channels.
  BrdfFunction brdf = nullptr;
};

struct JudgedModel {
  std::string name;
  bool fitted = true;  // false: a given material
  Material material;
  BrdfFunction brdf = nullptr;  // of a given material that has one
  std::size_t free_parameters = 0;
  std::vector<MetricError> errors;  // on all samples of the comparison
  double aic = 0, bic = 0;
  // Mean square under the metric of the comparison over the held-out samples of each fold; NaN where the rest could not
  // be fitted.
  std::vector<double> fold_mean_square;
  // Root mean square over all held-out samples; NaN without folds.
  double held_out = 0;
  // Mean over folds of (mean square - that of the best model), and the standard error of that mean.
  double excess = 0, excess_error = 0;
  double fit_s = 0, folds_s = 0;
  std::vector<std::string> remarks;
};

struct Comparison {
  Metric metric = Metric::kLog;
  Weighting weighting = Weighting::kCells;
  double theta_max = 0;  // radians
  std::size_t samples = 0, samples_read = 0, residuals = 0, incidences = 0, folds = 0, held_out_samples = 0;
  std::vector<JudgedModel> models;  // in the order given, given materials last
  std::size_t recommended = 0;      // index into models
  std::string reason;               // of the recommendation, a sentence
  std::vector<std::string> remarks;
};

// Fits every recipe to `measurement` and judges all under the metric and weighting of the first one, on the samples
// that every recipe can take (the others are set aside and counted). Recommended is the recipe with the fewest free
// parameters whose held-out mean square exceeds the least one by no more than one standard error of the difference over
// folds, or by no more than 2 % (1 % in root mean square: less is not worth a parameter); without folds the one with
// the least BIC. Fits that did not converge or are not determined are recommended only where there is no other. A given
// material is never recommended, and a table of lobes only among tables: it describes the measured incident directions
// and is no model of the surface. Throws InputError where a recipe cannot be fitted at all, or where a given material
// has other channels than the measurement.
Comparison Compare(const std::vector<Recipe>& recipes, const std::vector<GivenMaterial>& given,
                   const CompareOptions& options, Measurement* measurement);

// Deals `incidences` directions into `folds` folds, as equal in number as can be, neighbours apart: fold of each
// direction.
std::vector<std::size_t> DealFolds(std::size_t incidences, std::size_t folds, std::uint64_t seed);

}  // namespace lobefit

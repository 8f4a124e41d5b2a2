#include "lobefit/fit/noise_rounds.h"

#include <optional>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/fit/inference/noise_bias.h"
#include "lobefit/fit/inference/outlier_pull.h"
#include "lobefit/measurement/prepare/noise.h"

namespace lobefit {
namespace {

// What the errors of the last search lack, and what is to be said of it.
void AddWhatNoiseDoes(const NoiseBias& bias, const Recipe& recipe, ThreadPool* pool, Found* found,
                      std::vector<std::string>* remarks) {
  const std::vector<double>& u = found->best().u;
  AddBias(bias, found->layout, u, &found->uncertainty);
  const auto say = [&](std::string remark) {
    if (!remark.empty()) remarks->push_back(std::move(remark));
  };
  if (recipe.metric_given || recipe.loss != Loss::kNone) say(ToBiasRemark(bias, recipe.metric, recipe.loss));
  const std::optional<OutlierPull> pull =
      PullOfOutliers(found->problem, found->layout, u, found->uncertainty, bias.noise, pool);
  if (pull) say(ToPullRemark(*pull, recipe.loss, recipe.loss_scale));
}

}  // namespace

std::unique_ptr<Found> FindUnderNoise(const Fitted& fitted, const FitOptions& options, ThreadPool* pool, Recipe* recipe,
                                      std::vector<std::string>* remarks) {
  // Noise is estimated from a fit's residuals: first under a metric that takes every value.
  const bool needs_noise = recipe->metric == Metric::kAsinh && !recipe->noise.IsKnown();
  if (needs_noise) recipe->metric = Metric::kCubeRoot;
  std::unique_ptr<Found> found;
  const auto search = [&] {
    found.reset();
    found = std::make_unique<Found>(*recipe, fitted.measurement, fitted.samples, fitted.incidences, options, pool);
  };
  const auto predict = [&] {
    return PredictNoiseBias(found->layout, found->best().u, found->uncertainty, fitted.samples,
                            fitted.incidences, pool);
  };
  search();
  if (!fitted.readings && !needs_noise) return found;
  std::optional<NoiseBias> bias = predict();
  if (needs_noise && !bias) {
    throw InputError(fitted.measurement.source +
                     ": metric 'asinh' takes its knee from the noise of the values, and they show none that can be "
                     "told from the model; use --metric log or cube-root");
  }
  const bool may = needs_noise || (!recipe->metric_given && recipe->metric == Recipe().metric);
  // Where only the magnitudes of noise about zero were kept, no metric helps.
  if (bias && may && (needs_noise || (WantsAsinh(*bias) && !FindRectifiedNoise(fitted.measurement)))) {
    const Metric before = recipe->metric;
    recipe->metric = Metric::kAsinh;
    // A fit that the noise has biased leaves residuals that look like noise of the value: that of the new fit tells
    // better.
    constexpr int kMostRounds = 4;
    std::optional<NoiseBias> again;
    for (int round = 0; round < kMostRounds; ++round) {
      recipe->noise = NoiseForAsinh(bias->noise);
      search();
      again = predict();
      if (!again || IsNear(NoiseForAsinh(again->noise), recipe->noise) || round + 1 == kMostRounds) break;
      bias->noise = again->noise;
    }
    if (!needs_noise) remarks->push_back(ToSwitchRemark(*bias, before));
    bias = again;
  }
  if (bias) AddWhatNoiseDoes(*bias, *recipe, pool, found.get(), remarks);
  return found;
}

}  // namespace lobefit

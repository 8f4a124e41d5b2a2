#include "lobefit/fit/objective/problem.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "lobefit/base/error.h"
#include "lobefit/fit/objective/gains.h"

namespace lobefit {
namespace {

// At most 64 runs: enough to share work among the threads of one machine; at least 1024 samples a run.
constexpr std::size_t kMaxRuns = 64;
constexpr std::size_t kMinRun = 1024;

// Adds those of later runs to those of the first, group by group in the order of the runs.
void MergeArrows(const std::vector<KernelSums>& partial, std::vector<GainArrow>* arrows) {
  std::unordered_map<std::uint32_t, std::size_t> place;
  for (std::size_t k = 0; k < arrows->size(); ++k) place[(*arrows)[k].group] = k;
  for (std::size_t run = 1; run < partial.size(); ++run) {
    for (const GainArrow& arrow : partial[run].arrows) {
      const auto [found, is_new] = place.try_emplace(arrow.group, arrows->size());
      if (is_new) {
        arrows->push_back(arrow);
        continue;
      }
      std::vector<double>& to = (*arrows)[found->second].products;
      for (std::size_t k = 0; k < to.size(); ++k) to[k] += arrow.products[k];
    }
  }
}

// Where both directions graze, at a difference angle beyond 70 degrees, the part of a disc above the horizon is too
// long for its mean (GgxRegionMean).
constexpr double kLeastCosineOfCut = 0.35;
double DifferenceCosine(const Samples& samples, std::size_t i) { return 0.5 * Norm(samples.wi(i) + samples.wo(i)); }

// Whether samples are fitted whose disc the horizon cuts: where every lobe has its mean over the part above
// (LobeMeanRule), and what is diffuse is constant.
bool TakesCutDiscs(const Recipe& recipe) {
  const Model& model = recipe.model;
  const Aperture aperture = recipe.aperture();
  const bool one_disc = aperture.source == 0 || aperture.detector == 0;
  const bool constant = model.diffuse == Diffuse::kNone || model.diffuse == Diffuse::kLambert;
  return one_disc && constant && aperture.mean == ApertureMean::kFlux && CoatOf(model) == model.lobes.size() &&
         !recipe.instrument.source_prior && !recipe.instrument.detector_prior &&
         std::all_of(model.lobes.begin(), model.lobes.end(), HasMeanInClosedForm);
}

}  // namespace

std::size_t RunCount(std::size_t count) { return std::clamp<std::size_t>(count / kMinRun, 1, kMaxRuns); }
std::size_t RunBegin(std::size_t count, std::size_t run) {
  // Whole blocks of 256 samples, so that only the last one is padded.
  const std::size_t blocks = (count + 255) / 256;
  return std::min(count, blocks * run / RunCount(count) * 256);
}

void SetAsideForRecipe(const Recipe& recipe, Measurement* measurement) {
  Samples& samples = measurement->samples;
  const double cos_max = recipe.theta_max >= kPi / 2 - 1e-9 ? 0.0 : std::cos(recipe.theta_max + 1e-9);
  std::vector<std::uint8_t> keep(samples.size(), 1);
  const Aperture aperture = recipe.widest_aperture();
  const bool takes_cut = TakesCutDiscs(recipe);
  const double least_i = aperture.source > 0 ? std::sin(aperture.source) : -1,
               least_o = aperture.detector > 0 ? std::sin(std::max(aperture.detector, aperture.across)) : -1;
  std::size_t beyond = 0, negative = 0, at_horizon = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.wi_z[i] < cos_max || samples.wo_z[i] < cos_max) {
      keep[i] = 0;
      ++beyond;
    } else if ((samples.wi_z[i] <= least_i || samples.wo_z[i] <= least_o) &&
               !(takes_cut && DifferenceCosine(samples, i) >= kLeastCosineOfCut)) {
      keep[i] = 0;
      ++at_horizon;
    }
  }
  const Transform transform = TransformOf(recipe.metric, recipe.noise);
  for (const std::vector<double>& values : samples.values) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (keep[i] == 0 || Takes(transform, values[i], samples.wi_z[i])) continue;
      keep[i] = 0;
      ++negative;
    }
  }
  if (beyond + negative + at_horizon == 0) return;
  if (beyond + negative + at_horizon == samples.size()) {
    throw InputError(measurement->source + ": none of its " + std::to_string(samples.size()) +
                     " usable samples can be fitted: " + std::to_string(beyond) + " are beyond the angle limit, " +
                     (at_horizon > 0
                          ? std::to_string(at_horizon) + " have a disc of source or detector that reaches the horizon, "
                          : std::string()) +
                     std::to_string(negative) +
                     " are negative where the metric needs positive values; use --theta-max or another --metric");
  }
  samples.Keep(keep);
  if (beyond > 0) measurement->set_aside.Add(SetAsideReason::kBeyondAngleLimit, beyond);
  if (at_horizon > 0) measurement->set_aside.Add(SetAsideReason::kDiscAtHorizon, at_horizon);
  if (negative > 0) measurement->set_aside.Add(SetAsideReason::kNegative, negative);
}

Weighting EffectiveWeighting(Weighting weighting, const Samples& samples) {
  if (weighting != Weighting::kAuto) return weighting;
  return samples.solid_angle.empty() ? Weighting::kCells : Weighting::kSolidAngle;
}

void SetDirections(const Samples& samples, KernelSamples* kernel) {
  const std::vector<double>* arrays[] = {&samples.wi_x, &samples.wi_y, &samples.wi_z,
                                         &samples.wo_x, &samples.wo_y, &samples.wo_z};
  for (std::size_t k = 0; k < 6; ++k) kernel->direction[k] = arrays[k]->data();
  kernel->count = samples.size();
}

Problem::Problem(const Samples& samples, const Recipe& recipe)
    : samples_(samples), metric_(recipe.metric), sigma_(samples, recipe.metric, recipe.noise) {
  SetDirections(samples, &kernel_);
  for (const std::vector<double>& values : samples.values) kernel_.measured.push_back(values.data());
  const bool by_solid_angle = EffectiveWeighting(recipe.weighting, samples) == Weighting::kSolidAngle;
  if (by_solid_angle && samples.solid_angle.empty()) {
    throw InputError(
        "weighting 'solid-angle': this format lists directions without cells, so their solid angles are not known; use "
        "--weighting cells");
  }
  kernel_.sin_i = RowOf(recipe.metric).sin_i;
  kernel_.sin_o = RowOf(recipe.metric).sin_o;
  if (!samples.weight.empty()) kernel_.weight = samples.weight.data();
  if (by_solid_angle) kernel_.solid_angle = samples.solid_angle.data();
  if (recipe.instrument.alignment && recipe.instrument.alignment->azimuths.size() > 1) {
    for (std::size_t i = 0; i < samples.size(); ++i)
      turn_.push_back(recipe.instrument.alignment->TurnOf(samples.sample_azimuth[i]));
    kernel_.turn = turn_.data();
  }
  if (!sigma_.empty()) {
    weight_ = sigma_.AtReadings();
    for (std::size_t i = 0; i < samples.weight.size(); ++i) weight_[i] *= samples.weight[i];
    kernel_.weight = weight_.data();
  }
  ScaleToMeanOne();
}

double Problem::Weight(std::size_t i) const {
  double weight = kernel_.weight_scale;
  if (kernel_.weight != nullptr) weight *= kernel_.weight[i];
  if (kernel_.solid_angle != nullptr) weight *= kernel_.solid_angle[i];
  return weight * AngularWeight(metric_, samples_.wi_z[i], samples_.wo_z[i]);
}

void Problem::ScaleToMeanOne() {
  kernel_.weight_scale = 1;
  if (kernel_.weight == nullptr && kernel_.solid_angle == nullptr && !kernel_.sin_i && !kernel_.sin_o) return;
  double sum = 0;
  for (std::size_t i = 0; i < size(); ++i) sum += Weight(i);
  if (!(sum > 0)) throw InputError("all weights of the samples are zero; choose another --metric or --weighting");
  kernel_.weight_scale = static_cast<double>(size()) / sum;
}

void Problem::Reweigh(const KernelModel& model, ThreadPool* pool) {
  if (sigma_.empty()) return;
  pool->Run(RunCount(size()), [&](std::size_t run) {
    const std::size_t begin = RunBegin(size(), run), end = RunBegin(size(), run + 1);
    std::vector<std::vector<double>> values;
    ModelValues(kernel_, model, begin, end, &values);
    const std::vector<double> weight = sigma_.At(values, begin);
    for (std::size_t i = begin; i < end; ++i)
      weight_[i] = weight[i - begin] * (samples_.weight.empty() ? 1.0 : samples_.weight[i]);
  });
  ScaleToMeanOne();
}

void Problem::AttachGains(Gains* gains) {
  gains_ = gains;
  kernel_.gain_group = gains->groups();
  kernel_.gain = gains->gains();
}

GainSums Problem::SumGains(const KernelModel& model, ThreadPool* pool) const {
  const std::vector<double> zero(gains_->size(), 0.0);
  std::vector<GainSums> partial(RunCount(size()), {zero, zero});
  pool->Run(partial.size(), [&](std::size_t run) {
    lobefit::SumGains(kernel_, model, RunBegin(size(), run), RunBegin(size(), run + 1), &partial[run]);
  });
  for (std::size_t run = 1; run < partial.size(); ++run) {
    partial[0].sum_of_squares += partial[run].sum_of_squares;
    partial[0].weighted_squares += partial[run].weighted_squares;
    for (std::size_t k = 0; k < zero.size(); ++k) {
      partial[0].curvature[k] += partial[run].curvature[k];
      partial[0].slope[k] += partial[run].slope[k];
    }
  }
  return partial[0];
}

KernelSums Problem::Sum(const KernelModel& model, bool gradient, ThreadPool* pool) const {
  const std::size_t runs = RunCount(size());
  std::vector<KernelSums> partial(runs);
  pool->Run(runs, [&](std::size_t run) {
    Accumulate(kernel_, model, gradient, RunBegin(size(), run), RunBegin(size(), run + 1), &partial[run]);
  });
  KernelSums total = std::move(partial[0]);
  MergeArrows(partial, &total.arrows);
  for (std::size_t run = 1; run < runs; ++run) {
    total.sum_rho += partial[run].sum_rho;
    total.sum_robust_weight += partial[run].sum_robust_weight;
    for (std::size_t c = 0; gradient && c < total.gram.size(); ++c) {
      for (std::size_t k = 0; k < total.gram[c].size(); ++k) total.gram[c][k] += partial[run].gram[c][k];
    }
  }
  // In units of the mean square of the residuals, so that priors count as much as some samples of any measurement.
  const double square = total.sum_rho / static_cast<double>(size() * channels());
  for (std::size_t k = 0; k < model.prior.size(); ++k) {
    total.prior_curvature.push_back(square * model.prior[k]);
    total.prior_slope.push_back(square * model.prior[k] * model.coordinates[k]);
    total.sum_rho += total.prior_slope.back() * model.coordinates[k];
  }
  if (gains_ != nullptr) total.sum_rho += gains_->PriorSum();
  return total;
}

}  // namespace lobefit

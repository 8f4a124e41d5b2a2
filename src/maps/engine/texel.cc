#include "lobefit/maps/engine/texel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace lobefit {
namespace {

constexpr double kStartAlphas[] = {0.05, 0.1, 0.2, 0.4, 0.8};
// Cosine of the angle between normals that lead to the same valley.
constexpr double kSamePeak = 0.9998;

// Of the cost where a coarse descent ends: what a fine one may still take from it, with room.
constexpr double kMayFall = 0.7;

// Mean slopes, in the frame of the normal, of a lobe about `peak`.
std::array<double, 2> SlopeTowards(const Vec3& normal, const Vec3& peak, double most) {
  const MapFrame frame = FrameOf(normal);
  const double z = std::max(Dot(frame.n, peak), 1e-6);
  return {std::clamp(-Dot(frame.t, peak) / z, -most, most), std::clamp(-Dot(frame.b, peak) / z, -most, most)};
}

}  // namespace

TexelFitter::TexelFitter(const MapRules& rules, const LightPaths& paths, int channels)
    : rules_(rules), channels_(channels) {
  lights_.Resize(paths.wi.size());
  Move(paths);
  data_.Resize(lights_.padded);
  objective_.Resize(lights_.padded);
  mean_.resize(lights_.padded), start_weight_.resize(lights_.padded);
}

bool TexelFitter::Select(const float* values, std::size_t stride, TexelFit* fit) {
  all_means_.assign(lights_.count, 0);
  for (int c = 0; c < channels_; ++c) {
    const float* from = values + static_cast<std::size_t>(c) * stride;
    for (std::size_t l = 0; l < lights_.count; ++l) all_means_[l] += static_cast<double>(from[l]);
  }
  known_.clear();
  const double per_channel = 1.0 / channels_;
  for (double& mean : all_means_) {
    mean *= per_channel;
    if (!std::isnan(mean)) known_.push_back(mean);
  }
  if (known_.empty()) return false;
  // A heap of the largest tenth: most values never enter it.
  largest_.resize(known_.size() - (known_.size() - 1) * 9 / 10);
  std::partial_sort_copy(known_.begin(), known_.end(), largest_.begin(), largest_.end(), std::greater<>());
  double scale = largest_.back();
  // More than a tenth of the values is saturated: the brightest that is not.
  if (std::isinf(scale)) {
    scale = 0;
    for (const double mean : known_) scale = std::isfinite(mean) ? std::max(scale, mean) : scale;
  }
  if (!(scale > 0)) return false;
  fit->scale = scale;
  data_.scale = scale;
  used_.clear();
  for (std::size_t l = 0; l < lights_.count; ++l) {
    if (std::isfinite(all_means_[l]) && all_means_[l] >= rules_.shadow * scale) used_.push_back(l);
  }
  const std::size_t used = used_.size();
  const double per_scale = 1 / scale;
  data_.lights.Take(lights_, used_);
  for (std::size_t i = 0; i < used; ++i) mean_[i] = all_means_[used_[i]] * per_scale;
  std::fill(mean_.begin() + static_cast<std::ptrdiff_t>(used), mean_.end(), 0.0);
  for (int c = 0; c < channels_; ++c) {
    const float* from = values + static_cast<std::size_t>(c) * stride;
    for (std::size_t i = 0; i < used; ++i) data_.value[c][i] = static_cast<double>(from[used_[i]]) * per_scale;
    std::fill(data_.value[c].begin() + static_cast<std::ptrdiff_t>(used), data_.value[c].end(), 0.0);
  }
  fit->used = static_cast<std::uint32_t>(used);
  const MapModel model = {rules_.lobe, channels_, rules_.schlick};
  return used >= 4 &&
         used * static_cast<std::size_t>(channels_) > static_cast<std::size_t>(FreeUnknowns(model, bounds_));
}

bool TexelFitter::WidthAtBound(const MapModel& model, const MapPoint& point) const {
  const auto at_bound = [&](double width) { return width <= bounds_.least_width || width >= bounds_.most_width; };
  return !bounds_.width_held && (at_bound(point.width[0]) || (model.lobe != MapLobe::kGgx && at_bound(point.width[2])));
}

bool TexelFitter::IsDoubtful(const MapModel& model, const MapDescent& descent) const {
  return !descent.converged || IsRough(descent.cost, rules_.loss, data_.lights.count) ||
         WidthAtBound(model, descent.point);
}

MapDescent TexelFitter::DescendWithLobe(const MapModel& model, const MapDescent& lambert) {
  // The lobe about the Lambertian normal, and about what mirrors the brightest lights.
  const Vec3 peaks[2] = {lambert.point.normal, HighlightNormal(data_, mean_, lambert.point, bounds_)};
  const bool peak_held = model.TurnsNormal() ? bounds_.normal_held : bounds_.slope_held;
  struct Start {
    MapPoint point;
    double cost;
    int peak;
  };
  std::array<Start, 2 * std::size(kStartAlphas)> starts;
  std::size_t count = 0;
  for (int k = 0; k < (peak_held || Dot(peaks[0], peaks[1]) > kSamePeak ? 1 : 2); ++k) {
    for (const double alpha : kStartAlphas) {
      Start& start = starts[count++];
      start.point = lambert.point, start.peak = k;
      if (!bounds_.width_held) start.point.width = {std::log(alpha), 0, std::log(alpha)};
      if (model.TurnsNormal()) start.point.normal = peaks[k];
      if (!model.TurnsNormal() && k == 1) {
        start.point.slope = SlopeTowards(start.point.normal, peaks[k], bounds_.most_slope);
      }
      start.cost = objective_.CostOfStart(model, data_, rules_.loss, bounds_.amplitudes, &start.point);
      if (bounds_.width_held) break;
    }
  }
  std::sort(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Start& a, const Start& b) { return a.cost < b.cost; });
  // From the best start and the best one about the other peak; where the minimum is doubtful from all.
  const auto other = std::find_if(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count),
                                  [&](const Start& start) { return start.peak != starts[0].peak; });
  const std::size_t few = other == starts.begin() + static_cast<std::ptrdiff_t>(count) ? 1 : 2;
  if (few == 2) std::rotate(starts.begin() + 1, other, other + 1);
  MapDescent best;
  best.cost = std::numeric_limits<double>::infinity();
  int iterations = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (k >= few && !rules_.every_start && !IsDoubtful(model, best)) break;
    const MapDescent descent = Descend(model, data_, starts[k].point, bounds_, rules_.loss, &objective_, kFineTolerance,
                                       k == 0 || rules_.every_start ? nullptr : &best);
    iterations += descent.iterations;
    if (k == 0 || (descent.converged && descent.cost < best.cost)) best = descent;
  }
  best.iterations = iterations;
  return best;
}

TexelFit TexelFitter::Fit(const float* values, std::size_t stride, const HeldNumbers& held, MapPoint* end,
                          MapModel* end_model) {
  TexelFit fit;
  last_model_.channels = 0;
  bounds_ = {held.normal || !rules_.normal_free,
             held.slope,
             held.width,
             {held.diffuse, held.f0, 1e6},
             std::log(rules_.least_alpha),
             std::log(rules_.most_alpha)};
  if (!Select(values, stride, &fit)) {
    fit.status = kMapTooFew | kMapNotDetermined;
    return fit;
  }
  if (rules_.schlick) bounds_.amplitudes.most_f0 = 1 / data_.scale;
  MapPoint known = held.point;
  for (std::size_t c = 0; c < kMostChannels; ++c) known.diffuse[c] /= data_.scale, known.f0[c] /= data_.scale;
  const MapModel none = {MapLobe::kNone, channels_, rules_.schlick};
  const bool lobe_wanted = rules_.lobe != MapLobe::kNone;
  MapDescent best = LambertStart(none, data_, mean_, bounds_, known, rules_.loss, &objective_, &start_weight_);
  if (!lobe_wanted) best = Descend(none, data_, best.point, bounds_, rules_.loss, &objective_);
  MapModel model = none;
  if (lobe_wanted) {
    const MapModel with = {rules_.lobe, channels_, rules_.schlick};
    const MapDescent lobe = DescendWithLobe(with, best);
    // Bayesian information criterion, with the profiled level of noise.
    const double count = static_cast<double>(fit.used) * channels_;
    const double more = FreeUnknowns(with, bounds_) - FreeUnknowns(none, bounds_);
    const auto evidence = [&](double without) {
      return count * std::log(without / lobe.cost) > more * std::log(count);
    };
    int iterations = best.iterations + lobe.iterations;
    bool wins = rules_.choice == LobeChoice::kAlways || evidence((1 - kMayFall) * best.cost);
    if (!wins) {
      best = Descend(none, data_, best.point, bounds_, rules_.loss, &objective_);
      iterations += best.iterations;
      wins = evidence(best.cost);
    }
    if (wins) best = lobe, model = with;
    best.iterations = iterations;
  }
  if (model.lobe == MapLobe::kNone && rules_.lobe != MapLobe::kNone) fit.status |= kMapNoLobe;
  last_model_ = model, last_point_ = best.point, last_cost_ = best.cost;
  Report(model, best, &fit);
  if (end != nullptr) *end = best.point;
  if (end_model != nullptr) *end_model = model;
  return fit;
}

}  // namespace lobefit

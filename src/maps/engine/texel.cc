#include "lobefit/maps/engine/texel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobefit {
namespace {

constexpr double kStartAlphas[] = {0.05, 0.1, 0.2, 0.4};

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
  mean_.resize(lights_.padded), dull_.resize(lights_.padded);
}

bool TexelFitter::Select(const float* values, std::size_t stride, TexelFit* fit) {
  all_means_.assign(lights_.count, kNan);
  sorted_.clear();
  for (std::size_t l = 0; l < lights_.count; ++l) {
    double sum = 0;
    for (int c = 0; c < channels_; ++c) sum += static_cast<double>(values[static_cast<std::size_t>(c) * stride + l]);
    all_means_[l] = sum / channels_;
    if (!std::isnan(sum)) sorted_.push_back(all_means_[l]);
  }
  if (sorted_.empty()) return false;
  const std::size_t at = (sorted_.size() - 1) * 9 / 10;
  std::nth_element(sorted_.begin(), sorted_.begin() + static_cast<std::ptrdiff_t>(at), sorted_.end());
  double scale = sorted_[at];
  // More than a tenth of the values is saturated: the brightest that is not.
  if (std::isinf(scale)) {
    scale = 0;
    for (const double mean : sorted_) scale = std::isfinite(mean) ? std::max(scale, mean) : scale;
  }
  if (!(scale > 0)) return false;
  fit->scale = scale;
  data_.scale = scale;
  std::size_t used = 0;
  data_.lights.from_z = lights_.from_z;
  for (std::size_t l = 0; l < lights_.count; ++l) {
    if (!std::isfinite(all_means_[l]) || all_means_[l] < rules_.shadow * scale) continue;
    data_.lights.Copy(lights_, l, used);
    for (int c = 0; c < channels_; ++c) {
      data_.value[c][used] = static_cast<double>(values[static_cast<std::size_t>(c) * stride + l]) / scale;
    }
    mean_[used++] = all_means_[l] / scale;
  }
  data_.lights.Close(used);
  std::fill(mean_.begin() + static_cast<std::ptrdiff_t>(used), mean_.end(), 0.0);
  for (int c = 0; c < channels_; ++c) {
    std::fill(data_.value[c].begin() + static_cast<std::ptrdiff_t>(used), data_.value[c].end(), 0.0);
  }
  fit->used = static_cast<std::uint32_t>(used);
  const MapModel model = {rules_.lobe, channels_, rules_.schlick};
  return used >= 4 && used * static_cast<std::size_t>(channels_) > static_cast<std::size_t>(FreeUnknowns(model, bounds_));
}

MapDescent TexelFitter::DescendWithLobe(const MapModel& model, const MapDescent& lambert) {
  // The lobe about the Lambertian normal, and about what mirrors the brightest lights.
  const Vec3 peaks[2] = {lambert.point.normal, HighlightNormal(data_, mean_, lambert.point, bounds_)};
  MapPoint starts[2];
  double costs[2];
  const bool peak_held = model.TurnsNormal() ? bounds_.normal_held : bounds_.slope_held;
  const int count = peak_held ? 1 : 2;
  for (int k = 0; k < count; ++k) {
    costs[k] = std::numeric_limits<double>::infinity();
    for (const double alpha : kStartAlphas) {
      MapPoint point = lambert.point;
      if (!bounds_.width_held) point.width = {std::log(alpha), 0, std::log(alpha)};
      if (model.TurnsNormal()) point.normal = peaks[k];
      if (!model.TurnsNormal() && k == 1) point.slope = SlopeTowards(point.normal, peaks[k], bounds_.most_slope);
      const double cost = objective_.CostOfStart(model, data_, rules_.loss, bounds_.amplitudes, &point);
      if (cost < costs[k]) costs[k] = cost, starts[k] = point;
      if (bounds_.width_held) break;
    }
  }
  const int first = count == 2 && costs[1] < costs[0] ? 1 : 0;
  MapDescent best = Descend(model, data_, starts[first], bounds_, rules_.loss, &objective_);
  if (count == 1) return best;
  // The other normal may lie in another valley: near one it leads to the same.
  if (Dot(peaks[0], peaks[1]) > 0.9998) return best;
  const int other = 1 - first;
  const MapDescent second =
      Descend(model, data_, starts[other], bounds_, rules_.loss, &objective_, kFineTolerance, &best);
  const int iterations = best.iterations + second.iterations;
  if (second.converged && second.cost < best.cost) best = second;
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
  // Coarse where it only serves as a start and to be compared with.
  const bool lobe_wanted = rules_.lobe != MapLobe::kNone;
  MapDescent best =
      Descend(none, data_, LambertStart(none, data_, mean_, bounds_, known, rules_.loss, &objective_, &dull_), bounds_,
              rules_.loss, &objective_, lobe_wanted ? kCoarseTolerance : kFineTolerance);
  MapModel model = none;
  if (lobe_wanted) {
    const MapModel with = {rules_.lobe, channels_, rules_.schlick};
    const MapDescent lobe = DescendWithLobe(with, best);
    // Bayesian information criterion, with the profiled level of noise.
    const double count = static_cast<double>(fit.used) * channels_;
    const double more = FreeUnknowns(with, bounds_) - FreeUnknowns(none, bounds_);
    const bool evidence = count * std::log(best.cost / lobe.cost) > more * std::log(count);
    int iterations = best.iterations + lobe.iterations;
    if (rules_.choice == LobeChoice::kAlways || evidence) {
      best = lobe, model = with;
    } else {
      best = Descend(none, data_, best.point, bounds_, rules_.loss, &objective_);
      iterations += best.iterations;
    }
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

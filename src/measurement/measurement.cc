#include "lobefit/measurement/measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "lobefit/measurement/pair_index.h"

namespace lobefit {
namespace {

template <class Function>
void ForEachArray(Samples& samples, Function&& function) {
  for (std::vector<double>* array :
       {&samples.wi_x, &samples.wi_y, &samples.wi_z, &samples.wo_x, &samples.wo_y, &samples.wo_z}) {
    function(*array);
  }
  for (std::vector<double>& array : samples.values) function(array);
  if (!samples.weight.empty()) function(samples.weight);
  if (!samples.sigma.empty()) function(samples.sigma);
  if (!samples.solid_angle.empty()) function(samples.solid_angle);
  if (!samples.sample_azimuth.empty()) function(samples.sample_azimuth);
  if (!samples.file.empty()) function(samples.file);
  function(samples.origin);
}

bool IsFinite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Samples of a pair of directions that occurred before, whose values are not those of noise.
class UnlikeRepeats {
 public:
  explicit UnlikeRepeats(const Samples& samples) : samples_(samples) {}

  void Add(std::size_t first, std::size_t again) {
    // On the normal grids repeat a direction once for each azimuth.
    if (samples_.wi_z[again] > 1 - 1e-12 || samples_.wo_z[again] > 1 - 1e-12) return;
    const double a = samples_.values[0][first], b = samples_.values[0][again];
    if (std::isnan(a) || std::isnan(b)) return;
    // What is dark may scatter by any factor.
    if (repeats_++ == 0) largest_ = Largest();
    unlike_ += std::max(a, b) > 0.02 * largest_ && std::max(a, b) > 2 * std::min(a, b) ? 1 : 0;
  }

  // Empty where most are alike.
  std::string Remark() const {
    if (5 * unlike_ <= repeats_) return "";
    return "directions occur again, and " + std::to_string(unlike_) + " of " + std::to_string(repeats_) +
           " repetitions differ from the first by more than a factor of two: is something missing that tells them "
           "apart (an azimuth, a wavelength, the sample)? Only the first of each are kept";
  }

 private:
  double Largest() const {
    double largest = 0;
    for (const double value : samples_.values[0]) largest = std::max(largest, value);
    return largest;
  }

  const Samples& samples_;
  std::size_t repeats_ = 0, unlike_ = 0;
  double largest_ = 0;
};

}  // namespace

void Samples::Resize(std::size_t count) {
  ForEachArray(*this, [&](auto& array) { array.resize(count); });
}

void Samples::Keep(const std::vector<std::uint8_t>& keep) {
  // What stands before the first that goes stays where it is.
  const auto first = static_cast<std::size_t>(std::find(keep.begin(), keep.end(), 0) - keep.begin());
  ForEachArray(*this, [&](auto& array) {
    std::size_t kept = first;
    for (std::size_t i = first; i < array.size(); ++i) {
      if (keep[i] != 0) array[kept++] = array[i];
    }
    array.resize(kept);
  });
}

Samples Samples::Subset(const std::vector<std::size_t>& indices) const {
  Samples subset;
  subset.values.resize(values.size());
  const auto pick = [&](const auto& from, auto& to) {
    if (from.empty()) return;
    to.reserve(indices.size());
    for (const std::size_t i : indices) to.push_back(from[i]);
  };
  pick(wi_x, subset.wi_x);
  pick(wi_y, subset.wi_y);
  pick(wi_z, subset.wi_z);
  pick(wo_x, subset.wo_x);
  pick(wo_y, subset.wo_y);
  pick(wo_z, subset.wo_z);
  for (std::size_t c = 0; c < values.size(); ++c) pick(values[c], subset.values[c]);
  pick(weight, subset.weight);
  pick(sigma, subset.sigma);
  pick(solid_angle, subset.solid_angle);
  pick(sample_azimuth, subset.sample_azimuth);
  pick(file, subset.file);
  pick(origin, subset.origin);
  return subset;
}

void Samples::Append(const Vec3& wi, const Vec3& wo, const double* channel_values, std::uint32_t origin_index) {
  wi_x.push_back(wi.x);
  wi_y.push_back(wi.y);
  wi_z.push_back(wi.z);
  wo_x.push_back(wo.x);
  wo_y.push_back(wo.y);
  wo_z.push_back(wo.z);
  for (std::size_t c = 0; c < values.size(); ++c) values[c].push_back(channel_values[c]);
  origin.push_back(origin_index);
}

MeasurementBuilder::MeasurementBuilder(Channels channels) {
  measurement_.samples.values.resize(channels.size());
  measurement_.channels = std::move(channels);
}

bool MeasurementBuilder::Add(const Vec3& wi, const Vec3& wo, const double* values, std::uint32_t origin_index) {
  bool any = false;
  for (std::size_t c = 0; c < measurement_.channels.size(); ++c) any = any || std::isfinite(values[c]);
  if (!any || !IsFinite(wi) || !IsFinite(wo)) {
    Skip(SetAsideReason::kNotFinite);
    return false;
  }
  // 1e-9 is far below any instrument's resolution and far above the rounding of cos(90 degrees) = 6e-17.
  const Vec3 unit_wi = Normalized(wi), unit_wo = Normalized(wo);
  if (!(unit_wi.z > 1e-9) || !(unit_wo.z > 1e-9)) {
    Skip(SetAsideReason::kBelowHorizon);
    return false;
  }
  measurement_.samples.Append(unit_wi, unit_wo, values, origin_index);
  return true;
}

Measurement MeasurementBuilder::Finish() {
  constexpr std::size_t kAhead = 16;  // as many look-ups as memory answers in the time of one
  Samples& samples = measurement_.samples;
  PairIndex seen(samples.size());
  std::array<PairIndex::Pair, kAhead> ahead;
  const auto prepare = [&](std::size_t i) {
    if (i < samples.size()) ahead[i % kAhead] = seen.Prepare(samples.wi(i), samples.wo(i));
  };
  for (std::size_t i = 0; i < kAhead; ++i) prepare(i);
  std::vector<std::uint8_t> keep(samples.size(), 1);
  std::vector<std::size_t> firsts;  // of each pair its first sample, as soon as one occurs again
  UnlikeRepeats unlike(samples);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t known = seen.size(), pair = seen.FindOrAdd(ahead[i % kAhead]);
    if (pair < known) {
      keep[i] = 0;
      Skip(SetAsideReason::kDuplicate);
      if (firsts.empty()) {
        firsts.resize(known);
        std::iota(firsts.begin(), firsts.end(), std::size_t{0});
      }
      unlike.Add(firsts[pair], i);
    } else if (!firsts.empty()) {
      firsts.push_back(i);
    }
    prepare(i + kAhead);
  }
  const std::string remark = unlike.Remark();
  if (seen.size() < samples.size()) samples.Keep(keep);
  if (!remark.empty()) measurement_.remarks.push_back(remark);
  return std::move(measurement_);
}

}  // namespace lobefit

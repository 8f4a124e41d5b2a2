#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/validate/pictures/picture.h"
#include "lobefit/validate/pictures/picture_page.h"

namespace lobefit {
namespace {

constexpr int kBins = 32;

// Counts in kBins equal bins over [low, high]; what lies outside goes into the first and last.
std::vector<double> Counts(const std::vector<double>& values, double low, double high) {
  std::vector<double> counts(kBins, 0.0);
  for (const double value : values) {
    const double place = kBins * (value - low) / (high - low);
    ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, kBins - 1.0))];
  }
  return counts;
}

void DrawBars(Canvas* canvas, const Axes& axes, double low, double high, const std::vector<double>& heights) {
  const double width = (high - low) / kBins;
  for (int k = 0; k < kBins; ++k) {
    const Point corner = axes.Map(low + width * k, heights[static_cast<std::size_t>(k)]);
    canvas->Fill({corner.x, corner.y, axes.MapX(width) - axes.MapX(0) - 0.6, axes.MapY(0) - corner.y}, style::kBlue,
                 0.55);
  }
}

// Density of `z` with the normal density; from -4 to 4 unless values lie beyond.
void DrawHistogram(Canvas* canvas, const Box& frame, const std::vector<double>& z) {
  // A few outliers are counted into the last bins; they do not squeeze the rest.
  std::vector<double> sizes = {0};
  for (const double value : z) sizes.push_back(std::fabs(value));
  std::sort(sizes.begin(), sizes.end());
  const double most = sizes[(sizes.size() - 1) * 98 / 100], half = most <= 4 ? 4.0 : 1.1 * most;
  std::vector<double> density = Counts(z, -half, half);
  double highest = 0.5;
  for (double& d : density) {
    d *= kBins / (2 * half) / std::max<double>(1, static_cast<double>(z.size()));
    highest = std::max(highest, d);
  }
  const Axes axes = Frame(canvas, frame, {-half, half}, {0, 1.1 * highest}, LinearTicks(-half, half, 8),
                          "(value − truth) / standard error");
  DrawBars(canvas, axes, -half, half, density);
  std::vector<Point> curve;
  for (int k = 0; k <= 400; ++k) {
    const double t = half * (k / 200.0 - 1);
    curve.push_back(axes.Map(t, std::exp(-t * t / 2) / std::sqrt(2 * kPi)));
  }
  canvas->Polyline(curve, {style::kVermilion, 1.6});
}

void DrawCoverage(Canvas* canvas, const Box& frame, const std::vector<const EntryCalibration*>& entries,
                  bool clustered) {
  const auto intervals = [&](const EntryCalibration* entry) -> const IntervalCalibration& {
    return clustered ? entry->clustered : entry->independent;
  };
  double low = 50;
  for (const EntryCalibration* entry : entries) low = intervals(entry).within_68.low < 0.5 ? 0 : low;
  const auto count = static_cast<double>(entries.size());
  const Axes axes(frame, {0.5, count + 0.5}, {low, 101});
  axes.DrawGrid(canvas, {}, LinearTicks(low, 100, 5));
  axes.DrawFrame(canvas, {}, LinearTicks(low, 100, 5));
  for (const double nominal : {68.27, 95.0})
    canvas->Line(axes.Map(0.5, nominal), axes.Map(count + 0.5, nominal), {style::kVermilion, 1, 1, 5, 3});
  std::vector<Tick> names;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const double x = static_cast<double>(e) + 1;
    for (const Share& share : {intervals(entries[e]).within_68, intervals(entries[e]).within_95})
      DrawWhisker(canvas, axes, x, 100 * share.low, 100 * share.value, 100 * share.high, style::kBlue);
    names.push_back({x, entries[e]->entry.name});
  }
  DrawNames(canvas, axes, names);
}

bool IsFitted(const Trial& trial) { return trial.done && trial.error.empty(); }

}  // namespace

void DrawCalibration(const Experiment& experiment, const std::vector<Trial>& trials, const Calibration& calibration,
                     const std::filesystem::path& path) {
  const std::vector<Entry> entries = Entries(experiment.recipe.model, experiment.truth.channels);
  std::vector<std::vector<double>> z(entries.size());
  std::vector<double> all;
  for (const Trial& trial : trials) {
    if (!IsFitted(trial)) continue;
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const double sigma = calibration.judge_clustered ? trial.standard_error_clustered[e] : trial.standard_error[e];
      if (!trial.free[e] || std::isnan(trial.truth[e]) || !(sigma > 0)) continue;
      z[e].push_back((trial.value[e] - trial.truth[e]) / sigma);
      all.push_back(z[e].back());
    }
  }
  std::vector<const EntryCalibration*> determined;
  for (const EntryCalibration& entry : calibration.entries) {
    if (entry.trials > 0) determined.push_back(&entry);
  }
  const auto filled = std::count_if(z.begin(), z.end(), [](const auto& values) { return !values.empty(); });
  PicturePage page(3 + static_cast<std::size_t>(filled));
  Canvas* canvas = page.canvas();
  page.Head(fmt::format("{} fits, noise {}, metric {}, {} intervals: {}", calibration.done, ToText(experiment.noise),
                        NameOf(MetricChoices(), experiment.recipe.metric),
                        calibration.judge_clustered ? "clustered" : "independent",
                        calibration.passed() ? "passed" : "FAILED"));
  DrawCoverage(canvas, page.Next("Truth within the 68.3 % and 95 % intervals / %", 2), determined,
               calibration.judge_clustered);
  DrawHistogram(canvas, page.Next("All parameters"), all);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (!z[e].empty()) DrawHistogram(canvas, page.Next(entries[e].name), z[e]);
  }
  page.Write(path);
}

void DrawRecovery(const Experiment& experiment, const std::vector<Trial>& trials, const Recovery& recovery,
                  const std::filesystem::path& path) {
  const std::vector<Entry> entries = Entries(experiment.recipe.model, experiment.truth.channels);
  std::vector<std::vector<double>> truth(entries.size()), value(entries.size());
  std::vector<double> digits;
  for (const Trial& trial : trials) {
    if (!IsFitted(trial)) continue;
    digits.push_back(std::log10(std::max(trial.difference, 1e-17)));
    for (std::size_t e = 0; e < entries.size(); ++e) {
      if (!trial.free[e] || std::isnan(trial.truth[e])) continue;
      truth[e].push_back(trial.truth[e]);
      value[e].push_back(trial.value[e]);
    }
  }
  const auto filled = std::count_if(truth.begin(), truth.end(), [](const auto& values) { return !values.empty(); });
  PicturePage page(1 + static_cast<std::size_t>(filled));
  Canvas* canvas = page.canvas();
  page.Head(fmt::format("{} materials without noise, metric {}: {} within {:g}; largest relative difference {:.1e}",
                        recovery.trials, NameOf(MetricChoices(), experiment.recipe.metric),
                        recovery.trials - recovery.exceptions.size(), recovery.limit, recovery.largest));
  constexpr double kLow = -17, kHigh = 1;
  const std::vector<double> counts = Counts(digits, kLow, kHigh);
  const double highest = *std::max_element(counts.begin(), counts.end());
  const Axes axes = Frame(canvas, page.Next("Relative difference / fits"), {kLow, kHigh}, {0, 1.1 * highest + 1},
                          LinearTicks(kLow, kHigh, 5), "log_{10} of the largest relative difference");
  DrawBars(canvas, axes, kLow, kHigh, counts);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (truth[e].empty()) continue;
    const auto [low, high] = std::minmax_element(truth[e].begin(), truth[e].end());
    const Range range = Around(*low, *high);
    const Box frame = page.Next(entries[e].name);
    const Axes pairs = Frame(canvas, frame, range, range, LinearTicks(range.low, range.high, 4),
                             "true → recovered" + UnitLabel(entries[e]));
    const Canvas::Clip clip(canvas, frame);
    canvas->Line(pairs.Map(range.low, range.low), pairs.Map(range.high, range.high), {style::kVermilion, 1});
    for (std::size_t k = 0; k < truth[e].size(); ++k)
      canvas->Disc(pairs.Map(truth[e][k], value[e][k]), 1.8, style::kBlue, 0.5);
  }
  page.Write(path);
}

}  // namespace lobefit

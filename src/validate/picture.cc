#include "lobefit/validate/picture.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "lobefit/base/text.h"
#include "lobefit/report/axes.h"
#include "lobefit/report/canvas.h"
#include "lobefit/report/png.h"
#include "lobefit/report/style.h"

namespace lobefit {
namespace {

constexpr double kWidth = 900, kMargin = 16, kCellHeight = 190, kScale = 1.2;
constexpr int kColumns = 3;
constexpr double kPi2 = 2 * kPi;

TextStyle Title() { return {.size = style::kPanelTitleSize, .color = style::kInk, .weight = Weight::kBold}; }

// Cells of a grid, row by row, below a head of one line.
class Page {
 public:
  explicit Page(std::size_t cells)
      : canvas_(kWidth, 44 + kCellHeight * static_cast<double>((cells + kColumns - 1) / kColumns), kScale,
                std::make_shared<Fonts>()) {
    canvas_.Fill({0, 0, canvas_.width(), canvas_.height()}, {255, 255, 255});
  }
  Canvas* canvas() { return &canvas_; }
  void Head(const std::string& text) {
    canvas_.Text({kMargin, 26}, canvas_.Shorten(text, style::Body(), kWidth - 2 * kMargin), style::Body());
  }
  // The frame of the next diagram; `columns` cells wide.
  Box Next(const std::string& title, int columns = 1) {
    const double cell = (kWidth - kMargin) / kColumns;
    const Box box = {kMargin + cell * static_cast<double>(next_ % kColumns),
                     40 + kCellHeight * static_cast<double>(next_ / kColumns), cell * columns, kCellHeight};
    next_ += columns;
    canvas_.Text({box.x + 44, box.y + 14}, title, Title());
    return Inset(box, 48, 22, 14, 42);
  }
  void Write(const std::filesystem::path& path) const { WritePng(canvas_.pixels(), 96 * kScale, path); }

 private:
  Canvas canvas_;
  int next_ = 0;
};

Range Around(double low, double high) {
  if (!(high > low)) {
    const double half = std::max(1e-12, 0.1 * std::fabs(low));
    return {low - half, high + half};
  }
  const double margin = 0.08 * (high - low);
  return {low - margin, high + margin};
}

Axes Frame(Canvas* canvas, const Box& frame, const Range& x, const Range& y, const std::vector<Tick>& x_ticks,
           const std::string& x_label) {
  Axes axes(frame, x, y);
  const std::vector<Tick> y_ticks = LinearTicks(y.low, y.high, 4);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, x_label);
  return axes;
}

// Density of `z` in bins of a quarter from -4 to 4, with the normal density.
void DrawHistogram(Canvas* canvas, const Box& frame, const std::vector<double>& z) {
  constexpr int kBins = 32;
  std::vector<double> count(kBins, 0.0);
  for (const double value : z) {
    const double place = (value + 4) * 4;
    if (place >= 0 && place < kBins) ++count[static_cast<std::size_t>(place)];
  }
  const Axes axes = Frame(canvas, frame, {-4, 4}, {0, 0.55}, LinearTicks(-4, 4, 8), "(value − truth) / standard error");
  for (int k = 0; k < kBins; ++k) {
    const double density = count[static_cast<std::size_t>(k)] * 4 / std::max<double>(1, static_cast<double>(z.size()));
    const Point corner = axes.Map(-4 + 0.25 * k, std::min(0.55, density));
    canvas->Fill({corner.x, corner.y, axes.MapX(0.25) - axes.MapX(0) - 0.6, axes.MapY(0) - corner.y}, style::kBlue,
                 0.55);
  }
  std::vector<Point> curve;
  for (double t = -4; t <= 4.001; t += 0.05) curve.push_back(axes.Map(t, std::exp(-t * t / 2) / std::sqrt(kPi2)));
  canvas->Polyline(curve, {style::kVermilion, 1.6});
}

void Whisker(Canvas* canvas, const Axes& axes, double x, double low, double value, double high, Rgb color) {
  canvas->Line(axes.Map(x, low), axes.Map(x, high), {color, 1.4});
  canvas->Disc(axes.Map(x, value), 2.8, color);
}

void DrawCoverage(Canvas* canvas, const Box& frame, const Calibration& calibration) {
  const auto count = static_cast<double>(calibration.entries.size());
  Axes axes(frame, {0.5, count + 0.5}, {50, 101});
  axes.DrawGrid(canvas, {}, LinearTicks(50, 100, 5));
  axes.DrawFrame(canvas, {}, LinearTicks(50, 100, 5));
  for (const double nominal : {68.27, 95.0})
    canvas->Line(axes.Map(0.5, nominal), axes.Map(count + 0.5, nominal), {style::kVermilion, 1, 1, 5, 3});
  for (std::size_t e = 0; e < calibration.entries.size(); ++e) {
    const EntryCalibration& entry = calibration.entries[e];
    const IntervalCalibration& i = calibration.judge_clustered ? entry.clustered : entry.independent;
    const double x = static_cast<double>(e) + 1;
    for (const Share& share : {i.within_68, i.within_95})
      Whisker(canvas, axes, x, 100 * share.low, 100 * share.value, 100 * share.high, style::kBlue);
    TextStyle label = style::Tick(Align::kCenter);
    label.size = 9;
    label.markup = false;
    label.baseline = Baseline::kTop;
    // Alternating heights, so that names do not meet.
    canvas->Text({axes.MapX(x), frame.bottom() + (e % 2 == 0 ? 5 : 18)}, entry.entry.name, label);
  }
}

double JudgedError(const Trial& trial, std::size_t e, bool clustered) {
  return clustered ? trial.standard_error_clustered[e] : trial.standard_error[e];
}

std::string Unit(const Entry& entry) { return entry.unit == "1" ? "" : " / " + entry.unit; }

// Positions of the points: the numbers, or 1, 2, ... for words.
std::vector<double> Positions(const Sweep& sweep) {
  std::vector<double> x;
  for (const SweepPoint& point : sweep.points)
    x.push_back(sweep.numeric ? *ParseDouble(point.value) : static_cast<double>(x.size()) + 1);
  return x;
}

std::vector<Tick> PointTicks(const Sweep& sweep, const std::vector<double>& x) {
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < x.size(); ++i) ticks.push_back({x[i], sweep.points[i].value});
  return ticks;
}

Range PositionRange(const Sweep& sweep, const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  if (!sweep.numeric || !(*low > 0 && *high >= 4 * *low)) return Around(*low, *high);
  const double margin = std::pow(*high / *low, 0.08);
  return {*low / margin, *high * margin, true};
}

}  // namespace

void DrawCalibration(const Experiment& experiment, const std::vector<Trial>& trials, const Calibration& calibration,
                     const std::filesystem::path& path) {
  Page page(3 + calibration.entries.size());
  Canvas* canvas = page.canvas();
  page.Head(fmt::format("{} fits, noise {}, metric {}, {} intervals: {}", calibration.done, ToText(experiment.noise),
                        NameOf(MetricChoices(), experiment.recipe.metric),
                        calibration.judge_clustered ? "clustered" : "independent",
                        calibration.passed() ? "passed" : "FAILED"));
  DrawCoverage(canvas, page.Next("Truth within the 68.3 % and 95 % intervals / %", 2), calibration);
  const std::vector<Entry> entries = Entries(experiment.recipe.model, experiment.truth.channels);
  std::vector<std::vector<double>> z(entries.size()), truth(entries.size()), value(entries.size());
  std::vector<double> all;
  for (const Trial& trial : trials) {
    if (!trial.done || !trial.error.empty()) continue;
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const double sigma = JudgedError(trial, e, calibration.judge_clustered);
      if (!trial.free[e] || std::isnan(trial.truth[e]) || !(sigma > 0)) continue;
      z[e].push_back((trial.value[e] - trial.truth[e]) / sigma);
      all.push_back(z[e].back());
      truth[e].push_back(trial.truth[e]);
      value[e].push_back(trial.value[e]);
    }
  }
  DrawHistogram(canvas, page.Next("All parameters"), all);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (z[e].empty()) continue;
    const Box frame = page.Next(entries[e].name);
    if (!experiment.range) {
      DrawHistogram(canvas, frame, z[e]);
      continue;
    }
    const auto [low, high] = std::minmax_element(truth[e].begin(), truth[e].end());
    const Range range = Around(*low, *high);
    const Axes axes = Frame(canvas, frame, range, range, LinearTicks(range.low, range.high, 4),
                            "true → recovered" + Unit(entries[e]));
    const Canvas::Clip clip(canvas, frame);
    canvas->Line(axes.Map(range.low, range.low), axes.Map(range.high, range.high), {style::kVermilion, 1});
    for (std::size_t k = 0; k < truth[e].size(); ++k)
      canvas->Disc(axes.Map(truth[e][k], value[e][k]), 1.8, style::kBlue, 0.5);
  }
  page.Write(path);
}

void DrawSweep(const Sweep& sweep, const std::filesystem::path& path) {
  const std::vector<EntryCalibration>& entries = sweep.points.front().calibration.entries;
  Page page(entries.size() + 2);
  Canvas* canvas = page.canvas();
  const std::vector<double> x = Positions(sweep);
  const Range x_range = PositionRange(sweep, x);
  const std::vector<Tick> ticks = PointTicks(sweep, x);
  page.Head(
      fmt::format("{} swept, {} fits each. Dot and whisker: bias and spread of the fits; band: what the standard "
                  "errors claim",
                  sweep.name, sweep.points.front().calibration.done));
  for (std::size_t e = 0; e < entries.size(); ++e) {
    double low = 0, high = 0;
    std::vector<const EntryCalibration*> row;
    for (const SweepPoint& point : sweep.points) {
      const EntryCalibration* c = e < point.calibration.entries.size() ? &point.calibration.entries[e] : nullptr;
      row.push_back(c != nullptr && c->trials >= 2 ? c : nullptr);
      if (row.back() == nullptr) continue;
      low = std::min({low, c->bias - c->spread, -c->mean_error});
      high = std::max({high, c->bias + c->spread, c->mean_error});
    }
    const Box frame = page.Next(entries[e].entry.name + ", error" + Unit(entries[e].entry));
    const Range y_range = Around(low, high);
    const Axes axes = Frame(canvas, frame, x_range, y_range, ticks, sweep.name);
    canvas->Line(axes.Map(x_range.low, 0), axes.Map(x_range.high, 0), {style::kFaint, 1});
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i] == nullptr) continue;
      const Point top = axes.Map(x[i], row[i]->mean_error), bottom = axes.Map(x[i], -row[i]->mean_error);
      canvas->Fill({top.x - 5, top.y, 10, bottom.y - top.y}, style::kOrange, 0.35);
      Whisker(canvas, axes, x[i], row[i]->bias - row[i]->spread, row[i]->bias, row[i]->bias + row[i]->spread,
              style::kBlue);
    }
  }
  const Axes coverage = Frame(canvas, page.Next("95 % intervals that hold / %"), x_range, {0, 103}, ticks, sweep.name);
  canvas->Line(coverage.Map(x_range.low, 95), coverage.Map(x_range.high, 95), {style::kVermilion, 1, 1, 5, 3});
  const Axes misfit = Frame(canvas, page.Next("misfit flags / %"), x_range, {0, 103}, ticks, sweep.name);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Calibration& c = sweep.points[i].calibration;
    for (const EntryCalibration& entry : c.entries) {
      const Share& share = (c.judge_clustered ? entry.clustered : entry.independent).within_95;
      if (share.total > 0) canvas->Disc(coverage.Map(x[i], 100 * share.value), 2.4, style::kBlue, 0.6);
    }
    if (c.misfit.total > 0)
      Whisker(canvas, misfit, x[i], 100 * c.misfit.low, 100 * c.misfit.value, 100 * c.misfit.high, style::kPurple);
  }
  page.Write(path);
}

}  // namespace lobefit

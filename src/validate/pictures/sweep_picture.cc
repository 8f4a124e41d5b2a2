#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"
#include "lobefit/validate/pictures/picture.h"
#include "lobefit/validate/pictures/picture_page.h"

namespace lobefit {
namespace {

// The swept values along the x axis: numbers at their place, words at 1, 2, ...
struct Points {
  std::vector<double> x;
  Range range;
  std::vector<Tick> ticks, names;  // numbers are ticks, words are drawn as names
  std::string label;
};

Points PointsOf(const Sweep& sweep) {
  Points points;
  for (const SweepPoint& point : sweep.points) {
    points.x.push_back(sweep.numeric ? *ParseDouble(point.value) : static_cast<double>(points.x.size()) + 1);
    points.ticks.push_back({points.x.back(), sweep.numeric ? point.value : ""});
    points.names.push_back({points.x.back(), point.value});
  }
  if (sweep.numeric) {
    points.names.clear();
    points.label = sweep.name;
  }
  const auto [low, high] = std::minmax_element(points.x.begin(), points.x.end());
  points.range = Around(*low, *high);
  if (sweep.numeric && *low > 0 && *high >= 4 * *low) {
    const double margin = std::pow(*high / *low, 0.08);
    points.range = {*low / margin, *high * margin, true};
  }
  return points;
}

Axes FrameOf(Canvas* canvas, const Box& frame, const Points& points, const Range& y) {
  const Axes axes = Frame(canvas, frame, points.range, y, points.ticks, points.label);
  DrawNames(canvas, axes, points.names);
  return axes;
}

// What one point of the sweep takes up: whisker and band.
double Extent(const EntryCalibration& entry) {
  return std::max(std::fabs(entry.bias) + entry.spread, entry.mean_error);
}

// Extents beyond this many medians would make the other points invisible.
constexpr double kMostMedians = 8;

Range ErrorRange(const std::vector<const EntryCalibration*>& row) {
  std::vector<double> extents;
  for (const EntryCalibration* entry : row) {
    if (entry != nullptr) extents.push_back(Extent(*entry));
  }
  std::sort(extents.begin(), extents.end());
  const double limit = kMostMedians * extents[(extents.size() - 1) / 2];
  double low = 0, high = 0;
  for (const EntryCalibration* entry : row) {
    if (entry == nullptr || (limit > 0 && Extent(*entry) > limit)) continue;
    low = std::min({low, entry->bias - entry->spread, -entry->mean_error});
    high = std::max({high, entry->bias + entry->spread, entry->mean_error});
  }
  return Around(low, high);
}

void DrawErrors(Canvas* canvas, const Axes& axes, double x, const EntryCalibration& entry, const Range& y) {
  {
    const Canvas::Clip clip(canvas, axes.frame());
    const Point top = axes.Map(x, entry.mean_error), bottom = axes.Map(x, -entry.mean_error);
    canvas->Fill({top.x - 5, top.y, 10, bottom.y - top.y}, style::kOrange, 0.35);
    DrawWhisker(canvas, axes, x, entry.bias - entry.spread, entry.bias, entry.bias + entry.spread, style::kBlue);
  }
  if (entry.bias >= y.low && entry.bias <= y.high) return;
  const bool above = entry.bias > y.high;
  // Beside the band, on the side where there is room.
  const bool right = axes.MapX(x) < axes.frame().center().x;
  TextStyle number = style::Tick(right ? Align::kLeft : Align::kRight);
  number.color = style::kBlue;
  canvas->Text({axes.MapX(x) + (right ? 8 : -8), above ? axes.frame().y + 13 : axes.frame().bottom() - 5},
               fmt::format("{} {:.2g}", above ? "↑" : "↓", entry.bias), number);
}

}  // namespace

void DrawSweep(const Sweep& sweep, const std::filesystem::path& path) {
  const std::vector<EntryCalibration>& entries = sweep.points.front().calibration.entries;
  std::vector<std::vector<const EntryCalibration*>> rows;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    std::vector<const EntryCalibration*> row;
    for (const SweepPoint& point : sweep.points) {
      const EntryCalibration* c = e < point.calibration.entries.size() ? &point.calibration.entries[e] : nullptr;
      row.push_back(c != nullptr && c->trials >= 2 ? c : nullptr);
    }
    if (std::any_of(row.begin(), row.end(), [](const auto* c) { return c != nullptr; })) rows.push_back(row);
  }
  PicturePage page(rows.size() + 2);
  Canvas* canvas = page.canvas();
  const Points points = PointsOf(sweep);
  page.Head(
      fmt::format("{} swept, {} fits each. Dot and whisker: bias and spread of the fits; band: what the standard "
                  "errors claim",
                  sweep.name, sweep.points.front().calibration.done));
  for (const std::vector<const EntryCalibration*>& row : rows) {
    const Entry& entry = (*std::find_if(row.begin(), row.end(), [](const auto* c) { return c != nullptr; }))->entry;
    const Box frame = page.Next(entry.name + ", error" + UnitLabel(entry));
    const Range y = ErrorRange(row);
    const Axes axes = FrameOf(canvas, frame, points, y);
    canvas->Line(axes.Map(points.range.low, 0), axes.Map(points.range.high, 0), {style::kFaint, 1});
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i] != nullptr) DrawErrors(canvas, axes, points.x[i], *row[i], y);
    }
  }
  const Axes coverage = FrameOf(canvas, page.Next("95 % intervals that hold / %"), points, {0, 103});
  canvas->Line(coverage.Map(points.range.low, 95), coverage.Map(points.range.high, 95),
               {style::kVermilion, 1, 1, 5, 3});
  const Axes misfit = FrameOf(canvas, page.Next("Misfit flags / %"), points, {0, 103});
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const Calibration& c = sweep.points[i].calibration;
    for (const EntryCalibration& entry : c.entries) {
      const Share& share = (c.judge_clustered ? entry.clustered : entry.independent).within_95;
      if (share.total > 0) canvas->Disc(coverage.Map(points.x[i], 100 * share.value), 2.4, style::kBlue, 0.6);
    }
    if (c.misfit.total > 0)
      DrawWhisker(canvas, misfit, points.x[i], 100 * c.misfit.low, 100 * c.misfit.value, 100 * c.misfit.high,
                  style::kPurple);
  }
  page.Write(path);
}

}  // namespace lobefit

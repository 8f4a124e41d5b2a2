// Hemisphere maps for a few incident directions: measured, fitted and the logarithm of their ratio over all outgoing
// directions.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "lobefit/base/parallel.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/report/axes.h"
#include "lobefit/report/panel.h"
#include "lobefit/report/scatter.h"
#include "lobefit/report/style.h"

namespace lobefit {
namespace {

constexpr int kSize = 168;  // pixels of a map before it is enlarged
constexpr std::size_t kMostMaps = 4;
constexpr std::size_t kFewest = 60;   // samples of an incident direction
constexpr double kLeastCover = 0.25;  // share of the hemisphere that the samples must speak for
constexpr std::size_t kMostPoints = 20000;
constexpr float kMostRatio = 4;  // of the logarithm

// One incident direction: values at the pixels of a disc whose radius is theta_o; NaN where nothing is known.
struct Map {
  Vec3 stays;  // the direction that stays, as drawn
  std::vector<float> measured, fitted, log_ratio;
  double cover = 0;
};

// Direction of a pixel's centre; z <= 0 outside the disc.
Vec3 PixelDirection(int column, int row) {
  const double x = (column + 0.5) / kSize * 2 - 1, y = 1 - (row + 0.5) / kSize * 2;
  const double radius = std::hypot(x, y);
  if (radius >= 1) return {0, 0, -1};
  return FromSpherical(radius * kPi / 2, std::atan2(y, x));
}

// The disc's coordinates of a direction.
ScatterPoint DiscPoint(const Vec3& w) {
  const double length = std::hypot(w.x, w.y), radius = std::atan2(length, w.z) / (kPi / 2);
  const double scale = length > 0 ? radius / length : 0;
  return {static_cast<float>(w.x * scale), static_cast<float>(w.y * scale), 0, 0};
}

// How far a sample speaks for its surroundings: three times the median distance from a random direction to the nearest
// sample, within bounds. A sample of a dense row thus also covers the way to the next row.
float Reach(const std::vector<ScatterPoint>& points) {
  const ScatterTree tree(points, 2);
  std::vector<double> distances;
  std::array<ScatterTree::Neighbour, ScatterTree::kMost> found;
  for (int row = 4; row < kSize; row += 8) {
    for (int column = 4; column < kSize; column += 8) {
      const Vec3 w = PixelDirection(column, row);
      if (w.z > 0 && tree.Nearest(DiscPoint(w), 1, &found) > 0) distances.push_back(std::sqrt(found[0].distance2));
    }
  }
  return static_cast<float>(std::clamp(3 * Quantile(&distances, 0.5), 0.045, 0.11));
}

Map MakeMap(const ReportData& data, const std::vector<std::uint32_t>& members, const Vec3& stays) {
  const Samples& samples = data.measurement.samples;
  const bool isotropic = data.measurement.isotropic;
  Map map;
  // Isotropic: the mirror direction to the right, as in the curves.
  map.stays = isotropic ? RotateZ(stays, kPi) : stays;
  const bool outgoing = data.staying.outgoing;
  std::vector<ScatterPoint> points;
  std::vector<float> values, ratios;
  std::vector<double> sample_f(data.channels());
  const std::size_t step = 1 + members.size() / kMostPoints;
  for (std::size_t k = 0; k < members.size(); k += step) {
    const std::size_t i = members[k];
    const Vec3 fixed = outgoing ? samples.wo(i) : samples.wi(i);
    Vec3 sweeps = outgoing ? samples.wi(i) : samples.wo(i);
    const auto value = static_cast<float>(data.Display(samples.values, i));
    for (std::size_t c = 0; c < data.channels(); ++c) sample_f[c] = static_cast<double>(data.fitted_values[c][i]);
    const auto fitted = static_cast<float>(data.Display(sample_f));
    const float ratio =
        value > 0 && fitted > 0 ? std::clamp(std::log(value / fitted), -kMostRatio, kMostRatio) : -kMostRatio;
    if (isotropic) {
      // The plane of incidence to the x axis; a table that knows no azimuth is taken as mirror symmetric.
      sweeps = RotateZ(sweeps, kPi - std::atan2(fixed.y, fixed.x));
      points.push_back(DiscPoint({sweeps.x, -sweeps.y, sweeps.z}));
      values.push_back(value);
      ratios.push_back(ratio);
    }
    points.push_back(DiscPoint(sweeps));
    values.push_back(value);
    ratios.push_back(ratio);
  }
  const float reach = Reach(points);
  const ScatterField field(std::move(points), 2, reach);
  map.measured.assign(kSize * kSize, std::numeric_limits<float>::quiet_NaN());
  map.fitted = map.log_ratio = map.measured;
  std::vector<double> f_r(data.channels());
  int inside = 0, covered = 0;
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const Vec3 w = PixelDirection(column, row);
      if (w.z <= 0) continue;
      ++inside;
      const auto pixel = static_cast<std::size_t>(row * kSize + column);
      data.fitted.Evaluate(outgoing ? w : map.stays, outgoing ? map.stays : w, f_r.data());
      map.fitted[pixel] = static_cast<float>(data.Display(f_r));
      std::array<std::uint32_t, 4> indices;
      std::array<float, 4> weights;
      const int have = field.Find(DiscPoint(w), &indices, &weights);
      if (have == 0) continue;
      ++covered;
      float sum = 0, ratio = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(have); ++k) {
        sum += weights[k] * values[indices[k]];
        ratio += weights[k] * ratios[indices[k]];
      }
      map.measured[pixel] = sum;
      // Between the ratios of samples, not the ratio of a value between samples: steep lobes would leave patterns.
      map.log_ratio[pixel] = ratio;
    }
  }
  map.cover = static_cast<double>(covered) / inside;
  return map;
}

std::vector<Map> MakeMaps(const ReportData& data) {
  const std::vector<Vec3>& directions = data.staying.directions;
  std::vector<std::vector<std::uint32_t>> members(directions.size());
  for (std::size_t i = 0; i < data.staying.group.size(); ++i)
    members[data.staying.group[i]].push_back(static_cast<std::uint32_t>(i));
  std::vector<std::size_t> candidates;
  for (std::size_t g = 0; g < members.size(); ++g) {
    if (members[g].size() >= kFewest && PolarAngle(directions[g]) < DegreesToRadians(78)) candidates.push_back(g);
  }
  // Evenly spaced polar angles; among directions of one polar angle, azimuths in turn.
  std::vector<std::size_t> chosen;
  if (!candidates.empty()) {
    const double low = PolarAngle(directions[candidates.front()]), high = PolarAngle(directions[candidates.back()]);
    for (std::size_t k = 0; k < kMostMaps; ++k) {
      // A little off the ends: normal and grazing incidence say least about the shape.
      const double target = low + (high - low) * (0.08 + 0.9 * static_cast<double>(k) / (kMostMaps - 1));
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t g : candidates) least = std::min(least, std::fabs(PolarAngle(directions[g]) - target));
      std::vector<std::size_t> nearest;
      for (const std::size_t g : candidates) {
        const bool taken = std::find(chosen.begin(), chosen.end(), g) != chosen.end();
        if (!taken && std::fabs(PolarAngle(directions[g]) - target) < least + 1e-3) nearest.push_back(g);
      }
      if (!nearest.empty()) chosen.push_back(nearest[k % nearest.size()]);
    }
  }
  std::vector<Map> maps(chosen.size());
  ParallelFor(chosen.size(), data.threads,
              [&](std::size_t k) { maps[k] = MakeMap(data, members[chosen[k]], directions[chosen[k]]); });
  std::erase_if(maps, [](const Map& map) { return map.cover < kLeastCover; });
  return maps;
}

struct Maps {
  const ReportData& data;
  std::vector<Map> maps;
  Range values;
  double ratio = 2;
};

void FindRanges(Maps* maps) {
  std::vector<double> values, ratios;
  double high = 0;
  for (const Map& map : maps->maps) {
    for (std::size_t i = 0; i < map.measured.size(); i += 3) {
      const float m = map.measured[i], f = map.fitted[i];
      if (!(m > 0) || !(f > 0)) continue;
      values.push_back(m);
      high = std::max<double>(high, std::max(m, f));
      ratios.push_back(std::fabs(map.log_ratio[i]));
    }
  }
  double low = values.empty() ? high / 100 : Quantile(&values, 0.03);
  low = std::clamp(low, high * 1e-5, high / 5);
  if (!(high > 0)) low = 0.1, high = 1;
  maps->values = {low, high, true};
  const double spread = ratios.empty() ? 0.1 : Quantile(&ratios, 0.9);
  maps->ratio = 10;
  for (const double nice : {5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.05}) {
    if (std::log(nice) >= spread) maps->ratio = nice;
  }
}

cv::Mat Picture(const std::vector<float>& values, const std::function<Rgb(float)>& color) {
  cv::Mat picture(kSize, kSize, CV_8UC4);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double x = column + 0.5 - kSize / 2.0, y = row + 0.5 - kSize / 2.0;
      const float value = values[static_cast<std::size_t>(row * kSize + column)];
      const Rgb c = std::isnan(value) ? style::kGrid : color(value);
      const bool inside = std::hypot(x, y) < kSize / 2.0;
      picture.at<cv::Vec4b>(row, column) = inside ? cv::Vec4b(c.r, c.g, c.b, 255) : cv::Vec4b(c.r, c.g, c.b, 0);
    }
  }
  return picture;
}

void DrawDisc(Canvas* canvas, const cv::Mat& picture, const Box& box, const Vec3& stays, Rgb mark) {
  canvas->Image(picture, box, true);
  const Point center = box.center();
  const double radius = box.width / 2;
  canvas->Ring(center, radius, {style::kSecondary, 1});
  for (const double theta : {30.0, 60.0}) canvas->Ring(center, radius * theta / 90, {mark, 0.5, 0.35});
  // The direction that stays as a ring, its mirror direction as a cross.
  const ScatterPoint at = DiscPoint(stays);
  const Point retro = {center.x + radius * static_cast<double>(at[0]), center.y - radius * static_cast<double>(at[1])};
  const Point mirror = {2 * center.x - retro.x, 2 * center.y - retro.y};
  canvas->Ring(retro, 3.5, {mark, 1});
  canvas->Line({mirror.x - 4, mirror.y}, {mirror.x + 4, mirror.y}, {mark, 1});
  canvas->Line({mirror.x, mirror.y - 4}, {mirror.x, mirror.y + 4}, {mark, 1});
}

constexpr double kLabel = 26, kHead = 20, kSpace = 12, kScales = 52;

double DiscSize(double width, std::size_t count) {
  return std::min(240.0, (width - kLabel - kSpace * static_cast<double>(count - 1)) / static_cast<double>(count));
}

void Draw(const Maps& maps, Canvas* canvas, const Box& content) {
  const std::size_t count = maps.maps.size();
  const double size = DiscSize(content.width, std::max<std::size_t>(count, 3));
  const double used = size * static_cast<double>(count) + kSpace * static_cast<double>(count - 1);
  const double left = content.x + kLabel + std::max(0.0, (content.width - kLabel - used) / 2);
  const double span = std::log(maps.values.high / maps.values.low), half = std::log(maps.ratio);
  const auto sequential = [&](float v) { return SequentialColor(v > 0 ? std::log(v / maps.values.low) / span : 0); };
  const auto diverging = [&](float v) { return DivergingColor(0.5 + v / (2 * half)); };
  const std::array<const char*, 3> names = {"measured", "fitted", "measured / fitted"};
  for (std::size_t k = 0; k < count; ++k) {
    const Map& map = maps.maps[k];
    const double x = left + static_cast<double>(k) * (size + kSpace);
    const bool outgoing = maps.data.staying.outgoing;
    std::string label = (outgoing ? "θ_o = " : "θ_i = ") + Degrees(PolarAngle(map.stays));
    if (!maps.data.measurement.isotropic && PolarAngle(map.stays) > 1e-3)
      label += (outgoing ? ",  φ_o = " : ",  φ_i = ") + Degrees(Azimuth(map.stays));
    canvas->Text({x + size / 2, content.y + 12}, label,
                 {.size = style::kBodySize, .color = style::kInk, .align = Align::kCenter, .markup = true});
    const auto place = [&](int row) { return Box{x, content.y + kHead + row * (size + kSpace), size, size}; };
    DrawDisc(canvas, Picture(map.measured, sequential), place(0), map.stays, {255, 255, 255});
    DrawDisc(canvas, Picture(map.fitted, sequential), place(1), map.stays, {255, 255, 255});
    DrawDisc(canvas, Picture(map.log_ratio, diverging), place(2), map.stays, style::kInk);
  }
  for (int row = 0; row < 3; ++row) {
    canvas->Text({left - 14, content.y + kHead + row * (size + kSpace) + size / 2},
                 names[static_cast<std::size_t>(row)],
                 {.size = style::kBodySize, .color = style::kInk, .align = Align::kCenter, .upwards = true});
  }
  const double y = content.y + kHead + 3 * (size + kSpace) + 14, width = std::min(320.0, (used - 60) / 2);
  DrawColorScale(canvas, {left + 12, y, width, 9}, SequentialColor, maps.values,
                 LogTicks(maps.values.low, maps.values.high, 5), "f_r  (1/sr)");
  const double inner = std::sqrt(maps.ratio);
  const std::vector<Tick> ticks = {{1 / maps.ratio, RatioText(1 / maps.ratio)},
                                   {1 / inner, ""},
                                   {1, "1"},
                                   {inner, ""},
                                   {maps.ratio, RatioText(maps.ratio)}};
  DrawColorScale(canvas, {left + used - width - 14, y, width, 9}, DivergingColor, {1 / maps.ratio, maps.ratio, true},
                 ticks, "measured / fitted");
}

}  // namespace

std::optional<Panel> MapsPanel(const ReportData& data) {
  if (IsInPlane(data.measurement.samples)) return std::nullopt;
  const auto maps = std::make_shared<Maps>(Maps{data, MakeMaps(data), {}, 2});
  if (maps->maps.empty()) return std::nullopt;
  FindRanges(maps.get());
  Panel panel;
  panel.id = "maps";
  panel.title = "All outgoing directions";
  panel.legend = {{LegendEntry::Mark::kNone,
                   {},
                   "radius: polar angle, rings at 30° and 60°;  o retro, + mirror direction;  grey: no sample near"}};
  panel.height = [maps](Canvas*, double width) {
    return kHead + 3 * (DiscSize(width, std::max<std::size_t>(maps->maps.size(), 3)) + kSpace) + kScales;
  };
  panel.draw = [maps](Canvas* canvas, const Box& content) { Draw(*maps, canvas, content); };
  return panel;
}

}  // namespace lobefit

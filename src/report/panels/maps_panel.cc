// Hemisphere maps for a few incident directions: measured, fitted and the logarithm of their ratio over all outgoing
// directions.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/figures/fitted_pixels.h"
#include "lobefit/report/figures/scatter.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr int kSize = 168;  // pixels of a map before it is enlarged
constexpr std::size_t kMostMaps = 4;
constexpr std::size_t kFewest = 60;   // samples of an incident direction
constexpr double kLeastCover = 0.25;  // share of the hemisphere that the samples must speak for
constexpr std::size_t kMostPoints = 20000;

// One incident direction: values at the pixels of a disc whose radius is theta_o; NaN where nothing is known.
struct Map {
  Vec3 stays;  // the direction that stays, as drawn
  std::shared_ptr<FieldImage> image = std::make_shared<FieldImage>(kSize, kSize);
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
    const float ratio = LogRatioOf(data.Display(samples.values, i), data.Display(sample_f));
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
  int inside = 0;
  std::vector<std::uint8_t> near(map.image->measured.size());
  FittedPixels fitted(data);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const Vec3 w = PixelDirection(column, row);
      if (w.z <= 0) continue;
      ++inside;
      const std::size_t pixel = map.image->At(column, row);
      fitted.Add(pixel, outgoing ? w : map.stays, outgoing ? map.stays : w);
      std::array<std::uint32_t, 4> indices;
      std::array<float, 4> weights;
      bool is_near = false;
      const int have = field.Find(DiscPoint(w), &indices, &weights, &is_near);
      near[pixel] = is_near ? 1 : 0;
      float sum = 0, ratio = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(have); ++k) {
        sum += weights[k] * values[indices[k]];
        ratio += weights[k] * ratios[indices[k]];
      }
      map.image->measured[pixel] = sum;
      // Between the ratios of samples, not the ratio of a value between samples: steep lobes would leave patterns.
      map.image->log_ratio[pixel] = ratio;
    }
    fitted.Write(map.image.get());
  }
  map.cover = static_cast<double>(KeepNear(near, map.image.get())) / inside;
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
  std::vector<Map> maps;
  std::vector<std::string> titles;
  FieldScale scale;
  std::vector<std::array<cv::Mat, 3>> pictures;  // of each map: measured, fitted, their ratio
};

void DrawDisc(Canvas* canvas, const cv::Mat& picture, const Box& box, const Vec3& stays, Rgb mark) {
  canvas->Image(RoundPicture(picture, static_cast<int>(std::lround(box.width * canvas->scale()))), box, false);
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

std::string Title(const ReportData& data, const Map& map) {
  const bool outgoing = data.staying.outgoing;
  std::string title = (outgoing ? "θ_o = " : "θ_i = ") + Degrees(PolarAngle(map.stays));
  if (!data.measurement.isotropic && PolarAngle(map.stays) > 1e-3)
    title += (outgoing ? ",  φ_o = " : ",  φ_i = ") + Degrees(Azimuth(map.stays));
  return title;
}

constexpr double kLabel = 26, kHead = 20, kSpace = 12;

double DiscSize(double width, std::size_t count) {
  return std::min(240.0, (width - kLabel - kSpace * static_cast<double>(count - 1)) / static_cast<double>(count));
}

void Draw(const Maps& maps, Canvas* canvas, const Box& content) {
  const std::size_t count = maps.maps.size();
  const double size = DiscSize(content.width, std::max<std::size_t>(count, 3));
  const double used = size * static_cast<double>(count) + kSpace * static_cast<double>(count - 1);
  const double left = content.x + kLabel + std::max(0.0, (content.width - kLabel - used) / 2);
  const std::array<const char*, 3> names = {"measured", "fitted", "measured / fitted"};
  for (std::size_t k = 0; k < count; ++k) {
    const Map& map = maps.maps[k];
    const double x = left + static_cast<double>(k) * (size + kSpace);
    canvas->Text({x + size / 2, content.y + 12}, maps.titles[k],
                 {.size = style::kBodySize, .color = style::kInk, .align = Align::kCenter, .markup = true});
    const auto place = [&](int row) { return Box{x, content.y + kHead + row * (size + kSpace), size, size}; };
    for (int row = 0; row < 3; ++row) {
      DrawDisc(canvas, maps.pictures[k][static_cast<std::size_t>(row)], place(row), map.stays,
               row < 2 ? Rgb{255, 255, 255} : style::kInk);
    }
  }
  for (int row = 0; row < 3; ++row) {
    canvas->Text({left - 14, content.y + kHead + row * (size + kSpace) + size / 2},
                 names[static_cast<std::size_t>(row)],
                 {.size = style::kBodySize, .color = style::kInk, .align = Align::kCenter, .upwards = true});
  }
  maps.scale.Draw(canvas, left, left + used, content.y + kHead + 3 * (size + kSpace));
}

}  // namespace

std::optional<Panel> MapsPanel(const ReportData& data) {
  if (IsInPlane(data.measurement.samples)) return std::nullopt;
  std::vector<Map> made = MakeMaps(data);
  if (made.empty()) return std::nullopt;
  std::vector<const FieldImage*> images;
  for (const Map& map : made) images.push_back(map.image.get());
  const auto maps = std::make_shared<Maps>(Maps{std::move(made), {}, FieldScale(images), {}});
  for (const Map& map : maps->maps) {
    maps->titles.push_back(Title(data, map));
    maps->pictures.push_back(Pictures(*map.image, maps->scale));
  }
  Panel panel;
  panel.id = "maps";
  panel.title = "All outgoing directions";
  panel.legend = {{LegendEntry::Mark::kNone,
                   {},
                   "radius: polar angle, rings at 30° and 60°;  o retro, + mirror direction;  grey: no sample near"}};
  panel.height = [maps](Canvas*, double width) {
    return kHead + 3 * (DiscSize(width, std::max<std::size_t>(maps->maps.size(), 3)) + kSpace) + FieldScale::kHeight;
  };
  panel.draw = [maps](Canvas* canvas, const Box& content) { Draw(*maps, canvas, content); };
  const std::string side = data.staying.outgoing ? "o" : "i";
  for (std::size_t k = 0; k < maps->maps.size(); ++k) {
    const Map& map = maps->maps[k];
    const auto degrees = [](double angle) { return std::to_string(std::lround(RadiansToDegrees(angle))); };
    std::string name = Join({"maps.theta_", side, "_", degrees(PolarAngle(map.stays))}, "");
    if (!data.measurement.isotropic) name += Join({".phi_", side, "_", degrees(Azimuth(map.stays))}, "");
    panel.fields.push_back({name, maps->titles[k], map.image});
  }
  return panel;
}

}  // namespace lobefit

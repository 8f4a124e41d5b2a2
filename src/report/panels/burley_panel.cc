// Image slices over theta_h and theta_d [Burley 2012]: isotropic measurements only, near phi_d = 90 degrees.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/figures/fitted_pixels.h"
#include "lobefit/report/figures/scatter.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr int kSize = 120;
constexpr double kLeastCover = 0.6;
constexpr std::array<double, 4> kWidths = {3, 8, 15, 25};  // degrees about phi_d = 90 that are tried
constexpr std::size_t kEnough = 4000, kMostPoints = 30000;

struct AngleImage {
  std::shared_ptr<FieldImage> image = std::make_shared<FieldImage>(kSize, kSize);
  double width = 0;  // degrees about phi_d = 90
  double cover = 0;
};

struct Drawn {
  FieldScale scale;
  std::array<cv::Mat, 3> pictures;  // measured, fitted, their ratio
};

// theta_h at a column, theta_d at a row (0 at the bottom), radians.
double AngleAt(int pixel) { return (pixel + 0.5) / kSize * kPi / 2; }

std::shared_ptr<AngleImage> Make(const ReportData& data) {
  auto slices = std::make_shared<AngleImage>();
  const Samples& samples = data.measurement.samples;
  struct Member {
    ScatterPoint at;
    float off;
    std::uint32_t sample;
  };
  std::vector<Member> members;
  const std::size_t step = 1 + samples.size() / 600000;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    const HalfDifference angles = ToFoldedHalfDifference(samples.wi(i), samples.wo(i));
    const double off = RadiansToDegrees(kPi / 2 - angles.phi_d);
    if (off > kWidths.back()) continue;
    const auto unit = [](double angle) { return static_cast<float>(angle / (kPi / 2)); };
    members.push_back(
        {{unit(angles.theta_h), unit(angles.theta_d), 0, 0}, static_cast<float>(off), static_cast<std::uint32_t>(i)});
  }
  for (const double width : kWidths) {
    slices->width = width;
    const auto inside = std::count_if(members.begin(), members.end(),
                                      [&](const Member& m) { return static_cast<double>(m.off) <= width; });
    if (static_cast<std::size_t>(inside) >= kEnough) break;
  }
  std::erase_if(members, [&](const Member& m) { return static_cast<double>(m.off) > slices->width; });
  std::vector<ScatterPoint> points;
  std::vector<float> values, ratios;
  std::vector<double> fitted(data.channels());
  const std::size_t stride = 1 + members.size() / kMostPoints;
  for (std::size_t k = 0; k < members.size(); k += stride) {
    const std::size_t i = members[k].sample;
    for (std::size_t c = 0; c < fitted.size(); ++c) fitted[c] = static_cast<double>(data.fitted_values[c][i]);
    points.push_back(members[k].at);
    values.push_back(static_cast<float>(data.Display(samples.values, i)));
    ratios.push_back(LogRatioOf(data.Display(samples.values, i), data.Display(fitted)));
  }
  if (points.empty()) return slices;
  const ScatterField field(std::move(points), 2, 0.02F);
  int possible = 0;
  std::vector<std::uint8_t> near(slices->image->measured.size());
  FittedPixels read(data);
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double theta_h = AngleAt(column), theta_d = AngleAt(kSize - 1 - row);
      Vec3 wi, wo;
      FromHalfDifference({theta_h, 0, theta_d, kPi / 2}, &wi, &wo);
      if (wi.z <= 0.02 || wo.z <= 0.02) continue;
      ++possible;
      const std::size_t pixel = slices->image->At(column, row);
      read.Add(pixel, wi, wo);
      std::array<std::uint32_t, 4> indices;
      std::array<float, 4> weights;
      bool is_near = false;
      const int have =
          field.Find({static_cast<float>(theta_h / (kPi / 2)), static_cast<float>(theta_d / (kPi / 2)), 0, 0}, &indices,
                     &weights, &is_near);
      near[pixel] = is_near ? 1 : 0;
      float value = 0, ratio = 0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(have); ++k) {
        value += weights[k] * values[indices[k]];
        ratio += weights[k] * ratios[indices[k]];
      }
      slices->image->measured[pixel] = value;
      slices->image->log_ratio[pixel] = ratio;
    }
    read.Write(slices->image.get());
  }
  slices->cover = static_cast<double>(KeepNear(near, slices->image.get())) / std::max(1, possible);
  return slices;
}

constexpr double kLeft = 52, kGap = 22;

double Side(double width) { return std::min(300.0, (width - kLeft - 2 * kGap) / 3); }

void Draw(const Drawn& drawn, Canvas* canvas, const Box& content) {
  const double size = Side(content.width), used = 3 * size + 2 * kGap,
               left = content.x + kLeft + std::max(0.0, (content.width - kLeft - used) / 2);
  const std::array<const char*, 3> names = {"measured", "fitted", "measured / fitted"};
  for (std::size_t k = 0; k < 3; ++k) {
    const Box frame = {left + static_cast<double>(k) * (size + kGap), content.y + 22, size, size};
    canvas->Image(drawn.pictures[k], frame, true);
    const Axes axes(frame, {0, 90, false}, {0, 90, false});
    const std::vector<Tick> ticks = AngleTicks(0, 90, 4);
    axes.DrawFrame(canvas, ticks, ticks, true, k == 0);
    axes.DrawXLabel(canvas, "θ_h  (degrees)");
    if (k == 0) axes.DrawYLabel(canvas, "θ_d  (degrees)", 36);
    canvas->Text({frame.center().x, content.y + 14}, names[k], style::Body(style::kInk, Align::kCenter));
  }
  drawn.scale.Draw(canvas, left, left + used, content.y + 22 + size + 48);
}

}  // namespace

std::optional<Panel> BurleyPanel(const ReportData& data) {
  if (!data.measurement.isotropic) return std::nullopt;
  const std::shared_ptr<AngleImage> slices = Make(data);
  if (slices->cover < kLeastCover) return std::nullopt;
  const FieldScale scale({slices->image.get()});
  const auto drawn = std::make_shared<Drawn>(Drawn{scale, Pictures(*slices->image, scale)});
  Panel panel;
  panel.id = "burley";
  panel.title = "Half angle against difference angle";
  panel.legend = {{LegendEntry::Mark::kNone,
                   {},
                   Join({"φ_d within ", Number(slices->width, 2), "° of 90°;  grey: no sample near"}, "")}};
  panel.height = [](Canvas*, double width) { return 22 + Side(width) + 48 + FieldScale::kHeight; };
  panel.draw = [drawn](Canvas* canvas, const Box& content) { Draw(*drawn, canvas, content); };
  panel.fields = {{"half_difference.phi_d_90", "φ_d = 90°", slices->image}};
  return panel;
}

}  // namespace lobefit

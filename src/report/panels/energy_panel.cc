// Albedo over the angle of incidence, what a single bounce keeps, and the weak furnace test.
#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/core/brdf/model_energy.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

struct Energy {
  std::vector<double> degrees;
  std::vector<std::vector<double>> albedo;  // [shown channel][angle]
  std::vector<double> bounce, furnace;      // of the first lobe
  double high = 1;
};

void Draw(const ReportData& data, const Energy& energy, Canvas* canvas, const Box& content) {
  const Box room = Inset(content, 52, 4, 4, 118);
  const Box frame = {room.x, room.y, room.width, std::min(room.height, 0.8 * room.width)};
  const Range angles = {0, 90, false}, values = {0, energy.high, false};
  const Axes axes(frame, angles, values);
  const std::vector<Tick> x_ticks = AngleTicks(0, 90, 4), y_ticks = LinearTicks(0, energy.high, 5);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  const auto curve = [&](const std::vector<double>& y, const Stroke& stroke) {
    const Canvas::Clip clip(canvas, frame);
    std::vector<Point> line;
    for (std::size_t k = 0; k < y.size(); ++k) line.push_back(axes.Map(energy.degrees[k], y[k]));
    canvas->Polyline(line, stroke);
  };
  curve(energy.bounce, {style::kSecondary, 1, 1, 6, 4});
  curve(energy.furnace, {style::kInk, 1, 1, 2, 3});
  for (std::size_t c = 0; c < energy.albedo.size(); ++c)
    curve(energy.albedo[c], {data.channel_colors[data.shown_channels[c]], 1.5});
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "θ_i  (degrees), φ_i = 0");
  axes.DrawYLabel(canvas, "share of the light", energy.high < 0.1 ? 47 : 38);  // small numbers are longer
  // Legend under the diagram: line, words.
  double y = frame.bottom() + 58;
  const auto entry = [&](const std::string& text, const std::vector<Stroke>& strokes) {
    double x = content.x;
    const double width = 30.0 / static_cast<double>(strokes.size());
    for (const Stroke& stroke : strokes) {
      canvas->Line({x, y - 4}, {x + width - 2, y - 4}, stroke);
      x += width;
    }
    canvas->Text({content.x + 38, y}, canvas->Shorten(text, style::Note(), content.width - 38), style::Note());
    y += 17;
  };
  std::vector<Stroke> strokes;
  for (const std::size_t c : data.shown_channels) strokes.push_back({data.channel_colors[c], 2});
  entry("albedo of the fitted model", strokes);
  if (!energy.bounce.empty()) {
    entry("its lobe with F = 1: what one bounce keeps", {{style::kSecondary, 1, 1, 6, 4}});
    entry("weak furnace of its masking; 1 is exact", {{style::kInk, 1, 1, 2, 3}});
  }
  const double most = energy.high;
  if (most > 1.06)
    canvas->Text({content.x, y}, "An albedo above 1: the model creates energy.", style::Note(style::kWarning));
}

}  // namespace

std::optional<Panel> EnergyPanel(const ReportData& data) {
  const Material& material = data.material;
  if (material.model.lobes.empty()) return std::nullopt;
  const auto energy = std::make_shared<Energy>();
  const ParameterValues values = material.Values();
  energy->albedo.resize(data.shown_channels.size());
  double most = 1;
  for (int degrees = 0; degrees <= 88; degrees += 4) {
    const Vec3 wi = FromSpherical(DegreesToRadians(std::max(degrees, 0)), 0);
    energy->degrees.push_back(degrees);
    const std::vector<double> albedo = DirectionalAlbedo(material.model, values, data.channels(), wi);
    for (std::size_t k = 0; k < data.shown_channels.size(); ++k) {
      energy->albedo[k].push_back(albedo[data.shown_channels[k]]);
      most = std::max(most, albedo[data.shown_channels[k]]);
    }
    if (material.model.lobes[0].masking == Masking::kNone) continue;  // no surface whose light could be counted
    energy->bounce.push_back(SingleBounceAlbedo(material.model, values, 0, wi));
    energy->furnace.push_back(WeakFurnace(material.model, values, 0, wi));
    most = std::max(most, energy->bounce.back());
  }
  energy->high = most <= 1.02 ? 1.05 : most * 1.08;
  // The scatter of a mirror is thousandths of the light.
  if (double highest = 0; energy->bounce.empty()) {
    for (const std::vector<double>& albedo : energy->albedo)
      highest = std::max(highest, *std::max_element(albedo.begin(), albedo.end()));
    if (highest > 0 && highest < 0.1) energy->high = 1.2 * highest;
  }
  Panel panel;
  panel.id = "energy";
  panel.title = "Energy";
  panel.wide = false;
  panel.height = [](Canvas*, double) { return 316.0; };
  panel.draw = [energy, &data](Canvas* canvas, const Box& content) { Draw(data, *energy, canvas, content); };
  return panel;
}

}  // namespace lobefit

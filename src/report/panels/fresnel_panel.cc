// The Fresnel term of the first lobe over the angle to the micro normal, with its 95 % band.
#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/panels/curve_interval.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr int kAngles = 91;

struct FresnelCurves {
  std::vector<std::vector<double>> value, half_interval;  // [shown channel][degree]; no error: empty
  double high = 1, measured_to = 90;  // largest angle between a sample's direction and its half vector
};

void Draw(const ReportData& data, const FresnelCurves& curves, Canvas* canvas, const Box& content) {
  const Box room = Inset(content, 52, 4, 4, 84);
  const Box frame = {room.x, room.y, room.width, std::min(room.height, 0.8 * room.width)};
  const Axes axes(frame, {0, 90, false}, {0, curves.high, false});
  const std::vector<Tick> x_ticks = AngleTicks(0, 90, 4), y_ticks = LinearTicks(0, curves.high, 5);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  {
    const Canvas::Clip clip(canvas, frame);
    canvas->Line({axes.MapX(curves.measured_to), frame.y}, {axes.MapX(curves.measured_to), frame.bottom()},
                 {style::kSecondary, 1, 1, 5, 4});
    for (std::size_t k = 0; k < curves.value.size(); ++k) {
      const Rgb color = data.channel_colors[data.shown_channels[k]];
      std::vector<Point> line, band;
      for (int d = 0; d < kAngles; ++d) line.push_back(axes.Map(d, curves.value[k][static_cast<std::size_t>(d)]));
      const std::vector<double>& half = curves.half_interval[k];
      for (std::size_t d = 0; d < half.size(); ++d)
        band.push_back(axes.Map(static_cast<double>(d), curves.value[k][d] + half[d]));
      for (std::size_t d = half.size(); d-- > 0;)
        band.push_back(axes.Map(static_cast<double>(d), curves.value[k][d] - half[d]));
      if (!band.empty()) canvas->Polygon(band, color, 0.2);
      canvas->Polyline(line, {color, 1.5});
    }
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "θ_d  (degrees)");
  axes.DrawYLabel(canvas, "F", 38);
  canvas->Text({content.x, frame.bottom() + 58}, "Shade: 95 % interval. Dashed: no sample beyond this angle.",
               style::Note());
}

}  // namespace

std::optional<Panel> FresnelPanel(const ReportData& data) {
  const Material& material = data.material;
  const Model& model = material.model;
  if (model.lobes.empty() || model.lobes[0].fresnel == Fresnel::kNone) return std::nullopt;
  const auto curves = std::make_shared<FresnelCurves>();
  const std::size_t first = FirstFresnel(model, 0), count = FresnelParameters(model.lobes[0].fresnel);
  double most = 0;
  for (const std::size_t channel : data.shown_channels) {
    const auto curve = [&](const ParameterValues& values) {
      double parameters[kMaxFresnelParameters];
      for (std::size_t k = 0; k < count; ++k) parameters[k] = values[first + k][channel];
      std::vector<double> result;
      for (int d = 0; d < kAngles; ++d)
        result.push_back(FresnelFactor(model.lobes[0].fresnel, parameters, std::cos(DegreesToRadians(d)), nullptr));
      return result;
    };
    curves->value.push_back(curve(material.Values()));
    curves->half_interval.push_back(HalfIntervals(material, curve, [&](std::size_t p, std::size_t c) {
      return p >= first && p < first + count && c == channel;
    }));
    most = std::max(most, *std::max_element(curves->value.back().begin(), curves->value.back().end()));
  }
  curves->high = 1.08 * most;
  const Samples& samples = data.measurement.samples;
  double least = 1;
  for (std::size_t i = 0; i < samples.size(); ++i)
    least = std::min(least, Dot(samples.wi(i), HalfVector(samples.wi(i), samples.wo(i))));
  curves->measured_to = RadiansToDegrees(std::acos(std::clamp(least, 0.0, 1.0)));
  Panel panel;
  panel.id = "fresnel";
  panel.title = model.lobes.size() > 1 ? "Fresnel term of the first lobe" : "Fresnel term";
  panel.wide = false;
  panel.height = [](Canvas*, double) { return 300.0; };
  panel.draw = [curves, &data](Canvas* canvas, const Box& content) { Draw(data, *curves, canvas, content); };
  return panel;
}

}  // namespace lobefit

// The radial profile of the first lobe that has a free one, beside GGX of the same widths, with its 95 % band.
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

constexpr double kFrom = 0.1, kTo = 64;  // widths from the mean slope
constexpr int kPoints = 120;

struct ProfileCurve {
  std::vector<double> radius, log_density, half_interval, log_ggx;
  double measured_to = kTo;
};

// ln of the density of slopes over its peak at r widths.
double LogDensity(const Lobe& lobe, const std::vector<double>& numbers, double r) {
  if (FamilyOf(lobe.ndf) == Family::kStudent) return -numbers[0] * std::log1p(r * r / (numbers[0] - 1));
  const double u = std::log1p(r * r);
  return Profile(GridOf(lobe)->spline(), numbers).Excess(u) - 2 * u;
}

void Draw(const ProfileCurve& curve, Canvas* canvas, const Box& content) {
  const Box room = Inset(content, 52, 4, 4, 102);
  const Box frame = {room.x, room.y, room.width, std::min(room.height, 0.8 * room.width)};
  const Range x = {kFrom, kTo, true}, y = {1e-7, 2, true};
  const Axes axes(frame, x, y);
  const std::vector<Tick> x_ticks = LogTicks(x.low, x.high, 4), y_ticks = LogTicks(y.low, y.high, 5);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  {
    const Canvas::Clip clip(canvas, frame);
    const auto at = [&](std::size_t k, double log_density) {
      return axes.Map(curve.radius[k], std::exp(std::clamp(log_density, -40.0, 5.0)));
    };
    std::vector<Point> line, ggx, band;
    for (std::size_t k = 0; k < curve.radius.size(); ++k) {
      line.push_back(at(k, curve.log_density[k]));
      ggx.push_back(at(k, curve.log_ggx[k]));
    }
    for (std::size_t k = 0; k < curve.half_interval.size(); ++k)
      band.push_back(at(k, curve.log_density[k] + curve.half_interval[k]));
    for (std::size_t k = curve.half_interval.size(); k-- > 0;)
      band.push_back(at(k, curve.log_density[k] - curve.half_interval[k]));
    if (!band.empty()) canvas->Polygon(band, style::kInk, 0.2);
    if (curve.measured_to < kTo) {
      canvas->Line({axes.MapX(curve.measured_to), frame.y}, {axes.MapX(curve.measured_to), frame.bottom()},
                   {style::kSecondary, 1, 1, 5, 4});
    }
    canvas->Polyline(ggx, {style::kVermilion, 1.2, 1, 6, 4});
    canvas->Polyline(line, {style::kInk, 1.6});
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "slope from the mean, in widths α");
  axes.DrawYLabel(canvas, "density over its peak", 38);
  canvas->Text({content.x, frame.bottom() + 58}, "Black: fitted, shade: 95 % interval. Vermilion: GGX of the same α.",
               style::Note());
  canvas->Text({content.x, frame.bottom() + 74}, "Dashed grey: no sample beyond.", style::Note());
}

}  // namespace

std::optional<Panel> ProfilePanel(const ReportData& data) {
  const Material& material = data.material;
  const Model& model = material.model;
  const auto radial = [](const Lobe& lobe) {
    const Family family = FamilyOf(lobe.ndf);
    return family == Family::kProfile || family == Family::kStudent;
  };
  const auto found = std::find_if(model.lobes.begin(), model.lobes.end(), radial);
  if (found == model.lobes.end()) return std::nullopt;
  const auto lobe = static_cast<std::size_t>(found - model.lobes.begin());
  const std::size_t first = FirstParameter(model, lobe) + kEllipseParameters, end = FirstFresnel(model, lobe);
  const auto shared = std::make_shared<ProfileCurve>();
  for (int k = 0; k <= kPoints; ++k) {
    shared->radius.push_back(kFrom * std::pow(kTo / kFrom, static_cast<double>(k) / kPoints));
    shared->log_ggx.push_back(-2 * std::log1p(shared->radius.back() * shared->radius.back()));
  }
  const auto curve = [&](const ParameterValues& values) {
    std::vector<double> numbers, result;
    for (std::size_t p = first; p < end; ++p) numbers.push_back(values[p][0]);
    for (const double r : shared->radius) result.push_back(LogDensity(*found, numbers, r));
    return result;
  };
  shared->log_density = curve(material.Values());
  shared->half_interval =
      HalfIntervals(material, curve, [&](std::size_t p, std::size_t) { return p >= first && p < end; });
  const SlopeCoordinates& s = data.fitted.lobe_shapes()[lobe];
  const double a = std::exp(s.v[2]), c = std::exp(s.v[4]);
  const Samples& samples = data.measurement.samples;
  double most = 0;
  for (std::size_t i = 0; i < samples.size() && found->direction == LobeDirection::kSpecular; ++i) {
    const Vec3 h = HalfVector(samples.wi(i), samples.wo(i));
    const double y1 = (-h.x / h.z - s.v[0]) / a, y2 = (-h.y / h.z - s.v[1] - s.v[3] * y1) / c;
    most = std::max(most, std::hypot(y1, y2));
  }
  if (most > 0) shared->measured_to = most;
  Panel panel;
  panel.id = "profile";
  panel.title = lobe > 0 ? "Profile of lobe " + std::to_string(lobe + 1) : "Profile of the lobe";
  panel.wide = false;
  panel.height = [](Canvas*, double) { return 320.0; };
  panel.draw = [shared](Canvas* canvas, const Box& content) { Draw(*shared, canvas, content); };
  return panel;
}

}  // namespace lobefit

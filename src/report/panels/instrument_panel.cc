// What the fit assumed and found of its instrument: the discs against the lobe that they blur, gains of the incidences,
// the alignment of the sample.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr double kFrameHeight = 230, kLeft = 56, kGap = 26, kUnder = 58;
constexpr int kSteps = 240;

// A lobe at one incidence: viewers in the plane of incidence about the mirror direction.
struct Blur {
  double theta_i = 0, reach = 0;  // radians
  std::vector<double> offset;     // degrees from the mirror direction
  std::vector<double> surface, seen;
};

struct Instrument {
  const ReportData& data;
  const InstrumentUsed& used;
  std::optional<Blur> blur;
  std::size_t diagrams = 0;
  std::string words;
};

// At the most upright direction that was held, where the lobe is least skewed.
Blur BlurOf(const ReportData& data, const InstrumentUsed& used) {
  Blur blur;
  const Vec3 held = data.staying.directions.front();
  blur.theta_i = PolarAngle(held);
  const double width = NarrowestWidth(data.fitted.lobe_shapes()[0]);
  blur.reach =
      std::min(std::max(4 * std::atan(width), 2.5 * (used.source + used.detector)), 0.95 * kPi / 2 - blur.theta_i);
  std::vector<double> seen(data.channels()), surface(data.channels());
  const Vec3 mirror = {-held.x, -held.y, held.z};
  for (int k = 0; k <= kSteps; ++k) {
    const double offset = blur.reach * (2.0 * k / kSteps - 1);
    const Vec3 wo = FromSpherical(blur.theta_i + offset, std::atan2(mirror.y, mirror.x));
    blur.offset.push_back(RadiansToDegrees(offset));
    data.fitted.Evaluate(held, wo, surface.data());
    data.Read(held, wo, seen.data());
    blur.surface.push_back(data.Display(surface));
    blur.seen.push_back(data.Display(seen));
  }
  return blur;
}

std::string Words(const InstrumentUsed& used, const std::vector<std::string>& channels) {
  std::string words = "Bars and the ellipse: 95 %. Shaded: the discs, the scatter of the gains. Rings: the prior.";
  const auto add = [&words](const std::string& sentence) { words += (words.empty() ? "" : " ") + sentence; };
  if (used.source > 0 || used.detector > 0)
    add(fmt::format("Half angles of source and detector: {:.3g}° and {:.3g}°{}, {} mean.",
                    RadiansToDegrees(used.source), RadiansToDegrees(used.detector),
                    used.across > 0 ? fmt::format(" x {:.3g}°", RadiansToDegrees(used.across)) : std::string(),
                    used.mean));
  for (const InstrumentHalfAngle& half_angle : used.half_angles) {
    const ValueWithError value =
        RoundToError(RadiansToDegrees(half_angle.value), RadiansToDegrees(half_angle.standard_error));
    add(fmt::format("The {}'s was fitted, {}° ± {}° (given {:.3g}° ± {:.2g}°){}.", half_angle.name, value.value,
                    value.error, RadiansToDegrees(half_angle.given), RadiansToDegrees(half_angle.prior),
                    half_angle.determined ? "" : ": not determined"));
  }
  if (used.drift)
    add(fmt::format("Gains scatter by {:.2g} % ({}).", 100 * used.drift->sd,
                    used.drift->estimated ? "estimated" : "given"));
  if (used.told_from_tilt)
    add(*used.told_from_tilt ? "A crooked sample and a tilted lobe are told apart."
                             : "A crooked sample and a tilted lobe are not told apart.");
  for (std::size_t k = 2; k < used.alignment.size(); ++k)
    add(fmt::format("Turn {} off by {:.2g}° ± {:.2g}°.", k, RadiansToDegrees(used.alignment[k].value),
                    RadiansToDegrees(used.alignment[k].standard_error)));
  for (std::size_t c = 0; c < used.offset.size(); ++c) {
    const ValueWithError offset = RoundToError(used.offset[c].value, used.offset[c].standard_error);
    add(fmt::format("Offset {} {} ± {}/sr.", channels[c], offset.value, offset.error));
  }
  return words;
}

void DrawTitle(Canvas* canvas, const Box& frame, const std::string& title) {
  TextStyle bold = style::Body();
  bold.weight = Weight::kBold;
  canvas->Text({frame.x, frame.y - 8}, canvas->Shorten(title, bold, frame.width), bold);
}

void DrawBlur(const Instrument& instrument, Canvas* canvas, const Box& frame) {
  const Blur& blur = *instrument.blur;
  const double reach = RadiansToDegrees(blur.reach);
  const double high = std::max(*std::max_element(blur.surface.begin(), blur.surface.end()),
                               *std::max_element(blur.seen.begin(), blur.seen.end()));
  const double low = std::max(*std::min_element(blur.seen.begin(), blur.seen.end()), 1e-5 * high);
  const Range values = LogRangeAround(low, 1.2 * high);
  const Axes axes(frame, {-reach, reach, false}, values);
  const std::vector<Tick> x_ticks = LinearTicks(-reach, reach, 5), y_ticks = LogTicks(values.low, values.high, 4);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  {
    const Canvas::Clip clip(canvas, frame);
    for (const double half_angle : {instrument.used.source, instrument.used.detector}) {
      const double degrees = RadiansToDegrees(half_angle);
      canvas->Fill({axes.MapX(-degrees), frame.y, axes.MapX(degrees) - axes.MapX(-degrees), frame.height},
                   style::kFaint, 0.25);
    }
    std::vector<Point> surface, seen;
    for (std::size_t k = 0; k < blur.offset.size(); ++k) {
      surface.push_back(axes.Map(blur.offset[k], std::max(blur.surface[k], values.low * 0.1)));
      seen.push_back(axes.Map(blur.offset[k], std::max(blur.seen[k], values.low * 0.1)));
    }
    canvas->Polyline(surface, {style::kBlue, 1.5, 1, 5, 3});
    canvas->Polyline(seen, {style::kInk, 1.5});
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "degrees from the mirror direction");
  axes.DrawYLabel(canvas, "f_r  (1/sr)", kLeft - 14);
  DrawTitle(canvas, frame, "Lobe at " + Degrees(blur.theta_i));
}

void DrawGains(const InstrumentUsed& used, Canvas* canvas, const Box& frame) {
  double spread = 2.5 * used.drift->sd, farthest = 0;
  for (const IncidenceGain& gain : used.gains) {
    spread = std::max(spread, std::fabs(gain.gain - 1) + 2 * gain.standard_error);
    farthest = std::max(farthest, RadiansToDegrees(gain.theta_i));
  }
  spread = std::max(1.1 * spread, 0.002);
  const Axes axes(frame, {0, std::max(10.0, 1.05 * farthest), false}, {1 - spread, 1 + spread, false});
  const std::vector<Tick> x_ticks = AngleTicks(0, std::max(10.0, 1.05 * farthest), 4),
                          y_ticks = LinearTicks(1 - spread, 1 + spread, 5);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  {
    const Canvas::Clip clip(canvas, frame);
    const double top = axes.MapY(1 + used.drift->sd);
    canvas->Fill({frame.x, top, frame.width, axes.MapY(1 - used.drift->sd) - top}, style::kFaint, 0.25);
    canvas->Line({frame.x, axes.MapY(1)}, {frame.right(), axes.MapY(1)}, {style::kFaint, 1});
    for (const IncidenceGain& gain : used.gains) {
      const double x = axes.MapX(RadiansToDegrees(gain.theta_i));
      canvas->Line({x, axes.MapY(gain.gain - 1.96 * gain.standard_error)},
                   {x, axes.MapY(gain.gain + 1.96 * gain.standard_error)}, {style::kBlue, 1, 0.6});
      canvas->Disc({x, axes.MapY(gain.gain)}, 2.3, style::kBlue, 0.8);
    }
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "θ_i  (degrees)");
  axes.DrawYLabel(canvas, "gain", kLeft - 14);
  DrawTitle(canvas, frame, "Gains");
}

// The 95 % region of e_x and e_y.
std::vector<Point> Ellipse(const Axes& axes, const InstrumentUsed& used) {
  const double factor = std::sqrt(5.991464547107979);  // chi squared of 2 degrees of freedom at 95 %
  const double r = used.alignment_correlation, skew = std::sqrt(std::max(0.0, 1 - r * r));
  const InstrumentAngle &x = used.alignment[0], &y = used.alignment[1];
  std::vector<Point> points;
  for (int k = 0; k <= 72; ++k) {
    const double c = std::cos(k * kPi / 36), s = std::sin(k * kPi / 36);
    points.push_back(axes.Map(RadiansToDegrees(x.value + factor * x.standard_error * c),
                              RadiansToDegrees(y.value + factor * y.standard_error * (r * c + skew * s))));
  }
  return points;
}

void DrawAlignment(const InstrumentUsed& used, Canvas* canvas, const Box& frame) {
  const double prior = RadiansToDegrees(used.alignment[0].prior);
  double reach = 2.6 * prior;
  for (std::size_t k = 0; k < 2; ++k) {
    const InstrumentAngle& angle = used.alignment[k];
    const double error = std::isfinite(angle.standard_error) ? angle.standard_error : 0;
    reach = std::max(reach, 1.1 * RadiansToDegrees(std::fabs(angle.value) + 2.5 * error));
  }
  // Equal scales, so that the prior is a circle.
  const double wide = reach * std::max(1.0, frame.width / frame.height),
               high = reach * std::max(1.0, frame.height / frame.width);
  const Axes axes(frame, {-wide, wide, false}, {-high, high, false});
  const std::vector<Tick> x_ticks = LinearTicks(-wide, wide, 5), y_ticks = LinearTicks(-high, high, 5);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  {
    const Canvas::Clip clip(canvas, frame);
    const Point zero = axes.Map(0, 0);
    for (const double sigmas : {1.0, 2.0})
      canvas->Ring(zero, axes.MapX(sigmas * prior) - zero.x, {style::kFaint, 1, 1, 4, 3});
    const std::vector<Point> region = Ellipse(axes, used);
    canvas->Polygon(region, style::kBlue, 0.2);
    canvas->Polyline(region, {style::kBlue, 1.2});
    canvas->Disc(axes.Map(RadiansToDegrees(used.alignment[0].value), RadiansToDegrees(used.alignment[1].value)), 2.6,
                 style::kBlue);
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, "e_x  (degrees)");
  axes.DrawYLabel(canvas, "e_y  (degrees)", kLeft - 14);
  DrawTitle(canvas, frame, "Alignment");
}

void Draw(const Instrument& instrument, Canvas* canvas, const Box& content) {
  const auto count = static_cast<double>(instrument.diagrams);
  const double width = count == 0 ? 0 : (content.width - 4 - kGap * (count - 1)) / count;
  double x = content.x, y = content.y + 6;
  if (instrument.diagrams > 0) {
    const auto next = [&] {
      const Box frame = {x + kLeft, content.y + 24, width - kLeft, kFrameHeight};
      x += width + kGap;
      return frame;
    };
    if (instrument.blur) DrawBlur(instrument, canvas, next());
    if (!instrument.used.gains.empty()) DrawGains(instrument.used, canvas, next());
    if (!instrument.used.alignment.empty()) DrawAlignment(instrument.used, canvas, next());
    y = content.y + 24 + kFrameHeight + kUnder;
  }
  for (const std::string& line : canvas->Wrap(instrument.words, style::Note(), content.width)) {
    canvas->Text({content.x, y}, line, style::Note());
    y += 16;
  }
}

}  // namespace

std::optional<Panel> InstrumentPanel(const ReportData& data) {
  if (!data.reading) return std::nullopt;
  const auto instrument = std::make_shared<Instrument>(Instrument{data, *data.material.instrument, {}, 0, {}});
  const InstrumentUsed& used = instrument->used;
  const bool discs = used.source > 0 || used.detector > 0;
  if (discs && !data.fitted.lobe_shapes().empty() && !data.staying.directions.empty())
    instrument->blur = BlurOf(data, used);
  instrument->diagrams =
      (instrument->blur ? 1U : 0U) + (used.gains.empty() ? 0U : 1U) + (used.alignment.empty() ? 0U : 1U);
  instrument->words = Words(used, data.material.channels);
  Panel panel;
  panel.id = "instrument";
  panel.title = "Instrument";
  panel.wide = instrument->diagrams > 1;
  if (instrument->blur) {
    panel.legend = {{LegendEntry::Mark::kLine, style::kInk, "as read"},
                    {LegendEntry::Mark::kLine, style::kBlue, "surface, dashed"}};
  }
  panel.height = [instrument](Canvas* canvas, double width) {
    const auto lines = static_cast<double>(canvas->Wrap(instrument->words, style::Note(), width).size());
    return (instrument->diagrams > 0 ? 24 + kFrameHeight + kUnder : 6) + 16 * lines;
  };
  panel.draw = [instrument](Canvas* canvas, const Box& content) { Draw(*instrument, canvas, content); };
  return panel;
}

}  // namespace lobefit

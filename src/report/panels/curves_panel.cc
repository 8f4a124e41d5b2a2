// In-plane slices: measured points, the fitted curve, the band in which the residuals lie, and under each slice
// measured / fitted.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/figures/slices.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostRows = 3, kMostColumns = 3;
constexpr double kLeft = 60, kBottom = 40, kGapX = 16, kGapY = 18, kStripShare = 0.21, kStripGap = 8;
constexpr double kMostDecades = 6;

struct Curves {
  const ReportData& data;
  const Slices& slices;
  std::vector<const Slice*> chosen;
  std::size_t rows = 0, columns = 0;
  std::size_t azimuths = 1;         // 1: not worth a label
  std::vector<ResidualBand> bands;  // one for each of data.shown_channels
  Range values;                     // of f_r
  double ratio = 1;                 // the strips reach from 1 / ratio to ratio
  std::size_t not_shown = 0;        // points of the chosen slices below the scale

  explicit Curves(const ReportData& d) : data(d), slices(d.slices()) {
    for (const std::size_t channel : d.shown_channels) bands.emplace_back(d, channel);
    chosen = ChooseSlices(slices, kMostRows, kMostColumns, &rows, &columns);
    for (const Slice* slice : chosen) {
      if (slice != nullptr && std::fabs(slice->phi - chosen.front()->phi) > 0.01) azimuths = 2;
    }
  }
};

// Fitted values along a slice, every quarter of a degree.
struct FittedCurve {
  std::vector<double> degrees, theta_h;
  std::vector<std::vector<double>> f_r;      // [channel], as the instrument reads it
  std::vector<std::vector<double>> surface;  // [channel], without the instrument; empty: there is none
};

FittedCurve EvaluateCurve(const Curves& curves, const Slice& slice) {
  FittedCurve curve;
  std::array<std::vector<double>, 6> d;
  for (int k = -359; k <= 359; ++k) {
    Vec3 wi, wo;
    SliceDirections(curves.slices, slice, DegreesToRadians(k * 0.25), &wi, &wo);
    curve.degrees.push_back(k * 0.25);
    curve.theta_h.push_back(PolarAngle(HalfVector(wi, wo)));
    const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t j = 0; j < 6; ++j) d[j].push_back(all[j]);
  }
  const DirectionArrays directions = {d[0].data(), d[1].data(), d[2].data(),         d[3].data(),
                                      d[4].data(), d[5].data(), curve.degrees.size()};
  const std::vector<double>& turns = curves.data.measurement.samples.sample_azimuth;
  const std::vector<double> turn(turns.empty() ? 0 : directions.count,
                                 turns.empty() ? 0 : turns[slice.points.front().sample]);
  curves.data.Read(directions, turn.empty() ? nullptr : turn.data(), &curve.f_r);
  if (curves.data.reading) curves.data.fitted.Evaluate(directions, &curve.surface);
  return curve;
}

void FindRanges(Curves* curves) {
  std::vector<double> measured, fitted, ratios;
  double high = 0;
  for (const Slice* slice : curves->chosen) {
    if (slice == nullptr) continue;
    for (const SlicePoint& point : slice->points) {
      for (const std::size_t c : curves->data.shown_channels) {
        const double m = curves->data.measurement.samples.values[c][point.sample],
                     f = curves->data.fitted_values[c][point.sample];
        if (m > 0) measured.push_back(m);
        if (f > 0) fitted.push_back(f);
        high = std::max({high, m, f});
        if (m > 0 && f > 0) ratios.push_back(std::fabs(std::log(m / f)));
      }
    }
  }
  if (!(high > 0)) high = 1;
  double low = high / 10;
  if (!measured.empty()) low = std::min(low, Quantile(&measured, 0.02));
  if (!fitted.empty()) low = std::min(low, Quantile(&fitted, 0.05));
  low = std::max(low, high * std::pow(10, -kMostDecades));
  curves->values = LogRangeAround(low / 1.1, high * 1.25);
  const double spread = ratios.empty() ? 0.1 : Quantile(&ratios, 0.95);
  curves->ratio = 10;
  for (const double nice : {5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.05, 1.02, 1.01}) {
    if (std::log(nice) >= 1.1 * spread) curves->ratio = nice;
  }
  for (const Slice* slice : curves->chosen) {
    if (slice == nullptr) continue;
    for (const SlicePoint& point : slice->points) {
      for (const std::size_t c : curves->data.shown_channels) {
        curves->not_shown += curves->data.measurement.samples.values[c][point.sample] < curves->values.low ? 1 : 0;
      }
    }
  }
}

// Darker than the points, so that the line stays visible among them.
Rgb CurveColor(const ReportData& data, std::size_t channel) {
  if (data.channels() == 1) return style::kInk;
  const Rgb c = data.channel_colors[channel];
  const auto darker = [](int v) { return static_cast<std::uint8_t>(v * 7 / 10); };
  return {darker(c.r), darker(c.g), darker(c.b)};
}

void DrawSlice(const Curves& curves, const Slice& slice, Canvas* canvas, const Box& cell, bool x_labels,
               bool y_labels) {
  const ReportData& data = curves.data;
  const double strip = std::round(cell.height * kStripShare);
  const Box main = {cell.x, cell.y, cell.width, cell.height - strip - kStripGap},
            under = {cell.x, cell.bottom() - strip, cell.width, strip};
  // A little beyond the ticks, so that their labels keep clear of the neighbours'.
  const double reach = std::pow(curves.ratio, 1.4);
  const Range angles = {-90, 90, false}, ratios = {1 / reach, reach, true};
  const Axes axes(main, angles, curves.values), strip_axes(under, angles, ratios);
  std::vector<Tick> x_ticks = AngleTicks(-90, 90, cell.width > 190 ? 6 : 4);
  for (Tick& tick : x_ticks) {
    if (std::fabs(tick.value) > 89) tick.label.clear();
  }
  const std::vector<Tick> y_ticks =
      LogTicks(curves.values.low, curves.values.high, std::max(3, static_cast<int>(main.height / 34)));
  std::vector<Tick> ratio_ticks = {
      {1 / curves.ratio, RatioText(1 / curves.ratio)}, {1, "1"}, {curves.ratio, RatioText(curves.ratio)}};
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  strip_axes.DrawGrid(canvas, x_ticks, ratio_ticks);
  const FittedCurve curve = EvaluateCurve(curves, slice);
  {
    const Canvas::Clip clip(canvas, main);
    const double mirror = axes.MapX(RadiansToDegrees(slice.theta));
    canvas->Line({mirror, main.y}, {mirror, main.bottom()}, {style::kFaint, 1, 1, 4, 3});
    const double first = RadiansToDegrees(slice.points.front().theta) - 1,
                 last = RadiansToDegrees(slice.points.back().theta) + 1;
    const double mute = data.shown_channels.size() > 1 ? 0.12 : 0.2;
    for (std::size_t shown = 0; shown < data.shown_channels.size(); ++shown) {
      const std::size_t c = data.shown_channels[shown];
      std::vector<Point> outline;
      std::vector<Point> back;
      for (std::size_t k = 0; k < curve.degrees.size(); ++k) {
        const double f = curve.f_r[c][k];
        // No residual is known where the slice has no samples.
        if (!(f > 0) || curve.degrees[k] < first || curve.degrees[k] > last) continue;
        const ResidualBand::Quantiles q = curves.bands[shown].At(curve.theta_h[k]);
        const double x = curve.degrees[k], floor = curves.values.low * 1e-2;

        outline.push_back(axes.Map(x, std::max(f * std::exp(q.high), floor)));
        back.push_back(axes.Map(x, std::max(f * std::exp(q.low), floor)));
      }
      outline.insert(outline.end(), back.rbegin(), back.rend());
      canvas->Polygon(outline, data.channel_colors[c], mute);
    }
    const double radius = slice.points.size() > 400 ? 1.3 : slice.points.size() > 120 ? 1.6 : 2.1;
    for (const std::size_t c : data.shown_channels) {
      for (const SlicePoint& point : slice.points) {
        const double m = data.measurement.samples.values[c][point.sample];
        if (m >= curves.values.low)
          canvas->Disc(axes.Map(RadiansToDegrees(point.theta), m), radius, data.channel_colors[c], 0.5);
      }
    }
    for (const std::size_t c : data.shown_channels) {
      std::vector<Point> line;
      for (std::size_t k = 0; k < curve.degrees.size() && !curve.surface.empty(); ++k)
        line.push_back(axes.Map(curve.degrees[k], std::max(curve.surface[c][k], curves.values.low * 1e-2)));
      if (!line.empty()) canvas->Polyline(line, {CurveColor(data, c), 1, 0.7, 4, 3});
      line.clear();
      for (std::size_t k = 0; k < curve.degrees.size(); ++k) {
        const double f = curve.f_r[c][k];
        line.push_back(axes.Map(curve.degrees[k], std::max(f, curves.values.low * 1e-2)));
      }
      canvas->Polyline(line, {CurveColor(data, c), 1});
    }
  }
  {
    const Canvas::Clip clip(canvas, under);
    canvas->Line(strip_axes.Map(-90, 1), strip_axes.Map(90, 1), {style::kFaint, 1});
    for (const std::size_t c : data.shown_channels) {
      for (const SlicePoint& point : slice.points) {
        const double ratio = std::exp(data.LogRatio(c, point.sample));
        if (std::isnan(ratio)) continue;
        const double inside = std::clamp(ratio, 1.01 / reach, reach / 1.01);
        canvas->Disc(strip_axes.Map(RadiansToDegrees(point.theta), inside), slice.points.size() > 120 ? 1.1 : 1.5,
                     data.channel_colors[c], 0.7);
      }
    }
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks, false, y_labels);
  if (y_labels) axes.DrawYLabel(canvas, "f_r  (1/sr)", kLeft - 14);
  strip_axes.DrawFrame(canvas, x_ticks, ratio_ticks, x_labels, y_labels);

  const std::string label = (curves.slices.outgoing_stays ? "θ_o = " : "θ_i = ") + Degrees(slice.theta);
  TextStyle text = {.size = style::kBodySize,
                    .color = style::kInk,
                    .weight = Weight::kBold,
                    .baseline = Baseline::kTop,
                    .markup = true};
  canvas->Text({main.x + 8, main.y + 8}, label, text);
  if (curves.azimuths > 1) {
    text.weight = Weight::kRegular;
    text.color = style::kSecondary;
    canvas->Text({main.x + 8, main.y + 25}, (curves.slices.outgoing_stays ? "φ_o = " : "φ_i = ") + Degrees(slice.phi),
                 text);
  }
}

void Draw(const Curves& curves, Canvas* canvas, const Box& content) {
  const Box area = Inset(content, kLeft, 4, 4, kBottom + 36);
  const double width =
      (area.width - kGapX * static_cast<double>(curves.columns - 1)) / static_cast<double>(curves.columns);
  const double height = (area.height - kGapY * static_cast<double>(curves.rows - 1)) / static_cast<double>(curves.rows);
  for (std::size_t i = 0; i < curves.chosen.size(); ++i) {
    if (curves.chosen[i] == nullptr) continue;
    const std::size_t row = i / curves.columns, column = i % curves.columns;
    const Box cell = {area.x + static_cast<double>(column) * (width + kGapX),
                      area.y + static_cast<double>(row) * (height + kGapY), width, height};
    // The lowest slice of a column carries the angles.
    const bool last = i + curves.columns >= curves.chosen.size() || curves.chosen[i + curves.columns] == nullptr;
    DrawSlice(curves, *curves.chosen[i], canvas, cell, last, column == 0);
  }
  const Axes whole(area, {0, 1, false}, {0, 1, false});
  whole.DrawXLabel(canvas, curves.slices.outgoing_stays ? "θ_i  (degrees; the mirror direction, dashed, is positive)"
                                                        : "θ_o  (degrees; the mirror direction, dashed, is positive)");
  std::string note =
      "Lower strips: measured / fitted. " +
      Join({"Samples within ", Number(RadiansToDegrees(curves.slices.tolerance), 2), "° of the plane."}, "");
  if (curves.slices.gathered) note += " θ_i gathered within 0.5°, points moved along so that θ_h is kept.";
  if (curves.not_shown > 0)
    note +=
        Join({" ", Count(curves.not_shown),
              curves.not_shown == 1 ? " value below the scale or negative." : " values below the scale or negative."},
             "");
  TextStyle small = style::Note();
  small.markup = true;
  double y = content.bottom() - 21;
  for (const std::string& line : canvas->Wrap(note, small, area.width)) {
    canvas->Text({area.x, y}, line, small);
    y += 16;
  }
}

}  // namespace

std::optional<Panel> CurvesPanel(const ReportData& data) {
  const auto curves = std::make_shared<Curves>(data);
  if (curves->chosen.empty()) return std::nullopt;
  FindRanges(curves.get());
  Panel panel;
  panel.id = "curves";
  panel.title = "In-plane curves";
  panel.grows = true;
  const Rgb neutral = data.channels() == 1 ? data.channel_colors[0] : style::kSecondary;
  if (data.channels() > 1) {
    for (const std::size_t c : data.shown_channels)
      panel.legend.push_back({LegendEntry::Mark::kSwatch, data.channel_colors[c], data.channel_names[c]});
  }
  panel.legend.push_back({LegendEntry::Mark::kDot, neutral, "measured"});
  panel.legend.push_back({LegendEntry::Mark::kLine, data.channels() == 1 ? style::kInk : neutral,
                          data.reading ? "fitted, as read; dashed: surface" : "fitted"});
  panel.legend.push_back({LegendEntry::Mark::kBand, neutral, "5–95 % of residuals"});
  panel.height = [curves](Canvas*, double) {
    return static_cast<double>(curves->rows) * (curves->rows == 1 ? 400.0 : 290.0) + kBottom + 54;
  };
  panel.draw = [curves](Canvas* canvas, const Box& content) { Draw(*curves, canvas, content); };
  return panel;
}

}  // namespace lobefit

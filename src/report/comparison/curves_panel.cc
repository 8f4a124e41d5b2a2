// In-plane slices with the curves of all compared models.
#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/comparison/panels.h"
#include "lobefit/report/figures/slices.h"

namespace lobefit {
namespace {

std::vector<LegendEntry> ModelLegend(const Compared& compared) {
  std::vector<LegendEntry> legend;
  for (const Compared::Entry& entry : compared.models)
    legend.push_back({LegendEntry::Mark::kLine, entry.color, entry.label});
  return legend;
}

constexpr std::size_t kMostRows = 2, kMostColumns = 3;
constexpr double kLeft = 60, kBottom = 40, kGapX = 16, kGapY = 18, kStripShare = 0.3, kStripGap = 8;

struct Curves {
  Slices slices;
  std::vector<const Slice*> chosen;
  std::size_t rows = 0, columns = 0;
  bool azimuths = false;
  Range values;
  double ratio = 2;
};

struct Line {
  std::vector<double> degrees, value;
};

Line EvaluateLine(const ReportData& data, const Slices& slices, const Slice& slice) {
  Line line;
  std::vector<double> f_r(data.channels());
  for (int k = -359; k <= 359; ++k) {
    Vec3 wi, wo;
    SliceDirections(slices, slice, DegreesToRadians(k * 0.25), &wi, &wo);
    data.fitted.Evaluate(wi, wo, f_r.data());
    line.degrees.push_back(k * 0.25);
    line.value.push_back(data.Display(f_r));
  }
  return line;
}

double FittedDisplay(const ReportData& data, std::size_t sample) {
  double sum = 0;
  for (std::size_t c = 0; c < data.channels(); ++c)
    sum += data.display_weights[c] * static_cast<double>(data.fitted_values[c][sample]);
  return sum;
}

void FindRanges(const Compared& compared, Curves* curves) {
  std::vector<double> measured, ratios;
  double high = 0;
  for (const Slice* slice : curves->chosen) {
    if (slice == nullptr) continue;
    for (const SlicePoint& point : slice->points) {
      const double m = compared.first().Display(compared.first().measurement.samples.values, point.sample);
      high = std::max(high, m);
      if (!(m > 0)) continue;
      measured.push_back(m);
      for (const Compared::Entry& entry : compared.models) {
        const double f = FittedDisplay(*entry.data, point.sample);
        if (f > 0) ratios.push_back(std::fabs(std::log(m / f)));
      }
    }
  }
  if (!(high > 0)) high = 1;
  double low = high / 10;
  if (!measured.empty()) low = std::min(low, Quantile(&measured, 0.02) / 2);
  curves->values = LogRangeAround(std::max(low, high * 1e-6), high * 1.5);
  const double spread = ratios.empty() ? 0.1 : Quantile(&ratios, 0.9);
  curves->ratio = 10;
  for (const double nice : {5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.05}) {
    if (std::log(nice) >= spread) curves->ratio = nice;
  }
}

// Below each slice, measured / fitted at the samples, joined: which model follows the data where.
void DrawStrip(const Compared& compared, const Slice& slice, const Axes& axes, double reach, Canvas* canvas) {
  const Canvas::Clip clip(canvas, axes.frame());
  canvas->Line(axes.Map(-90, 1), axes.Map(90, 1), {style::kFaint, 1});
  for (auto entry = compared.models.rbegin(); entry != compared.models.rend(); ++entry) {
    std::vector<Point> line;
    double last = -1e9;
    for (const SlicePoint& point : slice.points) {
      const double m = entry->data->Display(entry->data->measurement.samples.values, point.sample),
                   f = FittedDisplay(*entry->data, point.sample), x = RadiansToDegrees(point.theta);
      // A gap in the data is one in the line.
      if (x - last > 12 || !(m > 0) || !(f > 0)) line.push_back({std::nan(""), std::nan("")});
      if (m > 0 && f > 0) line.push_back(axes.Map(x, std::clamp(m / f, 1 / reach, reach)));
      last = x;
    }
    canvas->Polyline(line, {entry->color, 1, 0.9});
  }
}

void DrawSlice(const Compared& compared, const Curves& curves, const Slice& slice, Canvas* canvas, const Box& cell,
               bool x_labels, bool y_labels) {
  const double strip = std::round(cell.height * kStripShare);
  const Box main = {cell.x, cell.y, cell.width, cell.height - strip - kStripGap},
            under = {cell.x, cell.bottom() - strip, cell.width, strip};
  const double reach = std::pow(curves.ratio, 1.4);
  const Axes axes(main, {-90, 90, false}, curves.values), strip_axes(under, {-90, 90, false}, {1 / reach, reach, true});
  std::vector<Tick> x_ticks = AngleTicks(-90, 90, 6);
  for (Tick& tick : x_ticks) {
    if (std::fabs(tick.value) > 89) tick.label.clear();
  }
  const std::vector<Tick> y_ticks =
      LogTicks(curves.values.low, curves.values.high, std::max(3, static_cast<int>(main.height / 34)));
  const std::vector<Tick> ratio_ticks = {
      {1 / curves.ratio, RatioText(1 / curves.ratio)}, {1, "1"}, {curves.ratio, RatioText(curves.ratio)}};
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  strip_axes.DrawGrid(canvas, x_ticks, ratio_ticks);
  const ReportData& data = compared.first();
  {
    const Canvas::Clip clip(canvas, main);
    const double mirror = axes.MapX(RadiansToDegrees(slice.theta));
    canvas->Line({mirror, main.y}, {mirror, main.bottom()}, {style::kFaint, 1, 1, 4, 3});
    const double radius = slice.points.size() > 400 ? 1.4 : slice.points.size() > 120 ? 1.8 : 2.4;
    for (const SlicePoint& point : slice.points) {
      const double m = data.Display(data.measurement.samples.values, point.sample);
      if (m >= curves.values.low) canvas->Disc(axes.Map(RadiansToDegrees(point.theta), m), radius, style::kFaint, 0.7);
    }
    // The best one last, on top.
    for (auto entry = compared.models.rbegin(); entry != compared.models.rend(); ++entry) {
      const Line line = EvaluateLine(*entry->data, curves.slices, slice);
      std::vector<Point> points;
      for (std::size_t k = 0; k < line.degrees.size(); ++k)
        points.push_back(axes.Map(line.degrees[k], std::max(line.value[k], curves.values.low * 1e-2)));
      canvas->Polyline(points, {entry->color, 1.3});
    }
  }
  DrawStrip(compared, slice, strip_axes, reach, canvas);
  axes.DrawFrame(canvas, x_ticks, y_ticks, false, y_labels);
  if (y_labels) axes.DrawYLabel(canvas, "f_r  (1/sr)", kLeft - 14);
  strip_axes.DrawFrame(canvas, x_ticks, ratio_ticks, x_labels, y_labels);
  TextStyle text = {.size = style::kBodySize,
                    .color = style::kInk,
                    .weight = Weight::kBold,
                    .baseline = Baseline::kTop,
                    .markup = true};
  const char* side = curves.slices.outgoing_stays ? "_o = " : "_i = ";
  canvas->Text({main.x + 8, main.y + 8}, "θ" + (side + Degrees(slice.theta)), text);
  if (curves.azimuths) {
    text.weight = Weight::kRegular;
    text.color = style::kSecondary;
    canvas->Text({main.x + 8, main.y + 25}, "φ" + (side + Degrees(slice.phi)), text);
  }
}

void DrawCurves(const Compared& compared, const Curves& curves, Canvas* canvas, const Box& content) {
  const Box area = Inset(content, kLeft, 4, 4, kBottom + 22);
  const double width =
      (area.width - kGapX * static_cast<double>(curves.columns - 1)) / static_cast<double>(curves.columns);
  const double height = (area.height - kGapY * static_cast<double>(curves.rows - 1)) / static_cast<double>(curves.rows);
  for (std::size_t i = 0; i < curves.chosen.size(); ++i) {
    if (curves.chosen[i] == nullptr) continue;
    const std::size_t row = i / curves.columns, column = i % curves.columns;
    const bool last = i + curves.columns >= curves.chosen.size() || curves.chosen[i + curves.columns] == nullptr;
    DrawSlice(compared, curves, *curves.chosen[i], canvas,
              {area.x + static_cast<double>(column) * (width + kGapX),
               area.y + static_cast<double>(row) * (height + kGapY), width, height},
              last, column == 0);
  }
  const Axes whole(area, {0, 1, false}, {0, 1, false});
  whole.DrawXLabel(canvas, curves.slices.outgoing_stays ? "θ_i  (degrees; the mirror direction, dashed, is positive)"
                                                        : "θ_o  (degrees; the mirror direction, dashed, is positive)");
  std::string note = "Lower strips: measured / fitted.";
  if (compared.first().channels() > 1) note += " One number a sample: luminance, or the mean of the channels.";
  canvas->Text({area.x, content.bottom() - 4}, note, style::Note());
}

}  // namespace

std::optional<Panel> ComparedCurvesPanel(const Compared& compared) {
  const auto curves = std::make_shared<Curves>();
  curves->slices = compared.first().slices();
  curves->chosen = ChooseSlices(curves->slices, kMostRows, kMostColumns, &curves->rows, &curves->columns);
  if (curves->chosen.empty()) return std::nullopt;
  for (const Slice* slice : curves->chosen)
    curves->azimuths = curves->azimuths || (slice != nullptr && std::fabs(slice->phi - curves->chosen[0]->phi) > 0.01);
  FindRanges(compared, curves.get());
  Panel panel;
  panel.id = "curves";
  panel.title = "In-plane curves";
  panel.legend = ModelLegend(compared);
  panel.legend.insert(panel.legend.begin(), {LegendEntry::Mark::kDot, style::kFaint, "measured"});
  panel.height = [curves](Canvas*, double) {
    return static_cast<double>(curves->rows) * (curves->rows == 1 ? 400.0 : 330.0) + kBottom + 30;
  };
  panel.draw = [&compared, curves](Canvas* canvas, const Box& content) {
    DrawCurves(compared, *curves, canvas, content);
  };
  return panel;
}

}  // namespace lobefit

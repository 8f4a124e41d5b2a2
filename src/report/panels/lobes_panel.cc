// A table of squared ellipsoidal lobes over the polar angle of incidence: widths, amplitudes, and how far the lobes
// stand from the mirror direction.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr std::array<Rgb, 3> kLobeColors = {style::kBlue, style::kVermilion, style::kGreen};
constexpr double kMostDecades = 5, kLeft = 54, kGap = 58, kBelow = 44;

// A number of a slice, drawn over theta_i: a dot a slice and a line through the table.
struct Row {
  std::function<double(const SelSlice&)> value;
  Rgb color;
  bool dashed = false;
};

struct Diagram {
  std::string label;
  std::vector<Row> rows;
  bool logarithmic = true;
  double most = 1e300;  // the numbers are not above this
  Range range;
};

struct Lobes {
  const ReportData& data;
  std::vector<SelSlice> along;  // the table at the azimuth of the lines
  double azimuth = 0;
  bool one_azimuth = true;
  std::vector<Diagram> diagrams;

  const SelTable& table() const { return data.fitted.table()->table(); }
};

// The azimuth that has the most slices, a bin of a degree each; the first of several.
double CommonAzimuth(const SelTable& table) {
  std::map<long, std::size_t> count;
  const auto bin = [](const SelSlice& slice) { return std::lround(RadiansToDegrees(slice.phi_i)); };
  for (const SelSlice& slice : table.slices) ++count[bin(slice)];
  const SelSlice* best = &table.slices.front();
  for (const SelSlice& slice : table.slices) {
    if (count[bin(slice)] > count[bin(*best)]) best = &slice;
  }
  return best->phi_i;
}

std::vector<Diagram> MakeDiagrams(const ReportData& data) {
  const SelTable& table = data.fitted.table()->table();
  Diagram widths = {"width  α_x, α_y", {}, true, 1, {}}, levels = {"", {}, true, 1e300, {}},
          offsets = {"offset from the mirror  (degrees)", {}, false, 1e300, {}};
  levels.label = table.quantity == SelQuantity::kBrdf ? "amplitude of f_r  (1/sr)" : "amplitude of f_r cos θ_o  (1/sr)";
  for (std::size_t l = 0; l < table.slices[0].lobes.size(); ++l) {
    const Rgb color = kLobeColors[l % kLobeColors.size()];
    widths.rows.push_back({[l](const SelSlice& s) { return s.lobes[l].alpha_x; }, color, false});
    widths.rows.push_back({[l](const SelSlice& s) { return s.lobes[l].alpha_y; }, color, true});
    levels.rows.push_back({[l, &data](const SelSlice& s) { return data.Display(s.amplitude[l]); }, color, false});
    offsets.rows.push_back({[l](const SelSlice& s) { return RadiansToDegrees(s.lobes[l].offset_in); }, color, false});
    offsets.rows.push_back(
        {[l](const SelSlice& s) { return RadiansToDegrees(s.lobes[l].offset_across); }, color, true});
  }
  levels.rows.push_back({[&data](const SelSlice& s) { return data.Display(s.constant); }, style::kSecondary, false});
  return {widths, levels, offsets};
}

void FindRange(const SelTable& table, Diagram* diagram) {
  double low = 1e300, high = -1e300;
  for (const SelSlice& slice : table.slices) {
    for (const Row& row : diagram->rows) {
      low = std::min(low, row.value(slice));
      high = std::max(high, row.value(slice));
    }
  }
  if (diagram->logarithmic) {
    high = std::max(high, 1e-30);
    diagram->range =
        LogRangeAround(std::max(low, high * std::pow(10, -kMostDecades)) / 1.1, std::min(high * 1.1, diagram->most));
    return;
  }
  const double margin = std::max(1.0, 0.08 * (high - low));
  diagram->range = {low - margin, high + margin, false};
}

void DrawDiagram(const Lobes& lobes, const Diagram& diagram, Canvas* canvas, const Box& frame) {
  const Range angles = {0, 90, false};
  const Axes axes(frame, angles, diagram.range);
  const std::vector<Tick> x_ticks = AngleTicks(0, 90, 6);
  const std::vector<Tick> y_ticks = diagram.logarithmic ? LogTicks(diagram.range.low, diagram.range.high, 6)
                                                        : LinearTicks(diagram.range.low, diagram.range.high, 6);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  {
    const Canvas::Clip clip(canvas, frame);
    for (const Row& row : diagram.rows) {
      std::vector<Point> line;
      for (const SelSlice& slice : lobes.along) {
        line.push_back(axes.Map(RadiansToDegrees(slice.theta_i), std::max(row.value(slice), 0.5 * diagram.range.low)));
      }
      if (!diagram.logarithmic) {
        for (std::size_t k = 0; k < line.size(); ++k) line[k].y = axes.MapY(row.value(lobes.along[k]));
      }
      canvas->Polyline(line, row.dashed ? Stroke{row.color, 1.2, 1, 5, 3} : Stroke{row.color, 1.2});
      for (const SelSlice& slice : lobes.table().slices) {
        const double value = row.value(slice);
        if (value < diagram.range.low) continue;
        const Point at = axes.Map(RadiansToDegrees(slice.theta_i), value);
        if (row.dashed) {
          canvas->Ring(at, 2.2, {row.color, 1});
        } else {
          canvas->Disc(at, 2.2, row.color, 0.75);
        }
      }
    }
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawYLabel(canvas, diagram.label, kLeft - 16);
  axes.DrawXLabel(canvas, "θ_i  (degrees)");
}

void Draw(const Lobes& lobes, Canvas* canvas, const Box& content) {
  const auto count = static_cast<double>(lobes.diagrams.size());
  const Box area = Inset(content, kLeft, 4, 4, kBelow + 24);
  const double width = (area.width - (count - 1) * kGap) / count;
  for (std::size_t k = 0; k < lobes.diagrams.size(); ++k) {
    DrawDiagram(lobes, lobes.diagrams[k], canvas,
                {area.x + static_cast<double>(k) * (width + kGap), area.y, width, area.height});
  }
  std::string note = "Dashed and rings: α_y; offset across the plane of incidence. Grey: the constant.";
  if (!lobes.one_azimuth) note += " Lines: φ_i = " + Degrees(lobes.azimuth) + ".";
  TextStyle small = style::Note();
  small.markup = true;
  canvas->Text({area.x, content.bottom() - 6}, canvas->Shorten(note, small, area.width), small);
}

}  // namespace

std::optional<Panel> LobesPanel(const ReportData& data) {
  const SelReflectance* fitted = data.fitted.table();
  if (fitted == nullptr) return std::nullopt;
  const auto lobes = std::make_shared<Lobes>(Lobes{data, {}, 0, true, MakeDiagrams(data)});
  lobes->azimuth = CommonAzimuth(fitted->table());
  for (const SelReflectance::Ring& ring : fitted->rings()) lobes->one_azimuth &= ring.slices.size() == 1;
  const double first = fitted->rings().front().theta, last = fitted->rings().back().theta;
  for (int k = 0; k <= 100; ++k) {
    const double theta = first + (last - first) * k / 100;
    lobes->along.push_back(fitted->At(FromSpherical(theta, lobes->azimuth)));
    lobes->along.back().theta_i = theta;
  }
  for (Diagram& diagram : lobes->diagrams) FindRange(fitted->table(), &diagram);
  Panel panel;
  panel.id = "lobes";
  panel.title = "Squared ellipsoidal lobes over the incidence";
  for (std::size_t l = 0; l < fitted->table().slices[0].lobes.size(); ++l) {
    panel.legend.push_back(
        {LegendEntry::Mark::kSwatch, kLobeColors[l % kLobeColors.size()], Join({"lobe", std::to_string(l + 1)}, " ")});
  }
  panel.height = [](Canvas*, double) { return 320.0; };
  panel.draw = [lobes](Canvas* canvas, const Box& content) { Draw(*lobes, canvas, content); };
  return panel;
}

}  // namespace lobefit

// Residuals against theta_h, theta_i and the value, as densities with quantiles, so that structure shows.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostColumns = 36, kFewestColumns = 8, kRows = 64, kFewest = 20;
constexpr std::size_t kTaken = 300000;  // residuals in all
constexpr std::array<double, 5> kQuantiles = {0.05, 0.25, 0.5, 0.75, 0.95};

// One diagram: residuals gathered in columns of its abscissa.
struct Diagram {
  std::string label;
  Range x;
  std::vector<std::vector<double>> columns;

  void Add(double at, double residual) {
    const double t = x.logarithmic ? std::log(std::max(at, x.low) / x.low) / std::log(x.high / x.low)
                                   : (at - x.low) / (x.high - x.low);
    if (!(t >= 0) || t > 1) return;
    const auto column = static_cast<std::size_t>(t * static_cast<double>(columns.size()));
    columns[std::min(columns.size() - 1, column)].push_back(residual);
  }
  double Center(std::size_t column) const {
    const double t = (static_cast<double>(column) + 0.5) / static_cast<double>(columns.size());
    return x.logarithmic ? x.low * std::pow(x.high / x.low, t) : x.low + t * (x.high - x.low);
  }
};

struct ResidualDiagrams {
  std::array<Diagram, 3> diagrams;
  double ratio = 2;
  std::size_t taken = 0, all = 0;
};

void Fill(const ReportData& data, ResidualDiagrams* residuals) {
  const Samples& samples = data.measurement.samples;
  const std::size_t count = samples.size() * data.channels(), step = 1 + count / kTaken;
  residuals->all = count;
  std::vector<double> sizes, values;
  for (std::size_t k = 0; k < count; k += step) {
    const double f = static_cast<double>(data.fitted_values[k % data.channels()][k / data.channels()]);
    if (f > 0) values.push_back(f);
  }
  // A few values far from all others would leave most of the diagram empty.
  const double above =
      std::clamp(2.0 * kFewest / static_cast<double>(std::max<std::size_t>(1, values.size())), 0.001, 0.05);
  const double low = Quantile(&values, 0.01), high = Quantile(&values, 1 - above);
  residuals->diagrams[0] = {"θ_h  (degrees)", {1, 90, true}, {}};
  residuals->diagrams[1] = {"θ_i  (degrees)", {0, 90, false}, {}};
  residuals->diagrams[2] = {"fitted f_r  (1/sr)", {low, std::max(high, 2 * low), true}, {}};
  // Enough samples for the quantiles of a column.
  const std::size_t columns = std::clamp(count / step / 120, kFewestColumns, kMostColumns);
  for (Diagram& diagram : residuals->diagrams) diagram.columns.resize(columns);
  for (std::size_t k = 0; k < count; k += step) {
    const std::size_t c = k % data.channels(), i = k / data.channels();
    double ratio = data.LogRatio(c, i);
    if (std::isnan(ratio)) continue;
    ratio = std::max(ratio, -20.0);
    const Vec3 wi = samples.wi(i), wo = samples.wo(i);
    residuals->diagrams[0].Add(RadiansToDegrees(PolarAngle(HalfVector(wi, wo))), ratio);
    residuals->diagrams[1].Add(RadiansToDegrees(PolarAngle(wi)), ratio);
    residuals->diagrams[2].Add(static_cast<double>(data.fitted_values[c][i]), ratio);
    sizes.push_back(std::fabs(ratio));
    ++residuals->taken;
  }
  const double spread = sizes.empty() ? 0.1 : Quantile(&sizes, 0.93);
  residuals->ratio = 10;
  for (const double nice : {5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.05, 1.02, 1.01}) {
    if (std::log(nice) >= spread) residuals->ratio = nice;
  }
}

// The column that stands for each: itself, or the nearest one with samples, up to four away. Listed angles leave
// columns empty between them.
std::vector<std::size_t> Filled(const Diagram& diagram) {
  const std::size_t count = diagram.columns.size();
  std::vector<std::size_t> filled(count, count);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t r = 0; r <= 4 && filled[c] == count; ++r) {
      if (c >= r && diagram.columns[c - r].size() >= kFewest) filled[c] = c - r;
      if (filled[c] == count && c + r < count && diagram.columns[c + r].size() >= kFewest) filled[c] = c + r;
    }
  }
  return filled;
}

void DrawDiagram(const Diagram& diagram, double ratio, Canvas* canvas, const Box& frame, bool labels) {
  const double reach = std::pow(ratio, 1.5), span = std::log(reach);
  const std::size_t count = diagram.columns.size();
  const Axes axes(frame, diagram.x, {1 / reach, reach, true});
  const std::vector<std::size_t> filled = Filled(diagram);
  for (std::size_t c = 0; c < count; ++c) {
    if (filled[c] == count) continue;
    const std::vector<double>& column = diagram.columns[filled[c]];
    std::vector<double> rows(kRows);
    for (const double r : column) {
      const double t = (r / span + 1) / 2;
      rows[std::min(kRows - 1, static_cast<std::size_t>(std::clamp(t, 0.0, 1.0) * kRows))] += 1;
    }
    const double most = *std::max_element(rows.begin(), rows.end());
    const double x = frame.x + frame.width * static_cast<double>(c) / static_cast<double>(count);
    for (std::size_t r = 0; r < kRows; ++r) {
      if (rows[r] == 0) continue;
      const double y = frame.bottom() - frame.height * static_cast<double>(r + 1) / kRows;
      canvas->Fill({x, y, frame.width / static_cast<double>(count), frame.height / kRows}, style::kBlue,
                   0.05 + 0.5 * std::sqrt(rows[r] / most));
    }
  }
  std::vector<Tick> x_ticks =
      diagram.x.logarithmic ? LogTicks(diagram.x.low, diagram.x.high, 5) : AngleTicks(diagram.x.low, diagram.x.high, 6);
  const std::vector<Tick> y_ticks = {{1 / ratio, RatioText(1 / ratio)}, {1, "1"}, {ratio, RatioText(ratio)}};
  canvas->Line({frame.x, axes.MapY(1)}, {frame.right(), axes.MapY(1)}, {style::kInk, 0.5, 0.7});
  const Canvas::Clip clip(canvas, Inset(frame, -60, 0, -30, -60));
  for (std::size_t q = 0; q < kQuantiles.size(); ++q) {
    std::vector<Point> line;
    for (std::size_t c = 0; c < count; ++c) {
      if (filled[c] == count) line.push_back({std::nan(""), 0});
      if (filled[c] != c) continue;
      std::vector<double> column = diagram.columns[c];
      line.push_back(axes.Map(diagram.Center(c), std::exp(std::clamp(Quantile(&column, kQuantiles[q]), -span, span))));
    }
    const bool middle = q == 2, outer = q == 0 || q == 4;
    canvas->Polyline(
        line, {middle ? style::kVermilion : style::kInk, middle ? 1.5 : 0.5, 1, outer ? 3.0 : 0.0, outer ? 2.5 : 0.0});
  }
  axes.DrawFrame(canvas, x_ticks, y_ticks, true, labels);
  axes.DrawXLabel(canvas, diagram.label);
  if (labels) axes.DrawYLabel(canvas, "measured / fitted", 46);
}

}  // namespace

std::optional<Panel> ResidualsPanel(const ReportData& data) {
  const auto residuals = std::make_shared<ResidualDiagrams>();
  Fill(data, residuals.get());
  if (residuals->taken < 2 * kFewest) return std::nullopt;
  Panel panel;
  panel.id = "residuals";
  panel.title = "Residuals";
  panel.grows = true;
  const std::string shown = residuals->taken < residuals->all ? Count(residuals->taken) + " of " + Count(residuals->all)
                                                              : "all " + Count(residuals->all);
  panel.legend = {{LegendEntry::Mark::kBand, style::kBlue, "density (" + shown + " values)"},
                  {LegendEntry::Mark::kLine, style::kVermilion, "median"},
                  {LegendEntry::Mark::kLine, style::kInk, "quartiles; dashed 5 and 95 %"}};
  panel.height = [](Canvas*, double) { return 290.0; };
  panel.draw = [residuals](Canvas* canvas, const Box& content) {
    const double gap = 34, left = 62, height = std::min(content.height - 50, 420.0),
                 width = (content.width - left - 2 * gap - 4) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const Box frame = {content.x + left + static_cast<double>(k) * (width + gap), content.y + 4, width, height};
      DrawDiagram(residuals->diagrams[k], residuals->ratio, canvas, frame, k == 0);
    }
  };
  return panel;
}

}  // namespace lobefit

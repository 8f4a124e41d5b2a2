// Correlations between the fitted parameters.
#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/base/text/text.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/plot/table.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

struct Correlation {
  std::vector<std::string> labels;
  std::vector<std::string> groups;  // the labels without channels
  std::vector<double> values;       // row-major; NaN where a variance is not known
  double At(std::size_t i, std::size_t j) const { return values[i * labels.size() + j]; }
};

// "theta_x_deg" as "θ_x", "f0[R]" as "F_0 R".
std::string Label(const std::string& name, const std::vector<Parameter>& parameters) {
  const std::size_t bracket = name.find('[');
  const std::string bare = name.substr(0, bracket);
  std::string label = bare;
  for (const Parameter& parameter : parameters) {
    if (parameter.json_name != bare) continue;
    label = Symbol(parameter);
    if (LobeOf(parameter) > 0) label += "'";
  }
  if (bracket != std::string::npos && name.back() == ']')
    label.append(" ").append(name, bracket + 1, name.size() - bracket - 2);
  return label;
}

std::vector<std::string> RunLabels(const std::vector<std::string>& groups) {
  std::vector<std::string> labels(groups.size());
  for (std::size_t begin = 0, end = 0; begin < groups.size(); begin = end) {
    while (end < groups.size() && groups[end] == groups[begin]) ++end;
    labels[(begin + end - 1) / 2] = groups[begin];
  }
  return labels;
}

void Draw(const Correlation& correlation, Canvas* canvas, const Box& content) {
  const std::size_t n = correlation.labels.size();
  // Too many for a label each: one in the middle of every run of channels.
  const std::vector<std::string> labels = n <= 20 ? correlation.labels : RunLabels(correlation.groups);
  const TextStyle label = {
      .size = n > 14 ? 9.0 : style::kNoteSize, .color = style::kInk, .baseline = Baseline::kMiddle, .markup = true};
  double room = 8;
  for (const std::string& text : labels) room = std::max(room, canvas->TextWidth(text, label) + 8);
  const double size = std::min(content.width - room, content.height - room - 44), cell = size / static_cast<double>(n);
  const double left = content.x + room, top = content.y + room;
  for (std::size_t i = 0; i < n; ++i) {
    const double y = top + (static_cast<double>(i) + 0.5) * cell;
    if (!labels[i].empty()) {
      TextStyle row = label, column = label;
      row.align = Align::kRight;
      column.upwards = true;
      canvas->Text({left - 5, y}, labels[i], row);
      canvas->Text({left + (static_cast<double>(i) + 0.5) * cell, top - 5}, labels[i], column);
    }
    for (std::size_t j = 0; j < n; ++j) {
      const double r = correlation.At(i, j);
      const Box box = {left + static_cast<double>(j) * cell, top + static_cast<double>(i) * cell, cell, cell};
      canvas->Fill(n <= 20 ? Inset(box, 0.5, 0.5, 0.5, 0.5) : box, i == j          ? style::kGrid
                                                                   : std::isnan(r) ? style::kShade
                                                                                   : DivergingColor(0.5 + r / 2));
      if (cell < 25 || i == j || std::isnan(r)) continue;
      const std::string digits = std::to_string(static_cast<int>(std::min(99.0, std::round(std::fabs(r) * 100))) + 100);
      const std::string text = Join({r < 0 ? "−." : ".", digits.substr(1)}, "");
      canvas->Text(box.center(), text,
                   {.size = 9.5,
                    .color = std::fabs(r) > 0.7 ? Rgb{255, 255, 255} : style::kInk,
                    .align = Align::kCenter,
                    .baseline = Baseline::kMiddle});
    }
  }
  const double width = std::min(200.0, size);
  DrawColorScale(canvas, {left + (size - width) / 2, top + size + 14, width, 8}, DivergingColor, {-1, 1, false},
                 {{-1, "−1"}, {-0.5, ""}, {0, "0"}, {0.5, ""}, {1, "1"}}, "");
}

}  // namespace

std::optional<Panel> CorrelationPanel(const ReportData& data) {
  const Material& material = data.material;
  const std::size_t n = material.covariance_names.size();
  if (n < 2 || material.covariance.size() != n * n) return std::nullopt;
  const auto correlation = std::make_shared<Correlation>();
  const std::vector<Parameter> parameters = Parameters(material.model);
  bool any = false;
  for (std::size_t i = 0; i < n; ++i) {
    const std::string& name = material.covariance_names[i];
    correlation->labels.push_back(Label(name, parameters));
    correlation->groups.push_back(Label(name.substr(0, name.find('[')), parameters));
    for (std::size_t j = 0; j < n; ++j) {
      const double r =
          material.covariance[i * n + j] / std::sqrt(material.covariance[i * n + i] * material.covariance[j * n + j]);
      correlation->values.push_back(std::isfinite(r) ? std::clamp(r, -1.0, 1.0) : std::nan(""));
      any |= i != j && std::isfinite(r);
    }
  }
  if (!any) return std::nullopt;
  Panel panel;
  panel.id = "correlation";
  panel.title = "Correlation of the estimates";
  panel.wide = false;
  panel.height = [](Canvas*, double width) { return std::min(width, 420.0) + 36; };
  panel.draw = [correlation](Canvas* canvas, const Box& content) { Draw(*correlation, canvas, content); };
  return panel;
}

}  // namespace lobefit

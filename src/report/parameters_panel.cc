// Parameters with both standard errors, a row each, or a row a channel; many channels as one row with a small curve.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/report/panel.h"
#include "lobefit/report/style.h"
#include "lobefit/report/table.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostChannelRows = 4;
// Right ends of the columns value, standard error, clustered standard error, as shares of the width; then the remark.
constexpr double kValue = 0.46, kError = 0.67, kClustered = 0.87, kRemark = 0.895;

double At(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN();
}

struct Columns {
  Canvas* canvas;
  Box box;
  double y;

  void Cell(double share, const std::string& text, Rgb color, Weight weight = Weight::kRegular) const {
    canvas->Text({box.x + share * box.width, y}, text,
                 {.size = style::kBodySize, .color = color, .weight = weight, .align = Align::kRight, .markup = true});
  }
};

void DrawValue(Columns* row, const Parameter& parameter, const FittedParameter& fitted, std::size_t i) {
  const double factor = 1 / InsideFactor(parameter);
  const double value = At(fitted.values, i) * factor, error = At(fitted.standard_error, i) * factor;
  const double clustered = At(fitted.standard_error_clustered, i) * factor;
  const bool known = std::isfinite(error) && error > 0;
  const ValueWithError rounded =
      known ? RoundToError(value, error) : RoundToError(value, std::isfinite(clustered) ? clustered : 0);
  const std::string unit = parameter.unit == "deg" ? "°" : "";
  row->Cell(kValue, rounded.value + unit, fitted.free ? style::kInk : style::kFaint,
            fitted.free ? Weight::kBold : Weight::kRegular);
  if (fitted.free) {
    row->Cell(kError, known ? "± " + rounded.error : "–", known ? style::kInk : style::kWarning);
    const bool has_clustered = std::isfinite(clustered) && clustered > 0;
    row->Cell(kClustered, has_clustered ? "± " + RoundToError(value, clustered).error : "–",
              has_clustered ? style::kInk : style::kFaint);
  }
  TextStyle remark = style::Note(style::kFaint);
  std::string words = fitted.free ? "" : "fixed";
  // Of the channels of a parameter at its bound, those that are there have no interval.
  if (fitted.at_bound && !known) words = "bound", remark.color = style::kWarning;
  if (fitted.free && !known && !fitted.at_bound) words = "open", remark.color = style::kWarning;
  row->canvas->Text({row->box.x + kRemark * row->box.width, row->y}, words, remark);
}

// One row for many channels: range of values and the curve over channels.
void DrawCurve(Columns* row, const FittedParameter& fitted, const ReportData& data) {
  const auto [low, high] = std::minmax_element(fitted.values.begin(), fitted.values.end());
  row->Cell(kValue, Number(*low) + " – " + Number(*high), style::kInk, Weight::kBold);
  const Box box = {row->box.x + (kValue + 0.03) * row->box.width, row->y - 14, (1 - kValue - 0.03) * row->box.width,
                   17};
  std::vector<Point> points;
  const double span = std::max(*high - *low, 1e-12);
  for (std::size_t c = 0; c < fitted.values.size(); ++c) {
    points.push_back({box.x + box.width * static_cast<double>(c) / static_cast<double>(fitted.values.size() - 1),
                      box.bottom() - box.height * (fitted.values[c] - *low) / span});
  }
  for (std::size_t c = 0; c + 1 < points.size(); ++c)
    row->canvas->Line(points[c], points[c + 1], {data.channel_colors[c], 2});
}

// Draws the table, or only measures it where canvas is null. Returns the y under it.
double DrawTable(const ReportData& data, Canvas* canvas, const Box& box) {
  const std::vector<Parameter> parameters = Parameters(data.material.model);
  Columns row = {canvas, box, box.y + 14};
  if (canvas != nullptr) {
    TextStyle head = style::Note(style::kSecondary, Align::kRight);
    canvas->Text({box.x + kValue * box.width, row.y}, "value", head);
    canvas->Text({box.x + kError * box.width, row.y}, "std. error", head);
    canvas->Text({box.x + kClustered * box.width, row.y}, "clustered", head);
  }
  row.y += 7;
  std::size_t lobe = std::numeric_limits<std::size_t>::max();
  for (std::size_t p = 0; p < parameters.size() && p < data.material.parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    const FittedParameter& fitted = data.material.parameters[p];
    const bool new_lobe = data.material.model.lobes.size() > 1 && parameter.group != ParameterGroup::kDiffuse &&
                          LobeOf(parameter) != lobe;
    if (new_lobe) {
      lobe = LobeOf(parameter);
      row.y += kLineHeight + 2;
      if (canvas != nullptr)
        canvas->Text({box.x, row.y}, "Lobe " + std::to_string(lobe + 1), style::Note(style::kSecondary));
    }
    const std::size_t rows = fitted.values.size() <= kMostChannelRows ? fitted.values.size() : 1;
    if (parameter.per_channel) row.y += fitted.values.size() > kMostChannelRows ? 9 : 4;
    for (std::size_t i = 0; i < rows; ++i) {
      row.y += kLineHeight;
      if (canvas == nullptr) continue;
      TextStyle name = style::Body(fitted.free ? style::kInk : style::kFaint);
      name.markup = true;
      if (i == 0) canvas->Text({box.x, row.y}, Symbol(parameter), name);
      if (parameter.per_channel && rows > 1) {
        canvas->Disc({box.x + 0.165 * box.width, row.y - 4.5}, 3.5, data.channel_colors[i]);
        canvas->Text({box.x + 0.185 * box.width, row.y},
                     canvas->Shorten(data.channel_names[i], style::Note(), 0.12 * box.width), style::Note());
      }
      if (fitted.values.size() > kMostChannelRows) {
        DrawCurve(&row, fitted, data);
      } else {
        DrawValue(&row, parameter, fitted, i);
      }
    }
  }
  return row.y + 8;
}

}  // namespace

std::optional<Panel> ParametersPanel(const ReportData& data) {
  if (data.material.parameters.empty()) return std::nullopt;
  Panel panel;
  panel.id = "parameters";
  panel.title = "Parameters";
  panel.wide = false;
  panel.height = [&data](Canvas*, double width) { return DrawTable(data, nullptr, {0, 0, width, 0}); };
  panel.draw = [&data](Canvas* canvas, const Box& content) { DrawTable(data, canvas, content); };
  return panel;
}

}  // namespace lobefit

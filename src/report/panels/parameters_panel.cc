// Parameters with both standard errors, a row each, or a row a channel; many channels as one row with a small curve.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/plot/style.h"
#include "lobefit/plot/table.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostChannelRows = 4;
// Right end of the value where many channels are drawn as a curve beside it, share of the width.
constexpr double kValue = 0.46;

double At(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN();
}

// What stands in the columns of one row.
struct Cells {
  std::string value, error, clustered, remark;
  Rgb value_color = style::kInk, error_color = style::kInk, clustered_color = style::kInk, remark_color = style::kFaint;
  bool free = true;
};

TextStyle CellStyle(Rgb color, Weight weight = Weight::kRegular) {
  return {.size = style::kBodySize, .color = color, .weight = weight, .align = Align::kRight, .markup = true};
}

// Right ends of the columns value, standard error and clustered standard error; left end of the remark.
struct Columns {
  double value = 0, error = 0, clustered = 0, remark = 0;
};

Cells CellsOf(const ReportData& data, const Parameter& parameter, const FittedParameter& fitted, std::size_t i) {
  const double factor = 1 / InsideFactor(parameter);
  const double value = At(fitted.values, i) * factor, error = At(fitted.standard_error, i) * factor;
  const double clustered = At(fitted.standard_error_clustered, i) * factor;
  const bool known = std::isfinite(error) && error > 0;
  const ValueWithError rounded =
      known ? RoundToError(value, error) : RoundToError(value, std::isfinite(clustered) ? clustered : 0);
  Cells cells;
  cells.free = fitted.free;
  cells.value = rounded.value + (parameter.unit == "deg" ? "°" : "");
  if (fitted.free) {
    cells.error = known ? "± " + rounded.error : "–";
    if (!known) cells.error_color = style::kWarning;
    const bool has_clustered = std::isfinite(clustered) && clustered > 0;
    cells.clustered = has_clustered ? "± " + RoundToError(value, clustered).error : "–";
    if (!has_clustered) cells.clustered_color = style::kFaint;
    // Of the channels of a parameter at its bound, those that are there have no interval.
    if (!known) cells.remark = fitted.at_bound ? "bound" : "open", cells.remark_color = style::kWarning;
  } else {
    cells.value_color = style::kFaint;
    const std::size_t lobe = LobeOf(parameter);
    const bool tied = parameter.name.ends_with("alpha_y") && IsRound(data.material.model.lobes[lobe].ndf);
    cells.remark = tied ? "= α_x" : "fixed";
  }
  return cells;
}

// As wide as their texts; what is left of the width goes between them.
Columns ColumnsFor(const std::vector<Cells>& rows, const Canvas& canvas, double left, const Box& box) {
  double value = 0, error = 0, clustered = 0, remark = 0;
  const TextStyle head = style::Note(), body = CellStyle(style::kInk);
  error = canvas.TextWidth("std. error", head), clustered = canvas.TextWidth("clustered", head);
  for (const Cells& row : rows) {
    value = std::max(value, canvas.TextWidth(row.value, CellStyle(style::kInk, Weight::kBold)));
    error = std::max(error, canvas.TextWidth(row.error, body));
    clustered = std::max(clustered, canvas.TextWidth(row.clustered, body));
    TextStyle note = style::Note();
    note.markup = true;
    remark = std::max(remark, canvas.TextWidth(row.remark, note));
  }
  constexpr double kMostGap = 26;
  const int gaps = remark > 0 ? 4 : 3;
  const double gap = std::min(kMostGap, (box.right() - left - value - error - clustered - remark) / gaps);
  Columns columns;
  columns.remark = box.right() - remark;
  columns.clustered = columns.remark - (remark > 0 ? std::min(gap, 10.0) : 0);
  columns.error = columns.clustered - clustered - gap;
  columns.value = columns.error - error - gap;
  return columns;
}

void DrawCells(Canvas* canvas, double y, const Cells& cells, const Columns& columns) {
  canvas->Text({columns.value, y}, cells.value,
               CellStyle(cells.value_color, cells.free ? Weight::kBold : Weight::kRegular));
  canvas->Text({columns.error, y}, cells.error, CellStyle(cells.error_color));
  canvas->Text({columns.clustered, y}, cells.clustered, CellStyle(cells.clustered_color));
  TextStyle note = style::Note(cells.remark_color);
  note.markup = true;
  canvas->Text({columns.remark, y}, cells.remark, note);
}

// One row for many channels: range of values and the curve over channels.
void DrawCurve(Canvas* canvas, const Box& panel, double y, const FittedParameter& fitted, const ReportData& data) {
  const auto [low, high] = std::minmax_element(fitted.values.begin(), fitted.values.end());
  canvas->Text({panel.x + kValue * panel.width, y}, Number(*low) + " – " + Number(*high),
               CellStyle(style::kInk, Weight::kBold));
  const Box box = {panel.x + (kValue + 0.03) * panel.width, y - 14, (1 - kValue - 0.03) * panel.width, 17};
  std::vector<Point> points;
  const double span = std::max(*high - *low, 1e-12);
  for (std::size_t c = 0; c < fitted.values.size(); ++c) {
    points.push_back({box.x + box.width * static_cast<double>(c) / static_cast<double>(fitted.values.size() - 1),
                      box.bottom() - box.height * (fitted.values[c] - *low) / span});
  }
  for (std::size_t c = 0; c + 1 < points.size(); ++c)
    canvas->Line(points[c], points[c + 1], {data.channel_colors[c], 2});
}

// Draws the table, or only measures it where canvas is null. Returns the y under it.
double DrawTable(const ReportData& data, Canvas* canvas, const Box& box) {
  const std::vector<Parameter> parameters = Parameters(data.material.model);
  double y = box.y + 14;
  constexpr double kName = 0.165;  // where names end and those of channels begin, share of the width
  Columns columns;
  if (canvas != nullptr) {
    std::vector<Cells> cells;
    double left = box.x + kName * box.width;
    for (std::size_t p = 0; p < parameters.size() && p < data.material.parameters.size(); ++p) {
      const FittedParameter& fitted = data.material.parameters[p];
      if (fitted.values.size() > kMostChannelRows) continue;
      for (std::size_t i = 0; i < fitted.values.size(); ++i) cells.push_back(CellsOf(data, parameters[p], fitted, i));
      for (std::size_t i = 0; parameters[p].per_channel && fitted.values.size() > 1 && i < fitted.values.size(); ++i) {
        const std::string name = canvas->Shorten(data.channel_names[i], style::Note(), 0.12 * box.width);
        left = std::max(left, box.x + 0.185 * box.width + canvas->TextWidth(name, style::Note()));
      }
    }
    columns = ColumnsFor(cells, *canvas, left, box);
    const TextStyle head = style::Note(style::kSecondary, Align::kRight);
    canvas->Text({columns.value, y}, "value", head);
    canvas->Text({columns.error, y}, "std. error", head);
    canvas->Text({columns.clustered, y}, "clustered", head);
  }
  y += 7;
  std::size_t lobe = std::numeric_limits<std::size_t>::max();
  for (std::size_t p = 0; p < parameters.size() && p < data.material.parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    const FittedParameter& fitted = data.material.parameters[p];
    const bool new_lobe = data.material.model.lobes.size() > 1 && parameter.group != ParameterGroup::kDiffuse &&
                          LobeOf(parameter) != lobe;
    if (new_lobe) {
      lobe = LobeOf(parameter);
      y += kLineHeight + 2;
      if (canvas != nullptr)
        canvas->Text({box.x, y}, "Lobe " + std::to_string(lobe + 1), style::Note(style::kSecondary));
    }
    const std::size_t rows = fitted.values.size() <= kMostChannelRows ? fitted.values.size() : 1;
    if (parameter.per_channel) y += fitted.values.size() > kMostChannelRows ? 9 : 4;
    for (std::size_t i = 0; i < rows; ++i) {
      y += kLineHeight;
      if (canvas == nullptr) continue;
      TextStyle name = style::Body(fitted.free ? style::kInk : style::kFaint);
      name.markup = true;
      if (i == 0) canvas->Text({box.x, y}, canvas->Shorten(Symbol(parameter), name, (kName - 0.015) * box.width), name);
      if (parameter.per_channel && rows > 1) {
        canvas->Disc({box.x + kName * box.width, y - 4.5}, 3.5, data.channel_colors[i]);
        canvas->Text({box.x + 0.185 * box.width, y},
                     canvas->Shorten(data.channel_names[i], style::Note(), 0.12 * box.width), style::Note());
      }
      if (fitted.values.size() > kMostChannelRows) {
        DrawCurve(canvas, box, y, fitted, data);
      } else {
        DrawCells(canvas, y, CellsOf(data, parameter, fitted, i), columns);
      }
    }
  }
  return y + 8;
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

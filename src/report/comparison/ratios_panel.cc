// Measured over fitted in the maps of each compared model.
#include <algorithm>
#include <cmath>

#include "lobefit/plot/axes.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/comparison/panels.h"
#include "lobefit/report/figures/field_image.h"

namespace lobefit {
namespace {

struct Ratios {
  std::vector<std::vector<NamedField>> fields;  // [model]
  bool round = false;                           // hemispheres, not theta_h against theta_d
  std::size_t rows = 1;
};

constexpr double kFieldGap = 14, kFieldHead = 22;

double FieldSide(double width, std::size_t count) {
  return std::min(240.0, (width - 52 - kFieldGap * static_cast<double>(count - 1)) / static_cast<double>(count));
}

double FieldRow(const Ratios& ratios, double side) { return side + (ratios.round ? 8 : 46); }

void DrawRatios(const Compared& compared, const Ratios& ratios, Canvas* canvas, const Box& content) {
  const std::size_t count = ratios.fields.size();
  std::vector<const FieldImage*> images;
  for (const auto& fields : ratios.fields) {
    for (std::size_t row = 0; row < ratios.rows; ++row) images.push_back(fields[row].image.get());
  }
  const FieldScale scale(images);
  const double side = FieldSide(content.width, count);
  const double left = content.x + 52;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = left + static_cast<double>(k) * (side + kFieldGap);
    const Compared::Entry& entry = compared.models[k];
    TextStyle name = style::Body(style::kInk, Align::kCenter);
    canvas->Fill({x, content.y + 16, side, 3}, entry.color);
    canvas->Text({x + side / 2, content.y + 11}, canvas->Shorten(entry.label, name, side), name);
    for (std::size_t row = 0; row < ratios.rows; ++row) {
      const FieldImage& image = *ratios.fields[k][row].image;
      const cv::Mat picture =
          Picture(image.log_ratio, image.width, image.height, [&scale](float v) { return scale.RatioColor(v); });
      const Box frame = {x, content.y + kFieldHead + static_cast<double>(row) * FieldRow(ratios, side), side, side};
      if (ratios.round) {
        canvas->Image(RoundPicture(picture, static_cast<int>(std::lround(side * canvas->scale()))), frame, false);
        canvas->Ring(frame.center(), side / 2, {style::kSecondary, 1});
      } else {
        canvas->Image(picture, frame, true);
        const Axes axes(frame, {0, 90, false}, {0, 90, false});
        const std::vector<Tick> ticks = AngleTicks(0, 90, 4);
        axes.DrawFrame(canvas, ticks, ticks, true, k == 0);
        axes.DrawXLabel(canvas, "θ_h  (degrees)");
        if (k == 0) axes.DrawYLabel(canvas, "θ_d  (degrees)", 36);
      }
    }
  }
  scale.DrawRatios(canvas, left, left + std::max(400.0, static_cast<double>(count) * (side + kFieldGap) - kFieldGap),
                   content.y + kFieldHead + static_cast<double>(ratios.rows) * FieldRow(ratios, side));
}

}  // namespace

std::optional<Panel> ComparedRatiosPanel(const Compared& compared) {
  const auto ratios = std::make_shared<Ratios>();
  ratios->fields.resize(compared.models.size());
  for (std::size_t k = 0; k < compared.models.size(); ++k) {
    // The maps that a report of the model alone shows.
    std::optional<Panel> maps = BurleyPanel(*compared.models[k].data);
    if (!maps) {
      maps = MapsPanel(*compared.models[k].data);
      ratios->round = true;
    }
    if (!maps || maps->fields.empty()) return std::nullopt;
    ratios->fields[k] = maps->fields;
    ratios->rows = std::min<std::size_t>(2, maps->fields.size());
  }
  Panel panel;
  panel.id = "ratios";
  panel.title = "Measured / fitted";
  if (ratios->round) {
    std::string which = "all outgoing directions;";
    const char* const places[] = {"above", "below"};
    for (std::size_t row = 0; row < ratios->rows; ++row) {
      which += (ratios->rows > 1 ? "  " + std::string(places[row]) + ": " : " ") + ratios->fields[0][row].title;
      if (row + 1 < ratios->rows) which += ";";
    }
    panel.legend = {{LegendEntry::Mark::kNone, {}, which}};
  }
  panel.height = [ratios](Canvas*, double width) {
    return kFieldHead + static_cast<double>(ratios->rows) * FieldRow(*ratios, FieldSide(width, ratios->fields.size())) +
           FieldScale::kHeight;
  };
  panel.draw = [&compared, ratios](Canvas* canvas, const Box& content) {
    DrawRatios(compared, *ratios, canvas, content);
  };
  return panel;
}

}  // namespace lobefit

#include "lobefit/validate/pictures/picture_page.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/plot/png.h"

namespace lobefit {
namespace {

constexpr double kWidth = 900, kMargin = 16, kCellHeight = 190, kScale = 1.1;
constexpr int kColumns = 3;

// Distance of a row's upper edge from the first row's.
double RowTop(int row) { return kCellHeight * row; }

}  // namespace

PicturePage::PicturePage(std::size_t cells)
    : canvas_(kWidth, 44 + RowTop((static_cast<int>(cells) + kColumns - 1) / kColumns), kScale,
              std::make_shared<Fonts>()) {
  canvas_.Fill({0, 0, canvas_.width(), canvas_.height()}, {255, 255, 255});
}

void PicturePage::Head(const std::string& text) {
  canvas_.Text({kMargin, 26}, canvas_.Shorten(text, style::Body(), kWidth - 2 * kMargin), style::Body());
}

Box PicturePage::Next(const std::string& title, int columns) {
  const double cell = (kWidth - kMargin) / kColumns;
  const Box box = {kMargin + cell * (next_ % kColumns), 40 + RowTop(next_ / kColumns), cell * columns, kCellHeight};
  next_ += columns;
  canvas_.Text({box.x + 44, box.y + 14}, title,
               {.size = style::kPanelTitleSize, .color = style::kInk, .weight = Weight::kBold});
  return Inset(box, 48, 22, 14, 42);
}

void PicturePage::Write(const std::filesystem::path& path) const { WritePng(canvas_.pixels(), 96 * kScale, path); }

Range Around(double low, double high) {
  if (!(high > low)) {
    const double half = std::max(1e-12, 0.1 * std::fabs(low));
    return {low - half, high + half};
  }
  const double margin = 0.08 * (high - low);
  return {low - margin, high + margin};
}

Axes Frame(Canvas* canvas, const Box& frame, const Range& x, const Range& y, const std::vector<Tick>& x_ticks,
           const std::string& x_label) {
  Axes axes(frame, x, y);
  const std::vector<Tick> y_ticks = LinearTicks(y.low, y.high, 4);
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  axes.DrawFrame(canvas, x_ticks, y_ticks);
  axes.DrawXLabel(canvas, x_label);
  return axes;
}

void DrawNames(Canvas* canvas, const Axes& axes, const std::vector<Tick>& names) {
  TextStyle label = style::Tick(Align::kCenter);
  label.size = 9;
  label.markup = false;
  label.baseline = Baseline::kTop;
  for (std::size_t i = 0; i < names.size(); ++i)
    canvas->Text({axes.MapX(names[i].value), axes.frame().bottom() + (i % 2 == 0 ? 5 : 18)}, names[i].label, label);
}

void DrawWhisker(Canvas* canvas, const Axes& axes, double x, double low, double value, double high, Rgb color) {
  canvas->Line(axes.Map(x, low), axes.Map(x, high), {color, 1.4});
  canvas->Disc(axes.Map(x, value), 2.8, color);
}

std::string UnitLabel(const Entry& entry) { return entry.unit == "1" ? "" : " / " + entry.unit; }

}  // namespace lobefit

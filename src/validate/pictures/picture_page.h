// The page that pictures of validations are drawn on: a grid of diagrams below a head of one line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/plot/axes.h"
#include "lobefit/plot/canvas.h"
#include "lobefit/plot/style.h"
#include "lobefit/validate/truth.h"

namespace lobefit {

class PicturePage {
 public:
  explicit PicturePage(std::size_t cells);

  Canvas* canvas() { return &canvas_; }
  void Head(const std::string& text);
  // The frame of the next diagram, row by row; `columns` cells wide.
  Box Next(const std::string& title, int columns = 1);
  // Throws OutputError.
  void Write(const std::filesystem::path& path) const;

 private:
  Canvas canvas_;
  int next_ = 0;
};

// [low, high] with a margin; a range about it where both are equal.
Range Around(double low, double high);

// Draws grid, frame and the label of the x axis.
Axes Frame(Canvas* canvas, const Box& frame, const Range& x, const Range& y, const std::vector<Tick>& x_ticks,
           const std::string& x_label);

// Names under the x axis at two heights in turn, so that they do not meet. Given values but not drawn by `Frame`.
void DrawNames(Canvas* canvas, const Axes& axes, const std::vector<Tick>& names);

void DrawWhisker(Canvas* canvas, const Axes& axes, double x, double low, double value, double high, Rgb color);

// " / deg", nothing for numbers without unit.
std::string UnitLabel(const Entry& entry);

}  // namespace lobefit

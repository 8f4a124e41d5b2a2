// Axes of a diagram: ranges, ticks at round numbers, the map from data to page, frame and labels.
#pragma once

#include <string>
#include <vector>

#include "lobefit/plot/canvas.h"

namespace lobefit {

struct Tick {
  double value = 0;
  std::string label;  // empty: a minor tick
};

struct Range {
  double low = 0, high = 1;
  bool logarithmic = false;
};

// Ticks within the range, at steps of 1, 2 or 5 times a power of ten; about `target` labels, at least 3.
std::vector<Tick> LinearTicks(double low, double high, int target);
// Ticks of an axis in degrees: steps of 1, 2, 5, 10, 15, 30, 45 or 90; finer ranges as LinearTicks.
std::vector<Tick> AngleTicks(double low, double high, int target);
// Powers of ten with labels (every second, third, ... where more than `target` would be needed) and minor ticks
// between; a range of less than two decades has 2 and 5 (or all digits) labelled too.
std::vector<Tick> LogTicks(double low, double high, int target);

// Smallest range of whole decades, or of 1, 2, 5 steps, that holds [low, high]. Domain: 0 < low <= high.
Range LogRangeAround(double low, double high);

class Axes {
 public:
  Axes(const Box& frame, const Range& x, const Range& y) : frame_(frame), x_(x), y_(y) {}

  const Box& frame() const { return frame_; }
  double MapX(double x) const;
  double MapY(double y) const;
  Point Map(double x, double y) const { return {MapX(x), MapY(y)}; }

  // Grid lines under the data; then, over them, frame, tick marks and labels. Labels are left out where asked (small
  // multiples).
  void DrawGrid(Canvas* canvas, const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks) const;
  void DrawFrame(Canvas* canvas, const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks,
                 bool x_labels = true, bool y_labels = true) const;
  // Names of the axes (markup), outside the tick labels. `y_label_room`: how far the tick labels reach to the left.
  void DrawXLabel(Canvas* canvas, const std::string& label) const;
  void DrawYLabel(Canvas* canvas, const std::string& label, double y_label_room = 36) const;

 private:
  Box frame_;
  Range x_, y_;
};

// A horizontal scale of `color`(0..1) under `box` with ticks of `range`.
void DrawColorScale(Canvas* canvas, const Box& box, Rgb (*color)(double), const Range& range,
                    const std::vector<Tick>& ticks, const std::string& label);

}  // namespace lobefit

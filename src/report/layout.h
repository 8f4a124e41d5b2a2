// Where the panels stand: wide ones in two thirds of the page with narrow ones stacked beside them.
#pragma once

#include <functional>
#include <vector>

#include "lobefit/report/canvas.h"

namespace lobefit {

struct PanelSize {
  bool wide = true;
  std::function<double(double width)> height;  // of the whole panel
};

struct PageLayout {
  std::vector<Box> boxes;  // in the order given
  double height = 0;       // bottom of the lowest panel
};

// Each wide panel, in order, takes as many of the narrow ones, in order, as its height has room for, at least one while
// there are any; without one it takes the whole width. Left-over narrow ones stand side by side. `gap` separates rows
// and columns.
PageLayout ArrangePanels(const std::vector<PanelSize>& panels, double left, double top, double width, double gap);

}  // namespace lobefit

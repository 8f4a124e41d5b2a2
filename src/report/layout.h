// Where the panels stand on the page.
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

// Wide panels stand in order in a column of two thirds, narrow ones in a column of one third beside it. A wide panel
// that begins below the last narrow one takes the whole width. Narrow panels for which the column would grow past the
// wide ones stand side by side at the bottom; how many is chosen so that the page is shortest. `gap` separates rows and
// columns.
PageLayout ArrangePanels(const std::vector<PanelSize>& panels, double left, double top, double width, double gap);

}  // namespace lobefit

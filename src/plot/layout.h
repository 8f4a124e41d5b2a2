// Where the panels stand on the page.
#pragma once

#include <functional>
#include <vector>

#include "lobefit/plot/canvas.h"

namespace lobefit {

struct PanelSize {
  bool wide = true;
  std::function<double(double width)> height;  // of the whole panel
  bool grows = false;                          // draws more where it is given more height
};

struct PageLayout {
  std::vector<Box> boxes;  // in the order given
  double height = 0;       // bottom of the lowest panel
};

// The page is cut into bands: wide panels in a column of two thirds with narrow ones in a column of one third beside
// them, or one wide panel over the whole width, or up to three narrow ones side by side. Wide panels keep their order,
// and so do narrow ones. Of all such pages the one is taken that is shortest, where blank area counts half as much as
// length. `gap` separates rows and columns.
PageLayout ArrangePanels(const std::vector<PanelSize>& panels, double left, double top, double width, double gap);

}  // namespace lobefit

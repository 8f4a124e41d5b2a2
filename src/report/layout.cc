#include "lobefit/report/layout.h"

#include <algorithm>
#include <cstddef>

namespace lobefit {

PageLayout ArrangePanels(const std::vector<PanelSize>& panels, double left, double top, double width, double gap) {
  PageLayout layout;
  layout.boxes.resize(panels.size());
  std::vector<std::size_t> wide, narrow;
  for (std::size_t i = 0; i < panels.size(); ++i) (panels[i].wide ? wide : narrow).push_back(i);
  const double third = (width - 2 * gap) / 3, two_thirds = width - third - gap;
  double y = top;
  for (const std::size_t panel : wide) {
    if (narrow.empty()) {
      const double height = panels[panel].height(width);
      layout.boxes[panel] = {left, y, width, height};
      y += height + gap;
      continue;
    }
    const double own = panels[panel].height(two_thirds);
    std::vector<std::size_t> stack = {narrow.front()};
    double used = panels[narrow.front()].height(third);
    narrow.erase(narrow.begin());
    for (std::size_t k = 0; k < narrow.size();) {
      const double longer = used + gap + panels[narrow[k]].height(third);
      // A stack may stand out a little rather than leave a panel to a row of its own.
      if (longer > own * 1.06) {
        ++k;
        continue;
      }
      used = longer;
      stack.push_back(narrow[k]);
      narrow.erase(narrow.begin() + static_cast<std::ptrdiff_t>(k));
    }
    const double height = std::max(own, used);
    layout.boxes[panel] = {left, y, two_thirds, height};
    double side = y;
    for (const std::size_t beside : stack) {
      // What is left over goes to the last of the stack.
      const double tall = beside == stack.back() ? y + height - side : panels[beside].height(third);
      layout.boxes[beside] = {left + two_thirds + gap, side, third, tall};
      side += tall + gap;
    }
    y += height + gap;
  }
  for (std::size_t next = 0; next < narrow.size();) {
    // Four are two rows of two.
    const std::size_t rest = narrow.size() - next, count = rest == 4 ? 2 : std::min<std::size_t>(3, rest);
    const double share = (width - static_cast<double>(count - 1) * gap) / static_cast<double>(count),
                 own = rest == 1 ? third : share;
    double height = 0;
    for (std::size_t k = 0; k < count; ++k) height = std::max(height, panels[narrow[next + k]].height(own));
    for (std::size_t k = 0; k < count; ++k)
      layout.boxes[narrow[next + k]] = {left + static_cast<double>(k) * (own + gap), y, own, height};
    next += count;
    y += height + gap;
  }
  layout.height = y - gap;
  return layout;
}

}  // namespace lobefit

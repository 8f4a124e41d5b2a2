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
  std::size_t next = 0;
  for (std::size_t w = 0; w < wide.size(); ++w) {
    const std::size_t panel = wide[w];
    if (next == narrow.size()) {
      layout.boxes[panel] = {left, y, width, panels[panel].height_full};
      y += panels[panel].height_full + gap;
      continue;
    }
    const std::size_t first = next;
    double stack = panels[narrow[next++]].height_third;
    // The last wide panel takes one more where the stack then is a little taller, rather than leave it alone in a row.
    const bool last = w + 1 == wide.size();
    const double room = panels[panel].height_two_thirds * (last ? 1.35 : 1.04);
    while (next < narrow.size() && stack + gap + panels[narrow[next]].height_third <= room) {
      stack += gap + panels[narrow[next++]].height_third;
    }
    const double height = std::max(panels[panel].height_two_thirds, stack);
    layout.boxes[panel] = {left, y, two_thirds, height};
    double side = y;
    for (std::size_t k = first; k < next; ++k) {
      // What is left over goes to the last of the stack.
      const double own = k + 1 < next ? panels[narrow[k]].height_third : y + height - side;
      layout.boxes[narrow[k]] = {left + two_thirds + gap, side, third, own};
      side += own + gap;
    }
    y += height + gap;
  }
  while (next < narrow.size()) {
    const std::size_t count = std::min<std::size_t>(3, narrow.size() - next);
    double height = 0;
    for (std::size_t k = 0; k < count; ++k) height = std::max(height, panels[narrow[next + k]].height_third);
    for (std::size_t k = 0; k < count; ++k)
      layout.boxes[narrow[next + k]] = {left + static_cast<double>(k) * (third + gap), y, third, height};
    next += count;
    y += height + gap;
  }
  layout.height = y - gap;
  return layout;
}

}  // namespace lobefit

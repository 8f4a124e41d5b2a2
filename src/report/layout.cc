#include "lobefit/report/layout.h"

#include <algorithm>
#include <cstddef>

namespace lobefit {
namespace {

struct Page {
  double left, top, width, gap;
};

// The first `beside` of the narrow panels in the column, the others in rows below.
PageLayout Arrange(const std::vector<PanelSize>& panels, const Page& page, const std::vector<std::size_t>& wide,
                   const std::vector<std::size_t>& narrow, std::size_t beside) {
  PageLayout layout;
  layout.boxes.resize(panels.size());
  const double third = (page.width - 2 * page.gap) / 3, two_thirds = page.width - third - page.gap;
  const double column = page.left + two_thirds + page.gap;
  double side = page.top;
  for (std::size_t k = 0; k < beside; ++k) {
    layout.boxes[narrow[k]] = {column, side, third, panels[narrow[k]].height(third)};
    side = layout.boxes[narrow[k]].bottom() + page.gap;
  }
  double y = page.top;
  for (const std::size_t panel : wide) {
    const double own = y >= side ? page.width : two_thirds;
    layout.boxes[panel] = {page.left, y, own, panels[panel].height(own)};
    y = layout.boxes[panel].bottom() + page.gap;
  }
  y = std::max(y, side);
  for (std::size_t next = beside; next < narrow.size();) {
    // Four are two rows of two.
    const std::size_t rest = narrow.size() - next, count = rest == 4 ? 2 : std::min<std::size_t>(3, rest);
    const double share = (page.width - static_cast<double>(count - 1) * page.gap) / static_cast<double>(count),
                 own = rest == 1 ? third : share;
    double height = 0;
    for (std::size_t k = 0; k < count; ++k) height = std::max(height, panels[narrow[next + k]].height(own));
    for (std::size_t k = 0; k < count; ++k) {
      layout.boxes[narrow[next + k]] = {page.left + static_cast<double>(k) * (own + page.gap), y, own, height};
    }
    next += count;
    y += height + page.gap;
  }
  layout.height = y - page.gap;
  return layout;
}

}  // namespace

PageLayout ArrangePanels(const std::vector<PanelSize>& panels, double left, double top, double width, double gap) {
  std::vector<std::size_t> wide, narrow;
  for (std::size_t i = 0; i < panels.size(); ++i) (panels[i].wide ? wide : narrow).push_back(i);
  const Page page = {left, top, width, gap};
  // Without wide panels there is no column to stand beside.
  if (wide.empty()) return Arrange(panels, page, wide, narrow, 0);
  PageLayout best = Arrange(panels, page, wide, narrow, narrow.size());
  for (std::size_t beside = narrow.size(); beside-- > 0;) {
    const PageLayout other = Arrange(panels, page, wide, narrow, beside);
    if (other.height < best.height - 0.5) best = other;
  }
  return best;
}

}  // namespace lobefit

#include "lobefit/plot/layout.h"

#include <gtest/gtest.h>

namespace lobefit {
namespace {

PanelSize Wide(double height) {
  return {true, [height](double) { return height; }};
}
PanelSize Narrow(double height) {
  return {false, [height](double) { return height; }};
}

bool Overlap(const Box& a, const Box& b) {
  return a.x < b.right() - 1e-9 && b.x < a.right() - 1e-9 && a.y < b.bottom() - 1e-9 && b.y < a.bottom() - 1e-9;
}

TEST(ArrangePanels, NeverOverlapNorLeaveThePage) {
  // Every mix of up to three wide and five narrow panels of different heights.
  for (int wide = 0; wide <= 3; ++wide) {
    for (int narrow = 0; narrow <= 5; ++narrow) {
      std::vector<PanelSize> panels;
      for (int k = 0; k < wide; ++k) panels.push_back(Wide(200 + 170 * k));
      for (int k = 0; k < narrow; ++k) panels.push_back(Narrow(120 + 90 * ((3 * k) % 4)));
      const PageLayout layout = ArrangePanels(panels, 30, 100, 1200, 20);
      for (std::size_t i = 0; i < panels.size(); ++i) {
        const Box& box = layout.boxes[i];
        EXPECT_GE(box.x, 30 - 1e-9);
        EXPECT_LE(box.right(), 1230 + 1e-9);
        EXPECT_GE(box.y, 100);
        EXPECT_LE(box.bottom(), layout.height + 1e-9);
        EXPECT_GE(box.height, panels[i].height(box.width) - 1e-9) << wide << " wide, " << narrow << " narrow";
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(Overlap(box, layout.boxes[j])) << i << " and " << j;
      }
    }
  }
}

TEST(ArrangePanels, AWidePanelAloneTakesTheWholeWidth) {
  const PageLayout layout = ArrangePanels({Wide(300)}, 0, 0, 1200, 20);
  EXPECT_DOUBLE_EQ(layout.boxes[0].width, 1200);
  EXPECT_DOUBLE_EQ(layout.height, 300);
}

TEST(ArrangePanels, AWidePanelBelowTheNarrowColumnTakesTheWholeWidth) {
  const PageLayout layout = ArrangePanels({Wide(600), Wide(300), Narrow(200), Narrow(250)}, 0, 0, 1200, 20);
  EXPECT_DOUBLE_EQ(layout.boxes[0].width, 1200 - 20 - (1200 - 40) / 3.0);
  EXPECT_DOUBLE_EQ(layout.boxes[1].width, 1200);
  EXPECT_DOUBLE_EQ(layout.height, 920);
}

TEST(ArrangePanels, NarrowOnesThatWouldStickOutStandBelow) {
  const PageLayout layout =
      ArrangePanels({Wide(300), Narrow(280), Narrow(250), Narrow(250), Narrow(250)}, 0, 0, 1200, 20);
  EXPECT_DOUBLE_EQ(layout.boxes[1].y, 0);
  for (const std::size_t k : {2, 3, 4}) EXPECT_DOUBLE_EQ(layout.boxes[k].y, 320);
  EXPECT_DOUBLE_EQ(layout.height, 570);
}

}  // namespace
}  // namespace lobefit

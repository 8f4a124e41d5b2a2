#include "apps/lobefit/text/terminal_plot.h"

#include <algorithm>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

std::size_t LongestLine(const std::string& text) {
  std::size_t longest = 0;
  for (const std::string_view line : Split(text, '\n')) longest = std::max(longest, line.size());
  return longest;
}

// One incidence is off by a factor of two: that is the slice that is shown, with its error.
TEST(TerminalPlot, ShowsTheSliceThatIsMissedMost) {
  const Material material = test::MakeMaterial(3, false);
  Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0, false);
  for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
    if (std::fabs(PolarAngle(measurement.samples.wi(i)) - DegreesToRadians(50)) > 0.01) continue;
    for (auto& channel : measurement.samples.values) channel[i] *= 2;
  }
  const std::string plot = WorstSlicePlot(material, measurement, 90);
  EXPECT_TRUE(plot.starts_with("Worst slice: theta_i = 50, phi_i = 0 degrees, off by 100 % (rms)\n")) << plot;
  EXPECT_LE(LongestLine(plot), 90U) << plot;
  for (const char mark : {'o', '-', '+'}) EXPECT_NE(plot.find(mark), std::string::npos) << plot;
  // A factor of two is more than a row of characters: no mark of the two coincides below the peak's slopes.
  EXPECT_LT(std::count(plot.begin(), plot.end(), '@'), 20) << plot;
}

TEST(TerminalPlot, ExactFitCoincides) {
  const Material material = test::MakeMaterial(1, false);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 1e-3, false);
  const std::string plot = WorstSlicePlot(material, measurement, 80);
  EXPECT_GT(std::count(plot.begin(), plot.end(), '@'), 15) << plot;
}

TEST(TerminalPlot, NothingWhereThereIsNoRoomOrNoSlice) {
  const Material material = test::MakeMaterial(1, false);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0.1, false);
  EXPECT_EQ(WorstSlicePlot(material, measurement, kLeastPlotColumns - 1), "");
  EXPECT_EQ(WorstSlicePlot(material, measurement, 0), "");
  const Measurement one = test::Measure(material, {{test::AtDegrees(30, 0), test::AtDegrees(30, 180)}}, 0, false);
  EXPECT_EQ(WorstSlicePlot(material, one, 100), "");
}

}  // namespace
}  // namespace lobefit

#include "lobefit/report/figures/coverage.h"

#include <numeric>

#include "tests/report/synthetic.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/plot/canvas.h"

namespace lobefit {
namespace {

constexpr int kCells = CoverageDisc::kCells;

TEST(Coverage, EverySampleIsCountedOnce) {
  const Measurement measurement = test::Measure(test::MakeMaterial(1, false), test::GoniometerPairs(true), 0, false);
  for (const CoverageDisc& disc : CountCoverage(measurement))
    EXPECT_EQ(std::accumulate(disc.counts.begin(), disc.counts.end(), std::size_t{0}), measurement.samples.size())
        << disc.title;
}

// +x is to the right, +y up, the rim is the horizon.
TEST(Coverage, DirectionsStandWhereTheyShould) {
  const Measurement measurement =
      test::Measure(test::MakeMaterial(1, false), {{test::AtDegrees(45, 0), test::AtDegrees(88, 90)}}, 0, false);
  const std::vector<CoverageDisc> discs = CountCoverage(measurement);
  EXPECT_EQ(discs[0].counts[PixelIndex(3 * kCells / 4, kCells / 2, kCells)], 1U);
  EXPECT_EQ(discs[1].counts[PixelIndex(kCells / 2, 0, kCells)], 1U);
}

TEST(Coverage, IsotropicLightIsAtAzimuthZero) {
  const Measurement measurement =
      test::Measure(test::MakeMaterial(1, true), {{test::AtDegrees(45, 130), test::AtDegrees(45, 220)}}, 0, true);
  const std::vector<CoverageDisc> discs = CountCoverage(measurement);
  EXPECT_EQ(discs[0].counts[PixelIndex(3 * kCells / 4, kCells / 2, kCells)], 1U);
  EXPECT_EQ(discs[1].counts[PixelIndex(kCells / 2, kCells / 4, kCells)], 1U);
}

TEST(Coverage, WritesAPngAndRefusesNothing) {
  const Measurement measurement = test::Measure(test::MakeMaterial(1, false), test::GoniometerPairs(false), 0, false);
  const TemporaryFile file;
  WriteCoveragePng(measurement, file.path(), {.threads = 1, .scale = 1, .font_folders = {}});
  EXPECT_TRUE(FileBytes(file.path()).bytes().starts_with("\x89PNG"));
  EXPECT_THROW(WriteCoveragePng(Measurement(), file.path()), InputError);
}

}  // namespace
}  // namespace lobefit

#include "lobefit/report/figures/coverage.h"

#include <algorithm>
#include <numeric>

#include "tests/report/synthetic.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
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

TEST(Coverage, WhatWasLeftOutStandsInItsCellsByReason) {
  Measurement measurement = test::Measure(test::MakeMaterial(1, false), test::GoniometerPairs(true), 0, false);
  const Vec3 wi = test::AtDegrees(45, 0), wo = test::AtDegrees(88, 90);
  measurement.LeaveOut(wi, wo, LeftOutReason::kNearLight);
  for (int k = 0; k < 2; ++k) measurement.LeaveOut(wi, wo, LeftOutReason::kNoValue);
  measurement.LeaveOut(wi, test::AtDegrees(45, 180), LeftOutReason::kNearMirror);
  const std::vector<CoverageDisc> discs = CountCoverage(measurement);
  EXPECT_EQ(discs[0].left_out[PixelIndex(3 * kCells / 4, kCells / 2, kCells)], LeftOutReason::kNoValue) << "the most";
  EXPECT_EQ(discs[1].left_out[PixelIndex(kCells / 2, 0, kCells)], LeftOutReason::kNoValue);
  EXPECT_EQ(discs[1].left_out[PixelIndex(kCells / 4, kCells / 2, kCells)], LeftOutReason::kNearMirror);
  EXPECT_EQ(discs[2].left_out[PixelIndex(kCells / 2, kCells / 2, kCells)], LeftOutReason::kNearMirror);
  const auto marked = std::count_if(discs[1].left_out.begin(), discs[1].left_out.end(),
                                    [](const std::optional<LeftOutReason>& reason) { return reason.has_value(); });
  EXPECT_EQ(marked, 2);
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

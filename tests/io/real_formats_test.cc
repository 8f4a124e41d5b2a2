// Real files of the text, table and XML formats, where they lie beside the repository; counts worked out by hand from
// the files with other tools.
#include <cmath>
#include <filesystem>

#include "tests/support/paths.h"
#include <gtest/gtest.h>

#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

const std::filesystem::path kRealFiles = test::SourceDir() / ".." / "shared" / "data";

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is not there"

std::size_t PeakOf(const Measurement& m, std::size_t channel, const std::vector<std::uint8_t>& among = {}) {
  std::size_t best = 0;
  double peak = -HUGE_VAL;
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    if (!among.empty() && among[i] == 0) continue;
    if (m.samples.values[channel][i] > peak) {
      peak = m.samples.values[channel][i];
      best = i;
    }
  }
  return best;
}

// Angle between the mirror direction of wi and wo, degrees.
double FromMirror(const Vec3& wi, const Vec3& wo) {
  const Vec3 mirror = {-wi.x, -wi.y, wi.z};
  return RadiansToDegrees(std::atan2(Norm(Cross(mirror, wo)), Dot(mirror, wo)));
}

TEST(RealFormats, CornellPaintHasItsDirectionsAndWavelengths) {
  const auto path = kRealFiles / "cornell" / "garnet_red.brdf";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.format, "cornell");
  EXPECT_EQ(m.samples.size(), 1439U);
  EXPECT_EQ(m.set_aside.total(), 0U);
  ASSERT_EQ(m.channels.size(), 31U);
  EXPECT_EQ(m.channels.wavelengths_nm.front(), 400);
  EXPECT_EQ(m.channels.wavelengths_nm.back(), 700);
  EXPECT_EQ(GroupByIncidence(m).wi.size(), 8U);  // 10, 20, ..., 80 degrees
  // Both directions point away from the surface: the gloss peak at grazing light is near the mirror direction.
  const std::size_t peak = PeakOf(m, 16);
  EXPECT_NEAR(RadiansToDegrees(PolarAngle(m.samples.wi(peak))), 80, 0.1);
  EXPECT_LT(FromMirror(m.samples.wi(peak), m.samples.wo(peak)), 3);
  // Red paint.
  EXPECT_GT(m.samples.values[25][0], 2 * m.samples.values[10][0]);
}

TEST(RealFormats, AltaSheetingIsRetroReflective) {
  const auto path = kRealFiles / "alta" / "retro-3M-jaune.dat";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.format, "alta");
  EXPECT_TRUE(m.isotropic);
  // 7397 rows, of which 86 have the view at 90 degrees.
  EXPECT_EQ(m.samples.size(), 7311U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 86U);
  EXPECT_EQ(m.set_aside.total(), 86U);
  // Three incidences: 15, 30 and 60 degrees. (The groups of an isotropic measurement are one degree wide.)
  const Incidences incidences = GroupByIncidence(m);
  ASSERT_EQ(incidences.wi.size(), 3U);
  for (std::uint32_t group = 0; group < 3; ++group) {
    EXPECT_NEAR(RadiansToDegrees(PolarAngle(incidences.wi[group])), group == 0 ? 15 : group == 1 ? 30 : 60, 1e-6);
    // The sample straight back to the light outshines every one at least 5 degrees from light and mirror direction.
    double back = 0, elsewhere = 0;
    for (std::size_t i = 0; i < m.samples.size(); ++i) {
      if (incidences.group[i] != group || m.samples.wo_z[i] < 0.2) continue;
      const double value = m.samples.values[0][i];
      const double from_light = RadiansToDegrees(std::acos(std::fmin(1, Dot(m.samples.wi(i), m.samples.wo(i)))));
      if (from_light < 0.01) back = value;
      if (from_light > 5 && FromMirror(m.samples.wi(i), m.samples.wo(i)) > 5) elsewhere = std::fmax(elsewhere, value);
    }
    EXPECT_GT(back, 2 * elsewhere) << group;
  }
  // Line 11 of the file, straight from its text: view at 1.51843... towards the mirror side, f cos(theta_o) 0.00362877.
  std::size_t at = 0;
  while (at < m.samples.size() && m.samples.origin[at] != 11) ++at;
  ASSERT_LT(at, m.samples.size());
  EXPECT_NEAR(m.samples.wo_x[at], -std::sin(1.518436449235066599), 1e-15);
  EXPECT_NEAR(m.samples.values[0][at], 0.00362877 / std::cos(1.518436449235066599), 1e-13);
}

TEST(RealFormats, ZemaxCoatingPeaksInForwardScatter) {
  const auto path = kRealFiles / "rt300s" / "AnoBlackNiTEonSteel.bsdf";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.format, "zemax");
  // 4 incidences x 19 azimuths x 12 radial angles; radial 0 is one direction for 19 azimuths.
  EXPECT_EQ(m.samples.size() + m.set_aside.total(), 912U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 4U * 18);
  EXPECT_EQ(m.samples.size(), 647U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 134U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 59U);
  EXPECT_TRUE(m.isotropic);
  const std::size_t peak = PeakOf(m, 0);
  EXPECT_NEAR(RadiansToDegrees(PolarAngle(m.samples.wi(peak))), 70, 1e-9);
  EXPECT_NEAR(RadiansToDegrees(PolarAngle(m.samples.wo(peak))), 80, 1e-9);
  EXPECT_LT(m.samples.wo_x[peak], 0);
}

// The same coating as rows of the instrument and as a Zemax grid: at normal-plane angles both files give the same f_r.
TEST(RealFormats, ZemaxGridAgreesWithTheInstrumentsRows) {
  const auto grid_path = kRealFiles / "rt300s" / "AnoBlackNiTEonSteel.bsdf";
  const auto rows_path = kRealFiles / "rt300s" / "NiTE_on_steel_v1o0A_20250915.csv";
  SKIP_WITHOUT(grid_path);
  SKIP_WITHOUT(rows_path);
  const Measurement grid = ReadMeasurement(grid_path), rows = ReadMeasurement(rows_path);
  std::size_t pairs = 0, agreeing = 0;
  for (std::size_t g = 0; g < grid.samples.size(); ++g) {
    for (std::size_t r = 0; r < rows.samples.size(); ++r) {
      if (Norm(grid.samples.wi(g) - rows.samples.wi(r)) > 1e-6 || Norm(grid.samples.wo(g) - rows.samples.wo(r)) > 1e-6)
        continue;
      ++pairs;
      const double a = grid.samples.values[0][g], b = rows.samples.values[0][r];
      agreeing += std::fabs(a - b) < 0.15 * a ? 1 : 0;
    }
  }
  // The grid averages six measurements and takes a blank off, so a single reading is near it, not equal: 58 of 71
  // are within 15 percent. Turned or mirrored azimuths would put forward scatter, ten times brighter, on other
  // directions.
  EXPECT_GE(pairs, 60U);
  EXPECT_GT(agreeing, pairs * 3 / 4);
}

TEST(RealFormats, MbsdfPaintHasItsCells) {
  const auto path = kRealFiles / "mbsdf" / "carpaint_blue.mbsdf";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.format, "mbsdf");
  EXPECT_EQ(m.samples.size(), 45U * 45 * 90);
  EXPECT_EQ(m.set_aside.total(), 0U);
  std::size_t negative = 0;
  for (const auto& channel : m.samples.values) {
    for (const double value : channel) negative += value < 0 ? 1 : 0;
  }
  EXPECT_EQ(negative, 75159U);  // of 546750: noise, kept
  const std::size_t peak = PeakOf(m, 2);
  EXPECT_LT(FromMirror(m.samples.wi(peak), m.samples.wo(peak)), 4);
}

TEST(RealFormats, KlemsFabricHasBothSidesAndAStatedAlbedo) {
  const auto path = kRealFiles / "klems" / "mechoshade6216_klems_aniso_high.xml";
  SKIP_WITHOUT(path);
  for (const Side side : {Side::kFront, Side::kBack}) {
    ReadOptions options;
    options.side = side;
    const Measurement m = ReadMeasurement(path, options);
    EXPECT_EQ(m.format, "bsdf-xml");
    ASSERT_EQ(m.samples.size(), 145U * 145);
    EXPECT_FALSE(m.isotropic);
    // Directional-hemispherical reflectance of each incidence: sum of f cos over the exit patches, between 0 and 1.
    std::vector<double> albedo(145, 0), cosines(145, 0);
    for (std::size_t i = 0; i < m.samples.size(); ++i) {
      const double weight = m.samples.solid_angle[i] * m.samples.wo_z[i];
      albedo[i % 145] += m.samples.values[0][i] * weight;
      cosines[i % 145] += weight;
    }
    for (std::size_t p = 0; p < 145; ++p) {
      EXPECT_GT(kPi * albedo[p] / cosines[p], 0.1);
      EXPECT_LT(kPi * albedo[p] / cosines[p], 1.0);
    }
  }
}

}  // namespace
}  // namespace lobefit

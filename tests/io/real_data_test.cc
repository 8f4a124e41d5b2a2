// Real measurements, where they lie beside the repository; their counts were worked out by hand from the descriptions
// of the files.
#include <cmath>
#include <filesystem>

#include "tests/support/paths.h"
#include <gtest/gtest.h>

#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

const std::filesystem::path kData = test::SourceDir() / ".." / "shared" / "data";

#define SKIP_WITHOUT(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << (path) << " is not there"

TEST(RealData, RglPaperIsDiffuseAndItsMaskIsUnderstood) {
  const auto path = kData / "rgl" / "paper_white_rgb.bsdf";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_TRUE(m.isotropic);
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  // 8 directions x 32 x 32 nodes; the mask covers exactly what lies below the horizon.
  EXPECT_EQ(m.samples.size() + m.set_aside.total(), 8192U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kFlagged], 0U);
  // Away from grazing directions f_r is near albedo / pi.
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    if (m.samples.wi_z[i] < 0.6 || m.samples.wo_z[i] < 0.6) continue;
    sum += m.samples.values[1][i];
    ++count;
  }
  EXPECT_NEAR(kPi * sum / static_cast<double>(count), 0.82, 0.05);
}

TEST(RealData, EveryRglFileHasItsNodes) {
  const auto folder = kData / "rgl";
  SKIP_WITHOUT(folder);
  for (const char* name :
       {"cc_nothern_aurora", "chm_orange", "irid_flake_paint1", "paper_white", "satin_rosaline", "vch_silk_blue"}) {
    const Measurement m = ReadMeasurement(folder / (std::string(name) + "_rgb.bsdf"));
    EXPECT_EQ(m.samples.size() + m.set_aside.total(), 8192U) << name;
    EXPECT_EQ(m.set_aside[SetAsideReason::kFlagged], 0U) << name;
    EXPECT_EQ(m.samples.solid_angle.size(), m.samples.size()) << name;
    EXPECT_GT(m.samples.size(), 5500U) << name;
  }
}

TEST(RealData, InfraredMetalsLieInOnePlane) {
  const auto path = kData / "mwir_metals" / "stainless_steel_brushed.csv";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.samples.size(), 890U);                           // 10 theta_o x 89 theta_i
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 10U);  // theta_i = 90
  EXPECT_TRUE(IsInPlane(m.samples));
  EXPECT_EQ(GroupByIncidence(m).wi.size(), 89U);
  // The lobe of the viewer at 45 degrees peaks near the light at 45 degrees on the other side.
  double best = 0, theta = 0;
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    if (std::fabs(RadiansToDegrees(PolarAngle(m.samples.wo(i))) - 45) > 0.1) continue;
    EXPECT_LT(Dot(Vec3{m.samples.wi_x[i], m.samples.wi_y[i], 0}, m.samples.wo(i)), 0);
    if (m.samples.values[0][i] > best) {
      best = m.samples.values[0][i];
      theta = RadiansToDegrees(PolarAngle(m.samples.wi(i)));
    }
  }
  EXPECT_NEAR(theta, 45, 4);
}

TEST(RealData, ScatterometerPeaksInTheMirrorDirection) {
  const auto path = kData / "rt300s" / "NiTE_on_steel_v1o0A_20250915.csv";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.samples.size() + m.set_aside.total(), 2508U);  // 4 incidences x 19 azimuths x 33 angles
  // receive = 0 is one direction for all 19 azimuths, and azimuth -90 is azimuth 90 turned over: 33 - 1 angles.
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 4U * (18 + 32));
  double best = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    if (std::fabs(RadiansToDegrees(PolarAngle(m.samples.wi(i))) - 70) > 0.1 || m.samples.values[0][i] < best) continue;
    best = m.samples.values[0][i];
    at = i;
  }
  EXPECT_LT(Dot(Vec3{m.samples.wi_x[at], m.samples.wi_y[at], 0}, m.samples.wo(at)), 0);
  EXPECT_GT(RadiansToDegrees(PolarAngle(m.samples.wo(at))), 65);
}

// data/README.md: the lacquer's file has rectified noise near its floor.
TEST(RealData, RectifiedNoiseOfTheLacquerIsRecognised) {
  const auto path = kData / "mwir_metals" / "reference_lacquer_rough.csv";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  bool found = false;
  for (const std::string& remark : m.remarks) found = found || remark.starts_with("rectified noise");
  EXPECT_TRUE(found);
}

TEST(RealData, PtfeWavelengthsBecomeChannels) {
  const auto path = kData / "nist_ptfe" / "PTFE.data.csv";
  SKIP_WITHOUT(path);
  const Measurement m = ReadMeasurement(path);
  EXPECT_EQ(m.samples.size(), 1824U);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{351, 532, 633, 1064}));
  EXPECT_EQ(GroupByIncidence(m).wi.size(), 6U);
}

}  // namespace
}  // namespace lobefit

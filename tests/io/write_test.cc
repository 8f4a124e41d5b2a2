// Round trips: model -> writer -> reader -> the model's values at the directions that were read.
#include <cmath>

#include "tests/io/rgb_material.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/io/alta/writer.h"
#include "lobefit/io/bsdf_xml/writer.h"
#include "lobefit/io/csv/writer.h"
#include "lobefit/io/merl/writer.h"
#include "lobefit/io/mountain/writer.h"
#include "lobefit/io/read.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {
namespace {

TestBrdf Isotropic() {
  TestBrdf brdf;
  brdf.alpha_x = brdf.alpha_y = 0.3;
  brdf.tilt = brdf.rotation = 0;
  return brdf;
}

// Rows of three incidences, two of them at other azimuths.
Measurement Rows(const TestBrdf& brdf, const Channels& channels) {
  MeasurementBuilder builder(channels);
  const BrdfFunction rgb = Rgb(brdf);
  std::uint32_t row = 0;
  for (const auto& [theta_i, phi_i] : {std::pair{0.0, 0.0}, {0.5, 1.0}, {1.1, -2.0}}) {
    for (int a = 0; a < 9; ++a) {
      for (int b = 0; b < 12; ++b) {
        double values[3];
        const Vec3 wi = FromSpherical(theta_i, phi_i), wo = FromSpherical(0.05 + 0.15 * a, b * kPi / 6);
        rgb(wi, wo, values);
        builder.Add(wi, wo, values, ++row);
      }
    }
  }
  return builder.Finish();
}

void ExpectModel(const Measurement& m, const TestBrdf& brdf, double tolerance, std::size_t expected_samples) {
  EXPECT_EQ(m.samples.size(), expected_samples);
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    const double f = brdf(m.samples.wi(i), m.samples.wo(i));
    for (std::size_t c = 0; c < m.channels.size(); ++c) {
      ASSERT_NEAR(m.samples.values[c][i] / (f / std::ldexp(1, static_cast<int>(c))), 1, tolerance) << i << " " << c;
    }
  }
}

TEST(WriteCsv, RoundTrip) {
  const TestBrdf brdf;
  const TemporaryFile file;
  WriteCsv(Rows(brdf, kThreeChannels), {"lobefit.alpha_x: 0.15"}, file.path());
  ExpectModel(ReadMeasurement(file.path()), brdf, 1e-12, 324);
}

TEST(WriteAlta, RoundTrip) {
  const TestBrdf brdf;
  const TemporaryFile file;
  WriteAlta(Rows(brdf, kThreeChannels), file.path());
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_EQ(m.format, "alta");
  EXPECT_EQ(m.channels.names, kThreeChannels.names);
  ExpectModel(m, brdf, 1e-12, 324);
}

TEST(WriteMountain, OneFileAnIncidence) {
  const TestBrdf brdf;
  const Channels grey = {{"Y"}, {}};
  const TemporaryFile file;
  const auto files = WriteMountain(Rows(brdf, grey), file.path());
  ASSERT_EQ(files.size(), 3U);
  for (const auto& path : files) {
    const Measurement m = ReadMeasurement(path);
    EXPECT_EQ(m.format, "mountain");
    // The incident angles have two decimals.
    for (std::size_t i = 0; i < m.samples.size(); ++i) {
      ASSERT_NEAR(m.samples.values[0][i] / brdf(m.samples.wi(i), m.samples.wo(i)), 1, 5e-3);
    }
    EXPECT_EQ(m.samples.size(), 108U);
    std::filesystem::remove(path);
  }
  EXPECT_THROW(WriteMountain(Rows(brdf, {{"450nm", "550nm", "650nm"}, {450, 550, 650}}), file.path()), UsageError);
}

// X Y Z are those of the same primaries as everywhere, to all their digits.
TEST(WriteMountain, ColoursComeBack) {
  const TemporaryFile file;
  for (const auto& path : WriteMountain(Rows(TestBrdf(), kThreeChannels), file.path())) {
    Measurement m = ReadMeasurement(path);
    EXPECT_EQ(m.channels.names, (std::vector<std::string>{"X", "Y", "Z"}));
    Apply(MakeChannelMap("rgb", m.channels), &m);
    for (std::size_t i = 0; i < m.samples.size(); ++i) {
      ASSERT_NEAR(m.samples.values[1][i] / m.samples.values[0][i], 0.5, 2e-6);
      ASSERT_NEAR(m.samples.values[2][i] / m.samples.values[0][i], 0.25, 2e-6);
    }
    std::filesystem::remove(path);
  }
}

TEST(WriteMerl, RoundTripAtBothCellPositions) {
  for (const CellPosition cell : {CellPosition::kCentre, CellPosition::kEdge}) {
    const TemporaryFile file;
    WriteMerl(Rgb(Isotropic()), kThreeChannels, {cell, 1e-3}, file.path());
    ReadOptions options;
    options.merl_cell = cell;
    const Measurement m = ReadMeasurement(file.path(), options);
    EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 0U);
    ExpectModel(m, Isotropic(), 1e-9, m.samples.size());
    EXPECT_GT(m.samples.size(), 1000000U);
  }
}

TEST(WriteMerl, RefusesWhatTheTableCannotHold) {
  const TemporaryFile file;
  for (const double tilt : {0.0, 0.02}) {
    TestBrdf brdf = Isotropic();
    (tilt == 0 ? brdf.alpha_x : brdf.tilt) = tilt == 0 ? 0.31 : tilt;
    try {
      WriteMerl(Rgb(brdf), kThreeChannels, {}, file.path());
      FAIL() << tilt;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("turns about its normal"), std::string::npos);
    }
  }
  EXPECT_FALSE(std::filesystem::exists(file.path()));
  EXPECT_LT(AzimuthDependence(Rgb(Isotropic()), 3), 1e-12);
}

TEST(WriteTensorTree, RoundTripOfRank4AndRank3) {
  for (const bool isotropic : {false, true}) {
    const TestBrdf brdf = isotropic ? Isotropic() : TestBrdf();
    const TemporaryFile file;
    TensorTreeOptions options;
    options.isotropic = isotropic;
    options.log2_resolution = 4;
    options.tolerance = 0;
    const Channels grey = {{"Y"}, {}};
    const BrdfFunction one = [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = brdf(wi, wo); };
    WriteTensorTree(one, grey, options, file.path());
    const Measurement m = ReadMeasurement(file.path());
    EXPECT_EQ(m.format, "bsdf-xml");
    EXPECT_EQ(m.isotropic, isotropic);
    ExpectModel(m, brdf, 1e-5, isotropic ? 16U * 16 * 8 : 16U * 16 * 16 * 16);
  }
}

TEST(WriteTensorTree, ColoursAndMergedCellsStayWithinTheTolerance) {
  const TestBrdf brdf;
  const TemporaryFile file;
  TensorTreeOptions options;
  options.log2_resolution = 4;
  WriteTensorTree(Rgb(brdf), kThreeChannels, options, file.path());
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_LT(m.samples.size(), 65536U);
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    double f[3] = {};
    Rgb(brdf)(m.samples.wi(i), m.samples.wo(i), f);
    // A merged cell's centre may differ from its mean by the tolerance on either side, in luminance and in colour.
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(m.samples.values[c][i] / f[c], 1, 0.08) << i;
  }
}

// Radiance loses the colour of a diffuse part in a tree of rank 3; grey needs no colour.
TEST(WriteTensorTree, RankAndBlocksThatRadianceReads) {
  TensorTreeOptions options;
  options.isotropic = true;
  options.log2_resolution = 3;
  const auto text = [&](double red, double green) {
    const TemporaryFile file;
    WriteTensorTree(
        [&](const Vec3&, const Vec3&, double* values) {
          values[0] = red / kPi;
          values[1] = values[2] = green / kPi;
        },
        kThreeChannels, options, file.path());
    return std::string(FileBytes(file.path()).bytes());
  };
  EXPECT_NE(text(0.2, 0.1).find("TensorTree4"), std::string::npos);
  EXPECT_NE(text(0.002, 0.001).find("TensorTree3"), std::string::npos);
  EXPECT_NE(text(0.2, 0.1).find("CIE-u"), std::string::npos);
  EXPECT_NE(text(0.2, 0.2).find("TensorTree3"), std::string::npos);
  EXPECT_EQ(text(0.2, 0.2).find("CIE-u"), std::string::npos);
}

}  // namespace
}  // namespace lobefit

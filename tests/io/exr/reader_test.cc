#include <array>
#include <cmath>

#include "tests/io/rgb_material.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/io/exr/writer.h"
#include "lobefit/io/read.h"
#include "lobefit/io/text/options.h"

namespace lobefit {
namespace {

void ExpectModel(const Measurement& m, const TestBrdf& brdf) {
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    ASSERT_NEAR(m.samples.values[1][i] / (brdf(m.samples.wi(i), m.samples.wo(i)) / 2), 1, 1e-5) << i;
  }
}

TEST(Exr, SlicesComeBack) {
  TestBrdf brdf;
  brdf.tilt = 0;
  for (const ExrAxes axes : {ExrAxes::kSlice, ExrAxes::kSliceSqrt}) {
    for (const ExrRows rows : {ExrRows::kUp, ExrRows::kDown}) {
      const TemporaryFile file;
      ExrMap map;
      map.axes = axes;
      map.rows = rows;
      map.phi_d = DegreesToRadians(40);
      WriteExr(Rgb(brdf), kThreeChannels, map, 48, 32, "test", file.path());
      const Measurement m = ReadMeasurement(file.path());
      EXPECT_EQ(m.format, "exr");
      EXPECT_TRUE(m.isotropic);
      EXPECT_EQ(m.samples.size() + m.set_aside.total(), 48U * 32);
      EXPECT_GT(m.set_aside[SetAsideReason::kBelowHorizon], 100U);
      EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 0U);
      EXPECT_EQ(m.conventions.at("exr-rows"), Name(rows) + " (attribute)");
      ExpectModel(m, brdf);
    }
  }
}

// At phi_d = 90 degrees every pixel is a pair of directions; the left edge is the peak, the bottom row the light's own
// direction.
TEST(Exr, SliceAxesAreThoseOfTheFormat) {
  ExrMap map;
  Vec3 wi, wo;
  double measure = 0;
  for (std::size_t row = 0; row < 8; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      EXPECT_TRUE(map.Directions(column, row, 8, 8, &wi, &wo, &measure));
    }
  }
  map.Directions(0, 0, 90, 90, &wi, &wo, &measure);
  const HalfDifference top_left = ToHalfDifference(wi, wo);
  EXPECT_NEAR(RadiansToDegrees(top_left.theta_h), 0.5, 1e-9);
  EXPECT_NEAR(RadiansToDegrees(top_left.theta_d), 89.5, 1e-9);
  map.Directions(89, 89, 90, 90, &wi, &wo, &measure);
  const HalfDifference bottom_right = ToHalfDifference(wi, wo);
  EXPECT_NEAR(RadiansToDegrees(bottom_right.theta_h), 89.5, 1e-9);
  EXPECT_NEAR(RadiansToDegrees(bottom_right.theta_d), 0.5, 1e-9);
  EXPECT_NEAR(RadiansToDegrees(bottom_right.phi_d), 90, 1e-9);
}

// Both kinds of slice cut the same pairs of directions: the pixels' measures make sums over them the same integrals.
TEST(Exr, SlicesIntegrateAlike) {
  const auto sums = [](ExrAxes axes) {
    constexpr std::size_t kSize = 400;
    ExrMap map;
    map.axes = axes;
    double sum = 0, narrow = 0;
    for (std::size_t row = 0; row < kSize; ++row) {
      for (std::size_t column = 0; column < kSize; ++column) {
        Vec3 wi, wo;
        double measure = 0;
        if (!map.Directions(column, row, kSize, kSize, &wi, &wo, &measure)) continue;
        sum += measure / (kSize * kSize);
        narrow += measure / (kSize * kSize) * std::pow(ToHalfDifference(wi, wo).theta_h + 0.1, -2);
      }
    }
    return std::pair(sum, narrow);
  };
  const auto [even, even_narrow] = sums(ExrAxes::kSlice);
  const auto [root, root_narrow] = sums(ExrAxes::kSliceSqrt);
  EXPECT_NEAR(root / even, 1, 1e-3);
  EXPECT_NEAR(root_narrow / even_narrow, 1, 1e-3);
}

TEST(Exr, HemispheresComeBackAndIntegrate) {
  const TestBrdf brdf;
  for (const ExrProjection projection :
       {ExrProjection::kEquidistant, ExrProjection::kEqualArea, ExrProjection::kConcentric}) {
    const TemporaryFile file;
    ExrMap map;
    map.axes = ExrAxes::kHemisphere;
    map.projection = projection;
    map.theta_i = 0.5;
    map.phi_i = -1.25;
    WriteExr(Rgb(brdf), kThreeChannels, map, 128, 128, "test", file.path());
    const Measurement m = ReadMeasurement(file.path());
    EXPECT_FALSE(m.isotropic);
    EXPECT_NEAR(Norm(m.samples.wi(0) - FromSpherical(0.5, -1.25)), 0, 1e-6);
    ExpectModel(m, brdf);
    // The solid angles make sums integrals over the hemisphere: of cos^2(theta) it is 2/3 of that of cos(theta).
    double cosine = 0, squared = 0;
    for (std::size_t i = 0; i < m.samples.size(); ++i) {
      cosine += m.samples.solid_angle[i] * m.samples.wo_z[i];
      squared += m.samples.solid_angle[i] * m.samples.wo_z[i] * m.samples.wo_z[i];
    }
    EXPECT_NEAR(squared / cosine, 2.0 / 3, 1e-3) << Name(projection);
  }
}

TEST(Exr, OptionsStandInForAttributes) {
  const TestBrdf brdf;
  const TemporaryFile file;
  WriteExr(Rgb(brdf), {{"450nm", "550nm", "650nm"}, {450, 550, 650}}, ExrMap(), 16, 16, "", file.path());
  ReadOptions options;
  options.exr_phi_d_deg = 90;
  options.exr_axes = ExrAxes::kHemisphere;
  EXPECT_THROW(ReadMeasurement(file.path(), options), InputError);  // no light
  options.exr_theta_i_deg = 20;
  options.value_kind = ValueKind::kBrdfCosO;
  const Measurement m = ReadMeasurement(file.path(), options);
  EXPECT_NEAR(Norm(m.samples.wi(0) - FromSpherical(DegreesToRadians(20), 0)), 0, 1e-12);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{450, 550, 650}));
  EXPECT_EQ(m.conventions.at("value-kind"), "f-cos-o (option)");
}

TEST(Exr, A288SquareWithoutAttributesIsUtia) {
  const TestBrdf brdf;
  const TemporaryFile file;
  ExrMap map;
  map.axes = ExrAxes::kUtia;
  WriteExr(Rgb(brdf), kThreeChannels, map, 288, 288, "", file.path());
  const Measurement m = ReadMeasurement(file.path());
  // 6 x 48 directions, of which 47 repeat the normal.
  EXPECT_EQ(m.samples.size(), 241U * 241);
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], 288U * 288 - 241 * 241);
  ExpectModel(m, brdf);
}

TEST(Exr, EveryCutIsRefused) {
  const TemporaryFile file;
  WriteExr(Rgb(TestBrdf()), kThreeChannels, ExrMap(), 24, 24, "", file.path());
  const FileBytes mapped(file.path());
  const std::string bytes(mapped.bytes());
  for (std::size_t length = 1; length + 1 < bytes.size(); length += 17) {
    EXPECT_THROW(ReadMeasurement(TemporaryFile(bytes.substr(0, length)).path()), InputError) << length;
  }
}

}  // namespace
}  // namespace lobefit

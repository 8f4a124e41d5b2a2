// Headerless and binary tables of anisotropic databases: UTIA and MIT.
#include <array>
#include <cmath>
#include <cstring>

#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

std::string UtiaBytes(const std::function<double(std::size_t pair, std::size_t plane)>& stored) {
  constexpr std::size_t kPairs = 288 * 288;
  std::string bytes(3 * kPairs * 8, '\0');
  for (std::size_t i = 0; i < 3 * kPairs; ++i) {
    const double value = stored(i % kPairs, i / kPairs);
    std::memcpy(bytes.data() + 8 * i, &value, 8);
  }
  return bytes;
}

TEST(Utia, PlanesAnglesAndEncodings) {
  const std::string bytes = UtiaBytes([](std::size_t pair, std::size_t plane) {
    return 1e-6 * static_cast<double>(pair + 1) + static_cast<double>(plane);
  });
  const TemporaryFile file(bytes);
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_EQ(m.format, "utia");
  EXPECT_EQ(m.samples.size(), 241U * 241);
  for (std::size_t i = 0; i < m.samples.size(); i += 501) {
    const std::size_t pair = m.samples.origin[i];
    const std::size_t ti = pair / 288 / 48, pi = pair / 288 % 48, tv = pair % 288 / 48, pv = pair % 48;
    const auto direction = [](std::size_t theta, std::size_t phi) {
      return FromSpherical(static_cast<double>(theta) * kPi / 12, static_cast<double>(phi) * kPi / 24);
    };
    EXPECT_NEAR(Norm(m.samples.wi(i) - direction(ti, pi)), 0, 1e-14);
    EXPECT_NEAR(Norm(m.samples.wo(i) - direction(tv, pv)), 0, 1e-14);
    EXPECT_NEAR(m.samples.values[2][i], 1e-6 * static_cast<double>(pair + 1) + 2, 1e-12);
  }
  ReadOptions options;
  options.utia_encoding = UtiaEncoding::kSrgb;
  options.utia_scale = 0.5;
  const Measurement decoded = ReadMeasurement(file.path(), options);
  const double encoded = (1 + 1e-6) / 140;  // below the break of the curve
  EXPECT_NEAR(decoded.samples.values[1][0], 0.5 * 100 * encoded / 12.92, 1e-12);
  EXPECT_EQ(decoded.conventions.at("utia-encoding"), "srgb");
  EXPECT_EQ(decoded.conventions.at("utia-scale"), "0.5 (option)");
}

std::string MitBytes(const std::array<std::int32_t, 4>& bins, std::int32_t half_data,
                     const std::function<float(std::size_t cell, std::size_t plane)>& stored) {
  std::array<std::int32_t, 16> head = {};
  std::copy(bins.begin(), bins.end(), head.begin());
  head[6] = 1;
  head[9] = half_data;
  head[10] = 3;
  const std::size_t cells = static_cast<std::size_t>(bins[0]) * static_cast<std::size_t>(bins[1]) *
                            static_cast<std::size_t>(bins[2]) * static_cast<std::size_t>(bins[3]);
  std::string bytes(64 + 12 * cells, '\0');
  std::memcpy(bytes.data(), head.data(), 64);
  for (std::size_t i = 0; i < 3 * cells; ++i) {
    const float value = stored(i % cells, i / cells);
    std::memcpy(bytes.data() + 64 + 4 * i, &value, 4);
  }
  return bytes;
}

TEST(Mit, AxesScaleAndHoles) {
  const auto stored = [](std::size_t cell, std::size_t plane) {
    return cell == 7 && plane == 1 ? -1.0F : static_cast<float>(cell) + 0.25F * static_cast<float>(plane);
  };
  for (const std::int32_t half : {0, 1}) {
    const TemporaryFile file(MitBytes({3, 4, 5, 6}, half, stored));
    ReadOptions options;
    options.mit_cell = CellPosition::kCentre;
    const Measurement m = ReadMeasurement(file.path(), options);
    EXPECT_EQ(m.format, "mit");
    EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 1U);
    EXPECT_EQ(m.samples.size(), 3U * 4 * 5 * 6 - 1);
    for (std::size_t i = 0; i < m.samples.size(); ++i) {
      const std::size_t cell = m.samples.origin[i];
      const double pi = static_cast<double>(cell % 6) + 0.5, d = static_cast<double>(cell / 6 % 5) + 0.5;
      const double to = static_cast<double>(cell / 30 % 4) + 0.5, ti = static_cast<double>(cell / 120) + 0.5;
      const double phi_i = pi / 6 * 2 * kPi, phi_d = d / 5 * (half == 1 ? kPi : 2 * kPi);
      ASSERT_NEAR(Norm(m.samples.wi(i) - FromSpherical(ti / 3 * kPi / 2, phi_i)), 0, 1e-14);
      ASSERT_NEAR(Norm(m.samples.wo(i) - FromSpherical(to / 4 * kPi / 2, phi_i + phi_d)), 0, 1e-14);
      ASSERT_NEAR(m.samples.values[1][i], 10 * (static_cast<double>(cell) + 0.25), 1e-9);
    }
  }
}

TEST(Mit, StrideAndScaleAreOptions) {
  const TemporaryFile file(MitBytes({2, 2, 8, 6}, 0, [](std::size_t, std::size_t) { return 1.0F; }));
  ReadOptions options;
  options.mit_stride = 2;
  options.mit_scale = 1;
  const Measurement m = ReadMeasurement(file.path(), options);
  EXPECT_EQ(m.samples.size(), 2U * 2 * 4 * 3);
  EXPECT_EQ(m.samples.values[0][0], 1);
  ASSERT_EQ(m.remarks.size(), 2U);
  EXPECT_NE(m.remarks[0].find("every 2. azimuth"), std::string::npos);
  // f_r of 1 everywhere reflects pi times what it receives.
  EXPECT_NE(m.remarks[1].find("albedo"), std::string::npos) << m.remarks[1];
}

}  // namespace
}  // namespace lobefit

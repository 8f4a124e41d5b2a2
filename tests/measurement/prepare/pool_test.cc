#include "lobefit/measurement/prepare/pool.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

Measurement Part(const char* name, double theta_i, const Channels& channels, std::vector<double> values) {
  MeasurementBuilder builder(channels);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::vector<double> all(channels.size(), values[k]);
    builder.Add(FromSpherical(DegreesToRadians(theta_i), 0), FromSpherical(0.1 * static_cast<double>(k + 1), kPi),
                all.data(), static_cast<std::uint32_t>(k + 2));
  }
  Measurement m = builder.Finish();
  m.source = name;
  m.format = "csv";
  m.sha256 = name;
  m.conventions["angle-unit"] = "deg (default)";
  return m;
}

TEST(Pool, PartsFollowEachOther) {
  const Measurement m = Pool({Part("a", 10, {{"Y"}, {}}, {1, 2}), Part("b", 30, {{"Y"}, {}}, {3, 4, 5})}, true);
  ASSERT_EQ(m.samples.size(), 5U);
  EXPECT_EQ(m.samples.values[0], (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_EQ(m.samples.origin[3], 3U);
  EXPECT_EQ(m.samples.file, (std::vector<std::uint32_t>{0, 0, 1, 1, 1}));
  EXPECT_EQ(m.source, "a and 1 more");
  EXPECT_EQ(m.conventions.at("angle-unit"), "deg (default)");
  EXPECT_EQ(m.sha256.size(), 64U);
}

TEST(Pool, TheSameDirectionsAreRepeats) {
  const Measurement merged = Pool({Part("a", 10, {{"Y"}, {}}, {1, 2}), Part("b", 10, {{"Y"}, {}}, {3})}, true);
  ASSERT_EQ(merged.samples.size(), 2U);
  EXPECT_EQ(merged.samples.values[0][0], 2);
  EXPECT_EQ(merged.samples.file, (std::vector<std::uint32_t>{0, 0})) << "a mean counts for the first";
  const Measurement first = Pool({Part("a", 10, {{"Y"}, {}}, {1, 2}), Part("b", 10, {{"Y"}, {}}, {3})}, false);
  EXPECT_EQ(first.samples.values[0], (std::vector<double>{1, 2}));
  EXPECT_EQ(first.set_aside[SetAsideReason::kDuplicate], 1U);
}

TEST(Pool, AFileForEachWavelength) {
  const Channels green = {{"550nm"}, {550}}, blue = {{"450nm"}, {450}}, wandered = {{"550.1nm"}, {550.1}};
  const Measurement m =
      Pool({Part("g", 10, green, {1, 2, 3}), Part("b", 10, blue, {4, 5}), Part("g2", 30, wandered, {6})}, true);
  EXPECT_EQ(m.channels.wavelengths_nm, (std::vector<double>{450, 550}));
  ASSERT_EQ(m.samples.size(), 4U);
  EXPECT_TRUE(m.samples.file.empty()) << "each is a channel";
  // Ascending wavelengths: the blue file's pairs come first.
  EXPECT_EQ(m.samples.values[0][0], 4);
  EXPECT_EQ(m.samples.values[1][0], 1);
  EXPECT_TRUE(std::isnan(m.samples.values[0][2]));
  EXPECT_EQ(m.samples.values[1][2], 3);
  EXPECT_EQ(m.samples.values[1][3], 6);
}

TEST(Pool, WhatDoesNotGoTogetherNamesBothFiles) {
  const auto message = [](Measurement a, Measurement b) {
    std::vector<Measurement> parts;
    parts.push_back(std::move(a));
    parts.push_back(std::move(b));
    try {
      Pool(std::move(parts), true);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(Part("a", 10, {{"Y"}, {}}, {1}), Part("b", 10, {{"R", "G", "B"}, {}}, {1})),
            "a and b do not go together: the channels are Y and R, G, B");
  Measurement isotropic = Part("iso", 10, {{"Y"}, {}}, {1});
  isotropic.isotropic = true;
  EXPECT_EQ(message(Part("a", 10, {{"Y"}, {}}, {1}), isotropic),
            "a and iso do not go together: one is isotropic by construction, the other states azimuths of the light");
}

TEST(Pool, WeightsOfPartsWithoutAnyAreTheMean) {
  Measurement weighted = Part("w", 10, {{"Y"}, {}}, {1, 2});
  weighted.samples.weight = {0.5, 1.5};
  const Measurement m = Pool({Part("a", 30, {{"Y"}, {}}, {1}), weighted}, true);
  EXPECT_EQ(m.samples.weight, (std::vector<double>{1, 0.5, 1.5}));
}

}  // namespace
}  // namespace lobefit

// Samples as arrays, and what the builder takes, counts and sets aside.
#include "lobefit/measurement/measurement.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "lobefit/math/directions.h"
#include "lobefit/measurement/pair_index.h"

namespace lobefit {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// All arrays in use, each number different.
Samples Full(std::size_t count) {
  Samples samples;
  samples.values.resize(2);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i), values[] = {x + 0.7, x + 0.8};
    samples.Append({x + 0.1, x + 0.2, x + 0.3}, {x + 0.4, x + 0.5, x + 0.6}, values,
                   static_cast<std::uint32_t>(10 + i));
    samples.weight.push_back(x + 0.9);
    samples.sigma.push_back(x + 0.91);
    samples.solid_angle.push_back(x + 0.92);
    samples.sample_azimuth.push_back(x + 0.93);
    samples.file.push_back(static_cast<std::uint32_t>(20 + i));
  }
  return samples;
}

// The numbers of sample i, whatever they stand for.
std::vector<double> Row(const Samples& s, std::size_t i) {
  return {s.wi_x[i],
          s.wi_y[i],
          s.wi_z[i],
          s.wo_x[i],
          s.wo_y[i],
          s.wo_z[i],
          s.values[0][i],
          s.values[1][i],
          s.weight[i],
          s.sigma[i],
          s.solid_angle[i],
          s.sample_azimuth[i],
          static_cast<double>(s.file[i]),
          static_cast<double>(s.origin[i])};
}

TEST(Samples, KeepIsTheSubsetOfThoseKept) {
  std::mt19937 random(5);
  const Samples all = Full(60);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::uint8_t> keep(60);
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < keep.size(); ++i) {
      keep[i] = trial == 0 ? 1 : trial == 1 ? 0 : random() % 3 != 0;
      if (keep[i] != 0) indices.push_back(i);
    }
    Samples kept = all;
    kept.Keep(keep);
    const Samples subset = all.Subset(indices);
    ASSERT_EQ(kept.size(), indices.size());
    ASSERT_EQ(subset.size(), indices.size());
    for (std::size_t k = 0; k < indices.size(); ++k) {
      ASSERT_EQ(Row(kept, k), Row(all, indices[k]));
      ASSERT_EQ(Row(subset, k), Row(all, indices[k]));
    }
  }
}

TEST(Samples, ASubsetTakesAnyOrderAndRepeats) {
  const Samples all = Full(5), subset = all.Subset({4, 0, 4});
  ASSERT_EQ(subset.size(), 3U);
  EXPECT_EQ(Row(subset, 0), Row(all, 4));
  EXPECT_EQ(Row(subset, 1), Row(all, 0));
  EXPECT_EQ(Row(subset, 2), Row(all, 4));
}

TEST(Samples, ArraysThatAreNotInUseStayEmpty) {
  Samples samples = Full(4);
  samples.weight.clear(), samples.sigma.clear(), samples.sample_azimuth.clear(), samples.file.clear();
  samples.Resize(2);
  samples.Keep({1, 0});
  EXPECT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples.values[1].size(), 1U);
  EXPECT_EQ(samples.solid_angle.size(), 1U);
  EXPECT_EQ(samples.weight.size() + samples.sigma.size() + samples.sample_azimuth.size() + samples.file.size(), 0U);
}

TEST(MeasurementBuilder, TakesDirectionsOfAnyLength) {
  MeasurementBuilder builder({{"Y"}, {}});
  const double value = 0.5;
  EXPECT_TRUE(builder.Add({0, 3, 4}, {1e-100, 0, 1e-100}, &value, 7));
  const Measurement m = builder.Finish();
  EXPECT_NEAR(m.samples.wi_y[0], 0.6, 1e-15);
  EXPECT_NEAR(m.samples.wi_z[0], 0.8, 1e-15);
  EXPECT_EQ(m.samples.origin[0], 7U);
}

TEST(MeasurementBuilder, SaysWhyASampleIsSetAside) {
  MeasurementBuilder builder({{"R", "G"}, {}});
  const double good[] = {1, 2}, half[] = {kNan, 2}, none[] = {kNan, std::numeric_limits<double>::infinity()},
               negative[] = {-1, -2};
  const Vec3 up = {0, 0, 1};
  EXPECT_TRUE(builder.Add(up, FromSpherical(0.1, 0), good, 0));
  EXPECT_TRUE(builder.Add(up, FromSpherical(0.2, 0), half, 1)) << "a value in one channel is one";
  EXPECT_TRUE(builder.Add(up, FromSpherical(0.3, 0), negative, 2)) << "noise about zero";
  EXPECT_FALSE(builder.Add(up, FromSpherical(0.4, 0), none, 3));
  EXPECT_FALSE(builder.Add({kNan, 0, 1}, up, good, 4));
  EXPECT_FALSE(builder.Add(up, FromSpherical(kPi / 2, 0), good, 5)) << "cos(90 degrees) is 6e-17";
  EXPECT_FALSE(builder.Add(FromSpherical(2, 0), up, good, 6));
  EXPECT_FALSE(builder.Add(FromSpherical(2, 0), up, none, 7)) << "counted once";
  const Measurement m = builder.Finish();
  EXPECT_EQ(m.samples.size(), 3U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kNotFinite], 3U);
  EXPECT_EQ(m.set_aside[SetAsideReason::kBelowHorizon], 2U);
  EXPECT_EQ(m.set_aside.total(), 5U);
}

// Far more pairs than look-ups that are prepared ahead, with repeats near and far.
TEST(MeasurementBuilder, TheFirstOfEqualPairsStays) {
  MeasurementBuilder builder({{"Y"}, {}});
  std::mt19937 random(11);
  std::map<std::pair<unsigned, unsigned>, std::uint32_t> first;
  std::size_t repeats = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const unsigned a = random() % 40, b = random() % 40;
    const double value = i;
    builder.Add(FromSpherical(0.02 * a, 1), FromSpherical(0.02 * b, 2), &value, i);
    if (!first.try_emplace({a, b}, i).second) ++repeats;
  }
  const Measurement m = builder.Finish();
  EXPECT_EQ(m.set_aside[SetAsideReason::kDuplicate], repeats);
  ASSERT_EQ(m.samples.size(), first.size());
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    const auto a = static_cast<unsigned>(std::lround(PolarAngle(m.samples.wi(i)) / 0.02)),
               b = static_cast<unsigned>(std::lround(PolarAngle(m.samples.wo(i)) / 0.02));
    ASSERT_EQ((first.at({a, b})), m.samples.origin[i]);
    if (i > 0) {
      ASSERT_LT(m.samples.origin[i - 1], m.samples.origin[i]) << "in the file's order";
    }
  }
}

// Against a map; it grows from nothing.
TEST(PairIndex, NumbersPairsAsTheyCome) {
  std::mt19937 random(2);
  PairIndex index;
  std::map<std::pair<unsigned, unsigned>, std::size_t> numbers;
  for (int i = 0; i < 20000; ++i) {
    const unsigned a = random() % 200, b = random() % 200;
    const std::size_t expected = numbers.try_emplace({a, b}, numbers.size()).first->second;
    const Vec3 wi = FromSpherical(0.007 * a, 0.5), wo = FromSpherical(0.007 * b, -2);
    ASSERT_EQ(index.FindOrAdd(wi, wo), expected) << i;
    ASSERT_EQ(index.size(), numbers.size());
  }
  // The order of the two directions counts.
  PairIndex two;
  EXPECT_EQ(two.FindOrAdd({0, 0, 1}, {1, 0, 0}), 0U);
  EXPECT_EQ(two.FindOrAdd({1, 0, 0}, {0, 0, 1}), 1U);
}

}  // namespace
}  // namespace lobefit

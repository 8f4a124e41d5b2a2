// Samples that become one: repetitions, polarisations, and samples that lack a channel.
#include "lobefit/measurement/prepare/repeats.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/prepare/incomplete.h"
#include "lobefit/measurement/prepare/polarisation.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const Vec3 kLight = FromSpherical(0.5, 0);

// As readers have samples before they are merged: equal pairs follow one another.
struct Rows {
  Measurement measurement;

  explicit Rows(std::size_t channels = 1) {
    for (std::size_t c = 0; c < channels; ++c) measurement.channels.names.push_back("c" + std::to_string(c));
    measurement.samples.values.resize(channels);
    measurement.source = "rows.csv";
  }
  void Add(double theta_o, std::vector<double> values) {
    measurement.samples.Append(kLight, FromSpherical(theta_o, 1), values.data(), 7);
  }
  const std::vector<double>& values(std::size_t channel = 0) const { return measurement.samples.values[channel]; }
};

TEST(MergeRepeated, MeansStandWhereTheFirstStood) {
  Rows rows(2);
  rows.Add(0.1, {1, 10});
  rows.Add(0.2, {5, 50});
  rows.Add(0.1, {3, 30});
  rows.Add(0.3, {8, 80});
  rows.Add(0.1, {2, 20});
  const Repeats repeats = MergeRepeated(&rows.measurement);
  EXPECT_EQ(repeats.pairs, 1U);
  EXPECT_EQ(repeats.samples, 3U);
  EXPECT_THAT(rows.values(0), testing::ElementsAre(2, 5, 8));
  EXPECT_THAT(rows.values(1), testing::ElementsAre(20, 50, 80));
  ASSERT_EQ(rows.measurement.samples.sigma.size(), 3U);
}

TEST(MergeRepeated, NothingRepeatedIsNothingDone) {
  Rows rows;
  rows.Add(0.1, {1});
  rows.Add(0.1 + 1e-6, {2});
  EXPECT_EQ(MergeRepeated(&rows.measurement).pairs, 0U);
  EXPECT_EQ(rows.values().size(), 2U);
  EXPECT_TRUE(rows.measurement.samples.sigma.empty());
  Rows none;
  EXPECT_EQ(MergeRepeated(&none.measurement).pairs, 0U);
}

// Noise of known relative size: it is found, and the means scatter by what is stated of them.
TEST(MergeRepeated, FindsTheNoiseThatIsThere) {
  std::mt19937 engine(2);
  std::normal_distribution<double> normal;
  constexpr double kNoise = 0.04;
  constexpr int kPairs = 4000;
  Rows rows;
  for (int k = 0; k < kPairs; ++k) {
    const double truth = 1 + k % 5;
    for (int r = 0; r < 1 + k % 3; ++r) rows.Add(0.0003 * k, {truth * (1 + kNoise * normal(engine))});
  }
  const Repeats repeats = MergeRepeated(&rows.measurement);
  EXPECT_NEAR(repeats.relative_spread, kNoise, 0.03 * kNoise);
  const Samples& samples = rows.measurement.samples;
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kPairs));
  double squares[3] = {0, 0, 0}, counts[3] = {0, 0, 0};
  for (int k = 0; k < kPairs; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double z = (samples.values[0][i] - (1 + k % 5)) / samples.sigma[i];
    squares[k % 3] += z * z;
    ++counts[k % 3];
  }
  for (int r = 0; r < 3; ++r) EXPECT_NEAR(squares[r] / counts[r], 1, 0.15) << r + 1 << " readings";
}

// A pair with many repetitions speaks for itself, whatever the others scatter by; one with two hardly does.
TEST(MergeRepeated, ManyRepetitionsHaveTheirOwnSpread) {
  Rows rows;
  for (int k = 0; k < 200; ++k) rows.Add(0.1, {k % 2 == 0 ? 0.5 : 1.5});
  for (int pair = 0; pair < 400; ++pair) {
    for (const double value : {0.99, 1.01}) rows.Add(0.2 + 0.001 * pair, {value});
  }
  const Repeats repeats = MergeRepeated(&rows.measurement);
  const std::vector<double>& sigma = rows.measurement.samples.sigma;
  EXPECT_NEAR(sigma[0], 0.5 / std::sqrt(200), 0.03 * sigma[0]);
  EXPECT_NEAR(sigma[1], repeats.relative_spread / std::sqrt(2), 0.15 * sigma[1]);
}

TEST(DropIncomplete, WhatLacksAChannelIsAHole) {
  Rows rows(2);
  rows.Add(0.1, {1, 2});
  rows.Add(0.2, {std::nan(""), 2});
  rows.Add(0.3, {std::nan(""), std::nan("")});
  rows.Add(0.4, {1, HUGE_VAL});
  rows.Add(0.5, {3, 4});
  DropIncomplete(&rows.measurement);
  EXPECT_THAT(rows.values(0), testing::ElementsAre(1, 3));
  EXPECT_THAT(rows.values(1), testing::ElementsAre(2, 4));
  EXPECT_EQ(rows.measurement.set_aside[SetAsideReason::kHole], 3U);
  EXPECT_EQ(rows.measurement.left_out.size(), 3U) << "once each";
  DropIncomplete(&rows.measurement);
  EXPECT_EQ(rows.measurement.set_aside.total(), 3U);
}

TEST(AverageOverPolarisation, UnpolarisedLightIsHalfOfEach) {
  Rows rows(2);
  rows.Add(0.1, {1, 10});
  rows.Add(0.1, {3, 50});
  rows.Add(0.2, {4, 4});  // s twice: averaged before
  rows.Add(0.2, {8, 8});
  rows.Add(0.2, {1, 1});
  rows.Add(0.3, {9, 9});  // p is missing
  const std::string remark = AverageOverPolarisation({0, 1, 0, 0, 1, 0}, {"s", "p"}, &rows.measurement);
  EXPECT_THAT(rows.values(0), testing::ElementsAre(2, 3.5));
  EXPECT_THAT(rows.values(1), testing::ElementsAre(30, 3.5));
  EXPECT_EQ(rows.measurement.set_aside[SetAsideReason::kHole], 1U);
  EXPECT_THAT(remark, HasSubstr("'s' and 'p' were averaged"));
}

// A depolariser sends half of each polarisation into each: of unpolarised light all arrives, whatever the filters.
TEST(AverageOverPolarisation, FiltersOnBothSidesAreSummedBehindTheSample) {
  for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
           {"ss", "sp", "ps", "pp"}, {"s-s", "s-p", "p-s", "p-p"}, {"h v", "v v", "h h", "v h"}}) {
    Rows rows;
    for (int k = 0; k < 4; ++k) rows.Add(0.1, {0.5});
    EXPECT_THAT(AverageOverPolarisation({0, 1, 2, 3}, names, &rows.measurement), HasSubstr("half of the sum"));
    EXPECT_THAT(rows.values(), testing::ElementsAre(1)) << names[0];
  }
}

TEST(AverageOverPolarisation, UnpolarisedRowsAreTakenAsTheyAre) {
  for (const char* word : {"unpolarised", "unpol", "u", "none", "mean"}) {
    EXPECT_TRUE(IsUnpolarised(word)) << word;
    Rows rows;
    rows.Add(0.1, {1});
    rows.Add(0.1, {7});
    rows.Add(0.1, {3});
    EXPECT_THAT(AverageOverPolarisation({0, 1, 2}, {"s", word, "p"}, &rows.measurement), HasSubstr(word));
    EXPECT_THAT(rows.values(), testing::ElementsAre(7));
    EXPECT_EQ(rows.measurement.set_aside[SetAsideReason::kOutsideSelection], 2U);
  }
  EXPECT_FALSE(IsUnpolarised("s") || IsUnpolarised("") || IsUnpolarised("te"));
}

TEST(AverageOverPolarisation, OneIsLeftAndThreeAreRefused) {
  Rows rows;
  rows.Add(0.1, {1});
  EXPECT_EQ(AverageOverPolarisation({0}, {"s"}, &rows.measurement), "");
  EXPECT_THAT(rows.values(), testing::ElementsAre(1));
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{"0", "45", "90"}, {"ss", "sp", "ps", "xx"}, {"ss", "sp", "ps", "ss "}}) {
    EXPECT_THAT([&] { AverageOverPolarisation({0}, names, &rows.measurement); },
                ThrowsMessage<InputError>(
                    testing::AllOf(HasSubstr("polarisations (" + names[0]), HasSubstr("choose one with --where"))));
  }
}

}  // namespace
}  // namespace lobefit

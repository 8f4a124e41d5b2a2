// What panels draw from: values at the samples, ratios, quantiles.
#include "lobefit/report/figures/report_data.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/report/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

// Linear between the order statistics: the definition, of a sorted copy.
double SortedQuantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const double at = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(at));
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

TEST(Quantile, IsTheOneOfTheSortedValues) {
  std::mt19937 engine(5);
  for (const std::size_t count : {1U, 2U, 3U, 10U, 257U}) {
    std::vector<double> values(count);
    // Few different numbers: ties.
    for (double& v : values) v = std::uniform_int_distribution<int>(-4, 4)(engine);
    for (const double q : {0.0, 0.05, 0.3, 0.5, 0.95, 1.0}) {
      std::vector<double> reordered = values;
      EXPECT_DOUBLE_EQ(Quantile(&reordered, q), SortedQuantile(values, q)) << count << " " << q;
    }
  }
  std::vector<double> none;
  EXPECT_TRUE(std::isnan(Quantile(&none, 0.5)));
  std::vector<double> infinite = {1, -HUGE_VAL, -HUGE_VAL};
  EXPECT_EQ(Quantile(&infinite, 0.25), -HUGE_VAL);
  EXPECT_EQ(Quantile(&infinite, 0.75), -HUGE_VAL) << "not nan";
}

TEST(ReportData, FittedValuesAreThoseOfTheModelAtEverySample) {
  // More samples than one piece of the work, on several threads.
  const Material material = test::MakeMaterial(3, false);
  test::Pairs pairs;
  for (int k = 0; k < 24000; ++k)
    pairs.emplace_back(test::AtDegrees(k % 80, k % 7), test::AtDegrees(0.5 + k % 83, 0.01 * k));
  const Measurement measurement = test::Measure(material, pairs, 0.1, false);
  const ReportData data(material, measurement, 3);
  const Reflectance reflectance(material.model, material.Values(), 3);
  std::vector<double> f_r(3), read(3);
  ASSERT_GT(measurement.samples.size(), 20000U);
  for (std::size_t i = 0; i < measurement.samples.size(); i += 487) {
    const Vec3 wi = measurement.samples.wi(i), wo = measurement.samples.wo(i);
    reflectance.Evaluate(wi, wo, f_r.data());
    data.Read(wi, wo, read.data());
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(data.fitted_values[c][i], f_r[c], 1e-5 * f_r[c]);
      EXPECT_NEAR(read[c], f_r[c], 1e-9 * f_r[c]);
      EXPECT_NEAR(data.LogRatio(c, i), std::log(measurement.samples.values[c][i] / f_r[c]), 2e-5);
    }
  }
}

TEST(ReportData, RatiosOfWhatHasNoLogarithm) {
  const Material material = test::MakeMaterial(1, true);
  Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0, true);
  measurement.samples.values[0][0] = 0;
  measurement.samples.values[0][1] = -1;
  ReportData data(material, measurement, 1);
  EXPECT_EQ(data.LogRatio(0, 0), -HUGE_VAL);
  EXPECT_EQ(data.LogRatio(0, 1), -HUGE_VAL);
  data.fitted_values[0][2] = 0;
  EXPECT_TRUE(std::isnan(data.LogRatio(0, 2)));
}

// A grey surface shows as its grey whatever the channels are called; of R, G, B green is the brightest.
TEST(ReportData, DisplayedNumbers) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"R", "G", "B"}, {"X", "Y", "Z"}, {"a", "b", "c"}, {"B", "G", "R"}}) {
    Material material = test::MakeMaterial(3, true);
    Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0, true);
    material.channels = measurement.channels.names = names;
    const ReportData data(material, measurement, 1);
    EXPECT_NEAR(data.Display(std::vector<double>{0.3, 0.3, 0.3}), 0.3, 1e-12) << names[0];
    EXPECT_EQ(data.Display({{1, 0}, {2, 0}, {4, 0}}, 0), data.Display(std::vector<double>{1, 2, 4}));
    const double second = data.Display(std::vector<double>{0, 1, 0});
    EXPECT_NEAR(second, names[0] == "X" ? 1 : names[0] == "R" ? 0.7152 : 1.0 / 3, 1e-12) << names[0];
  }
}

TEST(ReportData, ManyChannelsAreShownByThree) {
  const Material material = test::MakeMaterial(7, true);
  Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0, true);
  measurement.channels.wavelengths_nm = {380.04, 532.25, 632.8, 999.96, 10600, 3500, 405};
  const ReportData data(material, measurement, 1);
  EXPECT_THAT(data.shown_channels, testing::ElementsAre(0U, 3U, 6U));
  EXPECT_THAT(data.channel_names,
              testing::ElementsAre("380 nm", "532.3 nm", "632.8 nm", "1000 nm", "10.6 µm", "3500 nm", "405 nm"));
}

TEST(ReportData, WhatDoesNotFitIsRefusedByName) {
  const Material material = test::MakeMaterial(3, true);
  const Measurement grey = test::Measure(test::MakeMaterial(1, true), test::GoniometerPairs(false), 0, true);
  const auto message = [](const Material& m, const Measurement& measured) -> std::string {
    try {
      ReportData(m, measured, 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(material, grey),
              testing::AllOf(testing::StartsWith("synthetic.csv: "), testing::HasSubstr("channels Y"),
                             testing::HasSubstr("R, G, B"), testing::HasSubstr("give the measurement")));
  const test::Pairs pairs = {{test::AtDegrees(10, 0), test::AtDegrees(20, 0)}};
  EXPECT_THAT(message(material, test::Measure(material, pairs, 0, true)), testing::HasSubstr("only one sample"));
  EXPECT_THAT(message(material, test::Measure(material, {}, 0, true)), testing::HasSubstr("no sample"));
}

// The bands hold all samples, of few too: measured values that are a factor away everywhere have a band at it.
TEST(ResidualBand, OfAFactorIsTheFactor) {
  const Material material = test::MakeMaterial(1, true);
  test::Pairs few = test::GoniometerPairs(false);
  few.resize(9);
  for (const test::Pairs& pairs : {few, test::GoniometerPairs(false), test::GoniometerPairs(true)}) {
    Measurement measurement = test::Measure(material, pairs, 0, true);
    for (double& v : measurement.samples.values[0]) v *= 1.5;
    const ReportData data(material, measurement, 1);
    const ResidualBand band(data, 0);
    for (const double degrees : {0.0, 3.3, 20.0, 61.0, 90.0}) {
      const ResidualBand::Quantiles q = band.At(DegreesToRadians(degrees));
      EXPECT_NEAR(q.low, std::log(1.5), 1e-5) << pairs.size() << " samples, " << degrees;
      EXPECT_NEAR(q.middle, std::log(1.5), 1e-5);
      EXPECT_NEAR(q.high, std::log(1.5), 1e-5);
    }
  }
}

// What is off at large half angles alone shows there, however few samples stand there.
TEST(ResidualBand, TheLastSamplesCount) {
  const Material material = test::MakeMaterial(1, true);
  Measurement measurement = test::Measure(material, test::GoniometerPairs(true), 0, true);
  const Samples& samples = measurement.samples;
  std::vector<std::pair<double, std::size_t>> by_angle;
  for (std::size_t i = 0; i < samples.size(); ++i)
    by_angle.emplace_back(PolarAngle(HalfVector(samples.wi(i), samples.wo(i))), i);
  std::sort(by_angle.begin(), by_angle.end(), std::greater<>());
  for (std::size_t k = 0; k < 60; ++k) measurement.samples.values[0][by_angle[k].second] *= 3;
  const ReportData data(material, measurement, 1);
  EXPECT_GT(ResidualBand(data, 0).At(kPi / 2).high, 0.5);
  EXPECT_NEAR(ResidualBand(data, 0).At(0).high, 0, 1e-5);
}

}  // namespace
}  // namespace lobefit

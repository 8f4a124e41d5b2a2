#include "lobefit/synthesis/synthesis.h"

#include <cmath>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"
#include "lobefit/synthesis/instrument.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

DirectionList SmallGrid() {
  GoniometerLayout layout;
  layout.polar_angles = {0.2, 0.6, 1.0};
  layout.azimuths = {0, 1};
  return Goniometer(layout);
}

void One(const Vec3&, const Vec3&, double* values) { std::fill(values, values + 2, 1.0); }

Measurement Make(const std::string& noise, std::uint64_t seed = 1) {
  return Synthesise(SmallGrid(), {{"a", "b"}, {}}, One, ParseNoise(noise), seed);
}

double Deviation(const std::vector<double>& values, double mean) {
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(RandomNumbers, StreamsOfOneSeedDifferAndMomentsAreRight) {
  EXPECT_NE(StreamSeed(1, 0), StreamSeed(1, 1));
  EXPECT_NE(StreamSeed(1, 1), StreamSeed(2, 0));
  EXPECT_EQ(StreamSeed(7, 3), StreamSeed(7, 3));
  RandomNumbers random(5);
  double sum = 0, squares = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.Normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0, 0.015);
  EXPECT_NEAR(squares / kCount, 1, 0.02);
  // Below and above the mean where counting hands over to the normal distribution.
  for (const double mean : {0.0, 0.5, 7.0, 200.0}) {
    double count = 0, count2 = 0;
    for (int i = 0; i < kCount; ++i) {
      const double k = random.Poisson(mean);
      EXPECT_EQ(k, std::floor(k));
      count += k;
      count2 += k * k;
    }
    const double m = count / kCount;
    EXPECT_NEAR(m, mean, 5 * std::sqrt(mean / kCount));
    EXPECT_NEAR(count2 / kCount - m * m, mean, 0.03 * mean);
  }
}

TEST(Noise, WordsReadBack) {
  for (const std::string text : {"none", "multiplicative=0.05",
                                 "multiplicative=0.05,additive=0.001,drift=0.03,poisson=0.0001,outliers=0.01,"
                                 "rectified,quantisation=0.001,holes=0.1,aperture=1.5,source=0.5,plain-mean,"
                                 "misalignment-x=-0.5,misalignment-y=2"}) {
    EXPECT_EQ(ToText(ParseNoise(text)), text);
  }
  EXPECT_EQ(ParseNoise(""), Noise{});
}

TEST(Noise, UnknownTermsAndValuesAreRefusedWithWhatIsAllowed) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      ParseNoise(text);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(message("multiplicativ=1"), testing::HasSubstr("did you mean 'multiplicative'?"));
  EXPECT_THAT(message("white=1"), testing::HasSubstr("allowed: multiplicative, additive, drift"));
  EXPECT_THAT(message("drift"), testing::HasSubstr("drift=NUMBER"));
  EXPECT_THAT(message("drift=-1"), testing::HasSubstr("[0, 10]"));
  EXPECT_THAT(message("drift=nan"), testing::HasSubstr("[0, 10]"));
  EXPECT_THAT(message("holes=1"), testing::HasSubstr("[0, 0.99]"));
  EXPECT_THAT(message("rectified=1"), testing::HasSubstr("takes no value"));
  EXPECT_THAT(message("misalignment-x=99"), testing::HasSubstr("[-45, 45] degrees"));
}

TEST(Noise, EveryTermDoesWhatItSays) {
  const Measurement clean = Make("");
  const std::size_t n = clean.samples.size();
  ASSERT_GT(n, 500U);
  EXPECT_EQ(Deviation(clean.samples.values[0], 1), 0);
  EXPECT_NEAR(Deviation(Make("multiplicative=0.1").samples.values[0], 1), 0.1, 0.01);
  EXPECT_NEAR(Deviation(Make("additive=0.2").samples.values[1], 1), 0.2, 0.02);

  const Samples drift = Make("drift=0.1").samples;
  std::map<double, std::set<double>> by_incidence;
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(drift.values[0][i], drift.values[1][i]);
    by_incidence[drift.wi_x[i] + 10 * drift.wi_y[i]].insert(drift.values[0][i]);
  }
  EXPECT_EQ(by_incidence.size(), 6U);
  for (const auto& [wi, values] : by_incidence) EXPECT_EQ(values.size(), 1U);

  const Samples counted = Make("poisson=0.01").samples;
  double chi = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double counts = counted.values[0][i] * counted.wi_z[i] / 0.01;
    EXPECT_NEAR(counts, std::round(counts), 1e-9);
    chi += (counts - counted.wi_z[i] / 0.01) * (counts - counted.wi_z[i] / 0.01) / (counted.wi_z[i] / 0.01);
  }
  EXPECT_NEAR(chi / static_cast<double>(n), 1, 0.15);

  const Samples outliers = Make("outliers=0.2").samples;
  std::size_t hit = 0;
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_GE(outliers.values[0][i], 0.1);
    EXPECT_LE(outliers.values[0][i], 10);
    if (outliers.values[0][i] != 1) ++hit;
  }
  EXPECT_NEAR(static_cast<double>(hit) / static_cast<double>(n), 0.2, 0.06);

  bool negative = false;
  const Samples noisy = Make("additive=2").samples, rectified = Make("additive=2,rectified").samples,
                quantised = Make("additive=2,quantisation=0.25").samples;
  for (const double v : noisy.values[0]) negative = negative || v < 0;
  EXPECT_TRUE(negative);
  for (const double v : rectified.values[0]) EXPECT_GE(v, 0);
  for (const double v : quantised.values[0]) EXPECT_EQ(v * 4, std::round(v * 4));

  const Measurement holes = Make("holes=0.3");
  EXPECT_EQ(holes.samples.size() + holes.set_aside[SetAsideReason::kHole], n);
  EXPECT_NEAR(static_cast<double>(holes.set_aside[SetAsideReason::kHole]) / static_cast<double>(n), 0.3, 0.06);
}

TEST(Noise, OneTermDoesNotChangeAnother) {
  const Samples alone = Make("multiplicative=0.1").samples, both = Make("multiplicative=0.1,drift=0.1").samples,
                drift = Make("drift=0.1").samples;
  for (std::size_t i = 0; i < alone.size(); ++i)
    EXPECT_NEAR(both.values[0][i], alone.values[0][i] * drift.values[0][i], 1e-14);
}

TEST(Noise, SameSeedSameNumbersOtherSeedOthers) {
  EXPECT_EQ(Make("multiplicative=0.1,holes=0.1", 3).samples.values,
            Make("multiplicative=0.1,holes=0.1", 3).samples.values);
  EXPECT_NE(Make("multiplicative=0.1", 3).samples.values, Make("multiplicative=0.1", 4).samples.values);
}

constexpr Aperture Plain(double half_angle) { return {0, half_angle, ApertureMean::kPlain}; }

TEST(Aperture, AveragesOverTheDiscsSolidAngle) {
  // The mean of cos(theta_o) over a cap of half angle a about wo is cos(theta_o) (1 + cos a) / 2, of its square
  // ((1 + c + c^2) / 3) cos^2 + (2 - c - c^2) / 6 sin^2 with c = cos a: exact integrals over the sphere.
  const double a = 0.3, c = std::cos(a);
  const BrdfFunction one = [](const Vec3&, const Vec3& wo, double* v) { *v = wo.z; };
  const BrdfFunction first = WithAperture(one, Plain(a), 1), flux = WithAperture(one, {0, a}, 1);
  const BrdfFunction second =
      WithAperture([](const Vec3&, const Vec3& wo, double* v) { *v = wo.z * wo.z; }, Plain(a), 1);
  for (const double theta : {0.0, 0.4, 1.0}) {
    const Vec3 wo = FromSpherical(theta, 0.7);
    const double square = wo.z * wo.z * (1 + c + c * c) / 3 + (1 - wo.z * wo.z) * (2 - c - c * c) / 6;
    double value = 0;
    first({0, 0, 1}, wo, &value);
    EXPECT_NEAR(value, wo.z * (1 + c) / 2, 1e-12);
    second({0, 0, 1}, wo, &value);
    EXPECT_NEAR(value, square, 1e-12);
    // < cos^2 > / < cos >.
    flux({0, 0, 1}, wo, &value);
    EXPECT_NEAR(value, square / (wo.z * (1 + c) / 2), 1e-12);
  }
}

TEST(Aperture, LambertIsTheSameThroughAnyAperture) {
  const BrdfFunction lambert = [](const Vec3&, const Vec3&, double* v) { *v = 0.2; };
  for (const ApertureMean mean : {ApertureMean::kFlux, ApertureMean::kPlain}) {
    double value = 0;
    WithAperture(lambert, {0.02, 0.05, mean}, 1)(FromSpherical(1, 0), FromSpherical(0.8, 2), &value);
    EXPECT_NEAR(value, 0.2, 1e-13);
  }
}

TEST(Aperture, ResolvesLobesMuchNarrowerThanTheDisc) {
  // A spherical Gaussian about the detector's axis: its integral over the cap is known.
  const double width = 0.004, a = 0.05, sharpness = 1 / (width * width);
  const BrdfFunction seen = WithAperture(
      [&](const Vec3&, const Vec3& wo, double* v) {
        const double sine2 = wo.x * wo.x + wo.y * wo.y;
        *v = std::exp(-sharpness * sine2 / (1 + wo.z));
      },
      Plain(a), 1, width);
  double value = 0;
  seen({0, 0, 1}, {0, 0, 1}, &value);
  const double height = 1 - std::cos(a);
  EXPECT_NEAR(value, (1 - std::exp(-sharpness * height)) / (sharpness * height), 1e-4 * value);
}

// Both discs: the source swept by the outer mean of the detector's.
TEST(Aperture, BothDiscsAreOneAfterTheOther) {
  const auto lobe = [](const Vec3& wi, const Vec3& wo, double* v) {
    const Vec3 h = Normalized(wi + wo);
    *v = std::exp(-(h.x * h.x + h.y * h.y) / 0.02);
  };
  const BrdfFunction detector = WithAperture(lobe, Plain(0.04), 1, 0.1);
  // The source's disc about wi is the detector's of the function with its directions exchanged.
  const BrdfFunction exchanged = [&](const Vec3& wi, const Vec3& wo, double* v) { detector(wo, wi, v); };
  const BrdfFunction one_by_one = WithAperture(exchanged, Plain(0.02), 1, 0.1);
  const BrdfFunction both = WithAperture(lobe, {0.02, 0.04, ApertureMean::kPlain}, 1, 0.1);
  const Vec3 wi = FromSpherical(0.5, 0), wo = FromSpherical(0.6, 2.9);
  double a = 0, b = 0;
  one_by_one(wo, wi, &a);
  both(wi, wo, &b);
  EXPECT_NEAR(a, b, 1e-7 * a);
}

TEST(Misalignment, TurnsTheSampleAgainstTheInstrument) {
  // The sample's normal, turned by +2 degrees about y, leans to +x: what the instrument calls +z is for the sample a
  // direction that leans to -x.
  Vec3 seen_wi = {}, seen_wo = {};
  const double angle = DegreesToRadians(2);
  const BrdfFunction turned = WithMisalignment(
      [&](const Vec3& wi, const Vec3& wo, double* v) {
        seen_wi = wi;
        seen_wo = wo;
        *v = 1;
      },
      0, angle, 1);
  double value = 0;
  const Vec3 wi = FromSpherical(0.5, 1), wo = FromSpherical(0.3, 2);
  turned({0, 0, 1}, wo, &value);
  EXPECT_NEAR(seen_wi.x, -std::sin(angle), 1e-15);
  turned(wi, wo, &value);
  EXPECT_NEAR(Dot(seen_wi, seen_wo), Dot(wi, wo), 1e-15);
  // Below the sample's horizon there is no light.
  turned(FromSpherical(DegreesToRadians(89), kPi), wo, &value);
  EXPECT_EQ(value, 0);
}

}  // namespace
}  // namespace lobefit

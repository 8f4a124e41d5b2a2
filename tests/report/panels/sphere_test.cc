// Spheres under one light and under the sky, against what they must be for any material.
#include "lobefit/report/panels/sphere.h"

#include <cmath>
#include <limits>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// A white diffuse surface of two or more channels, each with its factor; unknown where the viewer's azimuth is in the
// given range.
ShownBrdf Diffuse(const std::vector<double>& factors, double unknown_up_to = -10) {
  return [=](const DirectionArrays& d, std::vector<std::vector<double>>* f_r, std::vector<std::uint8_t>* known) {
    f_r->assign(factors.size(), std::vector<double>(d.count));
    known->assign(d.count, 1);
    for (std::size_t i = 0; i < d.count; ++i) {
      for (std::size_t c = 0; c < factors.size(); ++c) (*f_r)[c][i] = factors[c] / kPi;
      if (std::atan2(d.wi_y[i], d.wi_x[i]) < unknown_up_to) {
        (*known)[i] = 0;
        for (std::size_t c = 0; c < factors.size(); ++c) (*f_r)[c][i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  };
}

const Channels& Rgb3() {
  static const Channels channels = {{"R", "G", "B"}, {}};
  return channels;
}

SlopeCoordinates RoundLobe(double alpha) { return {{0, 0, std::log(alpha), 0, std::log(alpha)}}; }

double Mean(const LitSphere& sphere, std::size_t channel) {
  double sum = 0;
  for (const std::array<double, 3>& color : sphere.color) sum += color[channel];
  return sum / static_cast<double>(sphere.color.size());
}

TEST(LightSphere, OfAWhiteDiffuseSurfaceIsTheCosine) {
  constexpr int kSide = 50;
  const LitSphere sphere = LightSphere(Diffuse({1, 0.5, 0}), ChannelColor(Rgb3()), 3, LitRows(kSide));
  const Vec3 light = SphereLight();
  int lit = 0;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const double x = (column + 0.5) / kSide * 2 - 1, y = 1 - (row + 0.5) / kSide * 2;
      const std::array<double, 3>& color = sphere.color[PixelIndex(column, row, kSide)];
      if (std::hypot(x, y) > 1 - 1.0 / kSide) continue;
      const double cosine = std::max(0.0, Dot({x, y, std::sqrt(1 - x * x - y * y)}, light));
      ASSERT_NEAR(color[0], cosine, 1e-12) << column << ' ' << row;
      ASSERT_NEAR(color[1], 0.5 * cosine, 1e-12);
      ASSERT_EQ(color[2], 0);
      lit += cosine > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, kSide * kSide / 2);
}

TEST(SkySphere, IsLinearInEachChannelAlone) {
  const ChannelColor color(Rgb3());
  const LitSphere white = SkySphere(Diffuse({1, 1, 1}), RoundLobe(0.3), color, 3, 75, 1),
                  dyed = SkySphere(Diffuse({0.5, 1, 0}), RoundLobe(0.3), color, 3, 75, 2);
  for (std::size_t i = 0; i < white.color.size(); ++i) {
    ASSERT_NEAR(dyed.color[i][0], 0.5 * white.color[i][0], 1e-13);
    ASSERT_EQ(dyed.color[i][1], white.color[i][1]);
    ASSERT_EQ(dyed.color[i][2], 0);
  }
  EXPECT_GT(Mean(white, 0), 0.1);
}

// What is drawn from the lobe, by the cosine and about the sun is weighed by all three densities: whatever the lobe,
// the light is the same. An error in one density or its Jacobian would not cancel.
TEST(SkySphere, DoesNotDependOnTheLobeThatIsSampled) {
  const ChannelColor color(Rgb3());
  const LitSphere narrow = SkySphere(Diffuse({1, 1, 1}), RoundLobe(0.15), color, 3, 600, 2),
                  broad = SkySphere(Diffuse({1, 1, 1}), RoundLobe(0.7), color, 3, 600, 2),
                  leaning = SkySphere(Diffuse({1, 1, 1}), {{0.3, -0.2, -1.5, 0.1, -0.9}}, color, 3, 600, 2);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(Mean(broad, c) / Mean(narrow, c), 1, 0.01) << c;
    EXPECT_NEAR(Mean(leaning, c) / Mean(narrow, c), 1, 0.01) << c;
  }
}

// A mirror-like lobe shows the sky: blue above, dark below, where the sun stands brightest of all.
TEST(SkySphere, OfAGlossyMetalShowsTheSky) {
  const Material material = test::MakeMaterial(3, true);
  const FittedFunction fitted(material);
  const LitSphere sphere = SkySphere(Shown(fitted), fitted.lobe_shapes()[0], ChannelColor(Rgb3()), 3, 240, 2);
  const auto luminance = [&](double x, double y) {
    const auto at = [&](double v) { return static_cast<int>((v + 1) / 2 * sphere.size); };
    const std::array<double, 3>& c = sphere.color[PixelIndex(at(x), at(-y), sphere.size)];
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  EXPECT_GT(luminance(0, 0.4), 2 * luminance(0, -0.7));
  // The mirror direction of the viewer at the point half-way to the light.
  const Vec3 half = HalfVector(SphereLight(), {0, 0, 1});
  EXPECT_GT(luminance(half.x, half.y), 2 * luminance(-half.x, half.y));
}

TEST(SkySphere, OfOneChannelIsGrey) {
  const LitSphere sphere = SkySphere(Diffuse({1}), RoundLobe(0.3), ChannelColor({{"Y"}, {}}), 1, 75, 1);
  for (const std::array<double, 3>& c : sphere.color) {
    ASSERT_NEAR(c[0], c[1], 1e-12 + 1e-12 * c[1]);
    ASSERT_NEAR(c[2], c[1], 1e-12 + 1e-12 * c[1]);
  }
}

// A pixel is known where three quarters of its directions are; what is not known, here NaN, is not added.
TEST(SkySphere, LeavesOutWhatIsNotKnown) {
  const ChannelColor color(Rgb3());
  const LitSphere some = SkySphere(Diffuse({1, 1, 1}, -kPi + 0.7), RoundLobe(0.5), color, 3, 240, 1),
                  half = SkySphere(Diffuse({1, 1, 1}, 0), RoundLobe(0.5), color, 3, 240, 1);
  for (const std::array<double, 3>& c : some.color) ASSERT_TRUE(std::isfinite(c[0]));
  const auto known = [](const LitSphere& s) { return std::count(s.known.begin(), s.known.end(), 1); };
  EXPECT_GT(known(some), known(half));
  EXPECT_LT(known(half), static_cast<std::ptrdiff_t>(half.known.size() * 6 / 10));
}

TEST(SphereExposure, BringsHighlightsToTheShoulderWhateverTheScale) {
  const LitSphere sphere = LightSphere(Diffuse({1, 0.5, 0}), ChannelColor(Rgb3()), 3, LitRows(40));
  LitSphere brighter = sphere;
  for (std::array<double, 3>& c : brighter.color) {
    for (double& v : c) v *= 50;
  }
  EXPECT_NEAR(50 * SphereExposure(brighter) / SphereExposure(sphere), 1, 1e-12);
  EXPECT_EQ(SphereExposure(DarkSphere(10)), 1);
}

TEST(IsCovered, TakesThreeInAHundredHoles) {
  LitSphere sphere = DarkSphere(10);
  EXPECT_TRUE(IsCovered(sphere));
  sphere.known[0] = sphere.known[1] = sphere.known[2] = 0;
  EXPECT_TRUE(IsCovered(sphere));
  sphere.known[3] = 0;
  EXPECT_FALSE(IsCovered(sphere));
}

}  // namespace
}  // namespace lobefit

// Spheres of a spectrum, whose channels are turned to colours before the spheres are lit.
#include "lobefit/report/panels/sphere.h"

#include <cmath>

#include "tests/report/synthetic.h"
#include <gtest/gtest.h>

namespace lobefit {
namespace {

constexpr std::size_t kWavelengths = 31;
constexpr int kSkySamples = 9, kThreads = 2;

void ExpectSameColors(const LitSphere& a, const LitSphere& b) {
  ASSERT_EQ(a.color.size(), b.color.size());
  double brightest = 0, largest = 0;
  for (std::size_t i = 0; i < a.color.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      brightest = std::max(brightest, a.color[i][k]);
      largest = std::max(largest, std::fabs(a.color[i][k] - b.color[i][k]));
    }
  }
  EXPECT_GT(brightest, 0.01);
  EXPECT_LT(largest, 1e-12 * brightest);
  EXPECT_EQ(a.known, b.known);
}

TEST(SpectralSpheres, OfASpectrumAreThoseOfItsColors) {
  for (const Fresnel fresnel : {Fresnel::kSchlick, Fresnel::kNone}) {
    Material material = test::MakeMaterial(kWavelengths, false);
    material.model.lobes[0].fresnel = fresnel;
    const ChannelColor to_color(test::MakeChannels(kWavelengths));
    const ColoredFit colored = InColors(material, to_color);
    EXPECT_EQ(colored.function.channels(), 3U);
    const FittedFunction all(material);
    const SlopeCoordinates& lobe = all.lobe_shapes()[0];
    ExpectSameColors(SkySphere(Shown(all), lobe, to_color, kWavelengths, kSkySamples, kThreads),
                     SkySphere(Shown(colored.function), lobe, colored.to_color, 3, kSkySamples, kThreads));
    ExpectSameColors(LightSphere(Shown(all), to_color, kWavelengths, LitRows(32)),
                     LightSphere(Shown(colored.function), colored.to_color, 3, LitRows(32)));
  }
}

TEST(SpectralSpheres, OfOpticalConstantsAskEachChannel) {
  Material material = test::MakeMaterial(kWavelengths, true);
  material.model.lobes[0].fresnel = Fresnel::kDielectric;
  for (double& ior : material.parameters[5].values) ior += 1;
  EXPECT_EQ(InColors(material, ChannelColor(test::MakeChannels(kWavelengths))).function.channels(), kWavelengths);
}

}  // namespace
}  // namespace lobefit

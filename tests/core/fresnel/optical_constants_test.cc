#include "lobefit/core/fresnel/optical_constants.h"

#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

TEST(OpticalConstants, PublishedPointsAndInterpolation) {
  // Johnson and Christy (1972), gold at 548.6 and 582.1 nm: 0.43 + 2.455 i and 0.29 + 2.863 i.
  const MetalIndex at = MetalIndexAt("Au", 548.6), next = MetalIndexAt("gold", 582.1);
  EXPECT_EQ(at.index.eta, 0.43);
  EXPECT_EQ(at.index.k, 2.455);
  EXPECT_EQ(next.index.eta, 0.29);
  EXPECT_EQ(next.index.k, 2.863);
  EXPECT_NE(at.source.find("Johnson"), std::string::npos);
  const MetalIndex middle = MetalIndexAt(" GOLD ", 0.5 * (548.6 + 582.1));
  EXPECT_NEAR(middle.index.eta, 0.36, 1e-12);
  EXPECT_NEAR(middle.index.k, 2.659, 1e-12);
}

TEST(OpticalConstants, EveryMetalCoversTheVisibleAndItsWholeRange) {
  const std::vector<MetalInfo> metals = Metals();
  EXPECT_EQ(metals.size(), 10U);
  for (const MetalInfo& metal : metals) {
    EXPECT_LE(metal.low_nm, 380) << metal.symbol;
    EXPECT_GE(metal.high_nm, 1900) << metal.symbol;
    double previous_wavelength = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double wavelength = metal.low_nm + (metal.high_nm - metal.low_nm) * (i / 1000.0);
      EXPECT_GT(wavelength, previous_wavelength);
      previous_wavelength = wavelength;
      const MetalIndex found = MetalIndexAt(metal.symbol, std::min(wavelength, metal.high_nm));
      EXPECT_GT(found.index.eta, 0) << metal.symbol << " " << wavelength;
      EXPECT_GT(found.index.k, 0.5) << metal.symbol << " " << wavelength;
      // Metals reflect: more than a fifth at normal incidence anywhere in these tables, nearly all in the infrared.
      const double f0 = FresnelConductor(1, found.index);
      EXPECT_GT(f0, wavelength > 5000 ? 0.9 : 0.2) << metal.symbol << " " << wavelength;
      EXPECT_LT(f0, 1);
    }
  }
}

TEST(OpticalConstants, RefusesUnknownNamesAndWavelengths) {
  try {
    MetalIndexAt("unobtainium", 500);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("brass"), std::string::npos);
  }
  EXPECT_THROW(MetalIndexAt("Ag", 100), InputError);
  EXPECT_THROW(MetalIndexAt("Ag", 0.55), InputError);
  EXPECT_THROW(MetalIndexAt("Ag", 5000), InputError);
  EXPECT_THROW(MetalIndexAt("Ag", std::nan("")), InputError);
  EXPECT_THROW(MetalIndexAt("", 500), InputError);
}

}  // namespace
}  // namespace lobefit

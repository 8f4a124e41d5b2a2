// Fits of wavelengths: as spectra for pbrt and Mitsuba, as R, G, B for the other texts.
#include <filesystem>

#include "tests/export/materials.h"
#include "tests/support/shapes.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/export.h"
#include "lobefit/export/import.h"
#include "lobefit/export/targets.h"
#include "lobefit/renderer/rgb_fit.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

Material SpectralMaterial() {
  SyntheticCase synthetic = OneLobe(Ndf::kGgx, 0.25, 0.25, 0, 0, 0, {0.5, 0.4, 0.3, 0.35}, {0.1, 0.08, 0.05, 0.06});
  synthetic.channels = {"450nm", "500nm", "550nm", "650nm"};
  Material material = test::MaterialOf(synthetic);
  material.wavelengths_nm = {450, 500, 550, 650};
  return material;
}

class SpectralExport : public testing::Test {
 protected:
  void SetUp() override { folder_ = std::filesystem::path(testing::TempDir()) / "spectral_export"; }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  ExportResult Export(const Material& material, const char* target) const {
    ExportOptions options;
    options.targets = {&FindTarget(target)};
    options.folder = folder_;
    options.name = "sample";
    options.numbers = Numbers::kCopied;
    return ExportMaterial(material, options).results.at(0);
  }

  std::filesystem::path folder_;
};

TEST_F(SpectralExport, PbrtAndMitsubaHoldSpectra) {
  for (const char* target : {"pbrt", "mitsuba"}) {
    const ExportResult result = Export(SpectralMaterial(), target);
    const ImportedMaterial back = ImportMaterial(result.files[0]);
    EXPECT_EQ(back.channels.wavelengths_nm, (std::vector<double>{450, 500, 550, 650})) << target;
    EXPECT_EQ(back.channels.names[3], "650nm");
    // The fit's values but for masking and the conductor's Fresnel term.
    EXPECT_LT(result.error.lobe.median, 0.05) << target;
    EXPECT_LT(result.error.off.median, 0.05) << target;
  }
  const FileBytes pbrt(folder_ / "sample.pbrt");
  EXPECT_THAT(std::string(pbrt.bytes()), HasSubstr("\"spectrum eta\" [360 "));
  EXPECT_THAT(std::string(pbrt.bytes()), HasSubstr("  830 "));
  const FileBytes mitsuba(folder_ / "sample.mitsuba.xml");
  EXPECT_THAT(std::string(mitsuba.bytes()), HasSubstr("<spectrum name=\"eta\" value=\"360:"));
}

TEST_F(SpectralExport, OtherTextsGetTheFitsOwnRgb) {
  const Material material = SpectralMaterial();
  const FittedBrdf fit(material);
  const ChannelMap map = RgbMapOf(fit);
  // Schlick's term and the diffuse part are linear, so that the R, G, B of the parameters are those of f_r.
  const FittedBrdf rgb(RgbFit(fit, RgbMapOf(fit)));
  const BrdfFunction wanted = Apply(map, fit.function(), 4);
  ShapeGenerator directions(5);
  for (int k = 0; k < 50; ++k) {
    const Vec3 wi = directions.Upper(), wo = directions.Upper();
    double a[3] = {}, b[3] = {};
    wanted(wi, wo, a);
    rgb.function()(wi, wo, b);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(b[c], a[c], 1e-12 * (1 + a[c]));
  }
  const ExportResult result = Export(material, "materialx");
  EXPECT_EQ(result.carries.back().how, Carries::kApproximately);
  EXPECT_THAT(result.carries.back().note, HasSubstr("R G B from 4 wavelengths"));
  EXPECT_LT(result.error.off.median, 0.1);
  // Three wavelengths that end inside of the visible.
  SyntheticCase few = OneLobe(Ndf::kGgx, 0.25, 0.25, 0, 0, 0, {0.5, 0.5, 0.5}, {0.1, 0.1, 0.1});
  few.channels = {"450nm", "550nm", "650nm"};
  Material three = test::MaterialOf(few);
  three.channels = few.channels;
  three.wavelengths_nm = {450, 550, 650};
  EXPECT_THAT(Export(three, "gltf").carries.back().note, HasSubstr("constant beyond 450nm and 650nm"));
  // Grey wavelengths are grey.
  const Material grey = RgbFit(FittedBrdf(three), RgbMapOf(FittedBrdf(three)));
  for (const double f0 : grey.parameters[5].values) EXPECT_NEAR(f0, 0.5, 1e-9);
  // One wavelength is grey; wavelengths that do not cover the visible are refused by what holds R, G, B alone.
  SyntheticCase laser = OneLobe(Ndf::kGgx, 0.25, 0.25, 0, 0, 0, {0.5}, {0.1});
  laser.channels = {"633nm"};
  Material one = test::MaterialOf(laser);
  one.wavelengths_nm = {633};
  EXPECT_LT(Export(one, "gltf").error.uniform.median, 0.2);
  Material infrared = SpectralMaterial();
  infrared.channels = {"850nm", "900nm", "950nm", "1000nm"};
  infrared.wavelengths_nm = {850, 900, 950, 1000};
  EXPECT_THROW(Export(infrared, "gltf"), std::exception);
  EXPECT_EQ(Export(infrared, "pbrt").files.size(), 1U);
}

}  // namespace
}  // namespace lobefit

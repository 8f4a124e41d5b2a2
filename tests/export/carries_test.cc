// The table of targets: what is refused, what is said to be lost, and the better of two sets of numbers.
#include <filesystem>

#include "tests/export/materials.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/export/export.h"
#include "lobefit/export/refit.h"
#include "lobefit/export/targets.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

std::string Fate(const char* target, const SyntheticCase& synthetic, const std::string& feature) {
  const FittedBrdf fit(test::MaterialOf(synthetic));
  for (const Carried& row : FindTarget(target).carries(fit)) {
    if (row.feature == feature) {
      return row.how == Carries::kExactly ? "exactly" : row.how == Carries::kNot ? "not" : "approximately";
    }
  }
  return "absent";
}

TEST(Targets, SayWhatTheyCarry) {
  EXPECT_EQ(Fate("glsl", test::Tilted(), "tilt"), "exactly");
  EXPECT_EQ(Fate("gltf", test::Tilted(), "tilt"), "approximately");
  EXPECT_EQ(Fate("gltf", test::Turned(), "rotation"), "exactly");
  EXPECT_EQ(Fate("pbrt", test::Turned(), "rotation"), "approximately");
  EXPECT_EQ(Fate("materialx", test::Turned(), "rotation"), "exactly");
  EXPECT_EQ(Fate("gltf", test::Plastic(), "rotation"), "absent");
  EXPECT_EQ(Fate("gltf", test::TwoLobes(), "second lobe"), "not");
  EXPECT_EQ(Fate("materialx", test::TwoLobes(), "second lobe"), "exactly");
  // The fits' masking is separable: Mitsuba's, and not pbrt's.
  EXPECT_EQ(Fate("mitsuba", test::Turned(), "masking"), "exactly");
  EXPECT_EQ(Fate("pbrt", test::Turned(), "masking"), "approximately");
  EXPECT_EQ(Fate("merl", test::Plastic(), "shape"), "approximately");
}

TEST(Targets, OtherDistributionsAndFresnelTermsAreNotSilent) {
  SyntheticCase beckmann = test::Turned();
  beckmann.model.lobes[0].ndf = Ndf::kBeckmannAnisotropic;
  EXPECT_EQ(Fate("gltf", beckmann, "shape"), "approximately");
  EXPECT_EQ(FindTarget("glsl").refusal(FittedBrdf(test::MaterialOf(beckmann))), "");
  SyntheticCase sphere = test::Plastic();
  sphere.model.lobes[0].ndf = Ndf::kKagiwadaKalaba;
  EXPECT_THAT(FindTarget("glsl").refusal(FittedBrdf(test::MaterialOf(sphere))), HasSubstr("kagiwada-kalaba"));
  EXPECT_EQ(FindTarget("rgl").refusal(FittedBrdf(test::MaterialOf(beckmann))), "");
  SyntheticCase scale = test::Turned();
  scale.model.lobes[0].fresnel = Fresnel::kNone;
  EXPECT_EQ(Fate("materialx", scale, "Fresnel"), "exactly");
  EXPECT_EQ(Fate("gltf", scale, "Fresnel"), "approximately");
}

std::string Refusal(const SyntheticCase& synthetic, const char* target) {
  ExportOptions options;
  options.targets = {&FindTarget(target)};
  options.folder = std::filesystem::path(testing::TempDir()) / "refused";
  options.name = "sample";
  options.material_file = "sample.material.json";
  try {
    ExportMaterial(test::MaterialOf(synthetic), options);
  } catch (const InputError& error) {
    EXPECT_FALSE(std::filesystem::exists(options.folder)) << "nothing is written";
    return error.what();
  }
  return "";
}

TEST(Targets, RefuseWhatTheyCannotHold) {
  EXPECT_THAT(Refusal(test::Tilted(), "merl"), HasSubstr("sample.material.json: merl cannot hold this material"));
  EXPECT_THAT(Refusal(test::Tilted(), "merl"), HasSubstr("tilted; targets that can: json, glsl"));
  EXPECT_THAT(Refusal(test::Turned(), "merl"), HasSubstr("anisotropic"));
  SyntheticCase spectrum = OneLobe(Ndf::kGgx, 0.2, 0.2, 0, 0, 0, {0.5, 0.5, 0.5, 0.5}, {0, 0, 0, 0});
  spectrum.channels = {"450nm", "500nm", "550nm", "600nm"};
  EXPECT_THAT(Refusal(spectrum, "gltf"), HasSubstr("the fit has 4 channels (450nm, ...); fit with --channels rgb"));
}

TEST(Targets, UnknownNameGetsASuggestion) {
  try {
    FindTarget("mitsubda");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did you mean 'mitsuba'?"));
    EXPECT_THAT(error.what(), HasSubstr("gltf"));
  }
}

// A rough lobe, where separable and height-correlated masking differ: pbrt's own model fitted is nearer than the
// numbers copied, and says so.
TEST(Refit, IsNearerWhereTheMaskingDiffers) {
  SyntheticCase rough = OneLobe(Ndf::kGgx, 0.6, 0.6, 0, 0, 0, {0.8, 0.8, 0.8}, {0, 0, 0});
  rough.model.diffuse = Diffuse::kNone;
  rough.values.pop_back();
  const FittedBrdf fit(test::MaterialOf(rough));
  const ErrorMeter meter(fit);
  const Target& target = FindTarget("gltf");
  const std::optional<FittedBrdf> refitted = Refit(fit, target.own_model(fit), meter, 2);
  ASSERT_TRUE(refitted.has_value());
  const ExportError copied = meter.Compare(target.evaluate(fit)), fitted = meter.Compare(target.evaluate(*refitted));
  EXPECT_TRUE(IsBetter(fitted, copied)) << fitted.median << " " << copied.median;
  // Nothing to refit where the model is the target's own.
  EXPECT_FALSE(Refit(fit, fit.material().model, meter, 2).has_value());
}

// The fit against itself, and against itself with a tenth more.
TEST(ErrorMeter, SaysWhatIsThere) {
  const FittedBrdf fit(test::MaterialOf(test::Tilted()));
  const ErrorMeter meter(fit);
  const ExportError same = meter.Compare(fit.function());
  EXPECT_LT(same.maximum, 1e-12);
  EXPECT_EQ(same.albedo, 0);
  const ExportError more = meter.Compare([f = fit.function()](const Vec3& wi, const Vec3& wo, double* values) {
    f(wi, wo, values);
    for (int c = 0; c < 3; ++c) values[c] *= 1.1;
  });
  EXPECT_NEAR(more.median, 0.1, 1e-9);
  EXPECT_NEAR(more.albedo, 0.1, 1e-9);
}

}  // namespace
}  // namespace lobefit

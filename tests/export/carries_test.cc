// The table of targets: what is refused, what is said to be lost, and the better of two sets of numbers.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/export/materials.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/export/export.h"
#include "lobefit/export/refit.h"
#include "lobefit/export/targets.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

std::string Fate(const char* target, const SyntheticCase& synthetic, Feature feature) {
  const FittedBrdf fit(test::MaterialOf(synthetic));
  for (const Carried& row : FindTarget(target).carries(fit)) {
    if (row.feature == feature) {
      return row.how == Carries::kExactly ? "exactly" : row.how == Carries::kNot ? "not" : "approximately";
    }
  }
  return "absent";
}

TEST(Targets, SayWhatTheyCarry) {
  EXPECT_EQ(Fate("glsl", test::Tilted(), Feature::kTilt), "exactly");
  EXPECT_EQ(Fate("gltf", test::Tilted(), Feature::kTilt), "approximately");
  EXPECT_EQ(Fate("gltf", test::Turned(), Feature::kRotation), "exactly");
  EXPECT_EQ(Fate("pbrt", test::Turned(), Feature::kRotation), "approximately");
  EXPECT_EQ(Fate("materialx", test::Turned(), Feature::kRotation), "exactly");
  EXPECT_EQ(Fate("gltf", test::Plastic(), Feature::kRotation), "absent");
  EXPECT_EQ(Fate("gltf", test::TwoLobes(), Feature::kSecondLobe), "not");
  EXPECT_EQ(Fate("materialx", test::TwoLobes(), Feature::kSecondLobe), "exactly");
  // The fits' masking is separable: Mitsuba's, and not pbrt's.
  EXPECT_EQ(Fate("mitsuba", test::Turned(), Feature::kMasking), "exactly");
  EXPECT_EQ(Fate("pbrt", test::Turned(), Feature::kMasking), "approximately");
  EXPECT_EQ(Fate("merl", test::Plastic(), Feature::kShape), "approximately");
}

// What the stated error leaves out: it is that of the compensation by the albedo itself.
TEST(Targets, SayWhatMaterialXOwnShadersFit) {
  const FittedBrdf fit(test::MaterialOf(test::Plastic()));
  for (const char* name : {"materialx", "openpbr"}) {
    std::string note;
    for (const Carried& row : FindTarget(name).carries(fit)) {
      if (row.feature == Feature::kMasking) note = row.note;
    }
    EXPECT_THAT(note, HasSubstr("MaterialX' own shaders take from a fit of the albedo")) << name;
  }
}

TEST(Targets, OtherDistributionsAndFresnelTermsAreNotSilent) {
  SyntheticCase beckmann = test::Turned();
  beckmann.model.lobes[0].ndf = Ndf::kBeckmannAnisotropic;
  EXPECT_EQ(Fate("gltf", beckmann, Feature::kShape), "approximately");
  EXPECT_EQ(FindTarget("glsl").refusal(FittedBrdf(test::MaterialOf(beckmann))), "");
  SyntheticCase sphere = test::Plastic();
  sphere.model.lobes[0].ndf = Ndf::kKagiwadaKalaba;
  EXPECT_THAT(FindTarget("glsl").refusal(FittedBrdf(test::MaterialOf(sphere))), HasSubstr("kagiwada-kalaba"));
  EXPECT_EQ(FindTarget("rgl").refusal(FittedBrdf(test::MaterialOf(beckmann))), "");
  SyntheticCase scale = test::Turned();
  scale.model.lobes[0].fresnel = Fresnel::kNone;
  EXPECT_EQ(Fate("materialx", scale, Feature::kFresnel), "exactly");
  EXPECT_EQ(Fate("gltf", scale, Feature::kFresnel), "approximately");
}

// A lobe about the back direction is left out and named, never written as one about the mirror direction.
TEST(Targets, LeaveOutRetroLobes) {
  SyntheticCase retro = test::TwoLobes(), without = test::Turned();
  retro.model.lobes[1].direction = LobeDirection::kRetro;
  const FittedBrdf fit(test::MaterialOf(retro));
  without = retro;
  without.model.lobes.pop_back();
  without.values.erase(without.values.begin() + 6, without.values.begin() + 12);
  const FittedBrdf rest(test::MaterialOf(without));
  for (const char* name : {"pbrt", "mitsuba", "materialx", "openpbr", "gltf"}) {
    const Target& target = FindTarget(name);
    EXPECT_EQ(Fate(name, retro, Feature::kSecondLobe), "not") << name;
    EXPECT_EQ(target.refusal(fit), "") << name;
    double a[3], b[3];
    const Vec3 wi = FromSpherical(0.7, 0.3), wo = FromSpherical(0.6, 0.4);
    target.evaluate(fit)(wi, wo, a);
    target.evaluate(rest)(wi, wo, b);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c] / b[c], 1, 1e-12) << name;
    SyntheticCase only = without;
    only.model.lobes[0].direction = LobeDirection::kRetro;
    EXPECT_THAT(target.refusal(FittedBrdf(test::MaterialOf(only))), HasSubstr("back direction")) << name;
  }
  EXPECT_EQ(Fate("glsl", retro, Feature::kSecondLobe), "exactly");
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

// GGX of the same widths would be off by factors of hundreds.
TEST(Targets, OnlyTablesAndProgramsTakeTheScatterOfAMirror) {
  SyntheticCase mirror = test::Tilted();
  mirror.model = {{{Ndf::kAbg, Masking::kNone, Fresnel::kNone}}, Diffuse::kLambert};
  mirror.values = {{0.003}, {0.003}, {0}, {0}, {0}, {1.8}, {0.001, 0.001, 0.001}, {0, 0, 0}};
  const FittedBrdf fit(test::MaterialOf(mirror));
  for (const char* name : {"pbrt", "mitsuba", "materialx", "openpbr", "gltf"})
    EXPECT_THAT(FindTarget(name).refusal(fit), HasSubstr("'abg'")) << name;
  for (const char* name : {"rgl", "bsdf-xml", "glsl", "csv", "json", "merl"}) {
    const Target& target = FindTarget(name);
    EXPECT_TRUE(target.refusal == nullptr || target.refusal(fit).empty()) << name;
  }
}

TEST(Targets, RefuseWhatTheyCannotHold) {
  EXPECT_THAT(Refusal(test::Tilted(), "merl"), HasSubstr("sample.material.json: merl cannot hold this material"));
  EXPECT_THAT(Refusal(test::Tilted(), "merl"), HasSubstr("tilted; targets that can: rgl, gltf"));
  EXPECT_THAT(Refusal(test::Turned(), "merl"), HasSubstr("anisotropic"));
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
  EXPECT_TRUE(IsBetter(fitted, copied)) << fitted.off.median << " " << copied.off.median;
  // Nothing to refit where the model is the target's own.
  EXPECT_FALSE(Refit(fit, fit.material().model, meter, 2).has_value());
}

// The fit against itself, and against itself with a tenth more.
// The rows are of the file that was written: a coat that only the copied numbers have is not in the refitted ones.
TEST(Refit, SaysThatItsFileHasNoCoat) {
  SyntheticCase coated;
  coated.model.lobes = {{Ndf::kGgx}, {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered}};
  coated.values = {{0.4},     {0.4},          {0}, {0}, {0}, {0.05, 0.05, 0.05},
                   {0.1},     {0.1},          {0}, {0}, {0}, {1.5, 1.5, 1.5},
                   {0, 0, 0}, {0.3, 0.2, 0.1}};
  ExportOptions options;
  options.folder = std::filesystem::path(testing::TempDir()) / "refit_without_coat";
  options.name = "sample";
  for (const Numbers numbers : {Numbers::kCopied, Numbers::kRefitted}) {
    options.targets = {&FindTarget("openpbr"), &FindTarget("gltf")};
    options.numbers = numbers;
    for (const ExportResult& result : ExportMaterial(test::MaterialOf(coated), options).results) {
      for (const Carried& row : result.carries) {
        if (row.feature != Feature::kCoat && row.feature != Feature::kSecondLobe) continue;
        EXPECT_EQ(row.how, numbers == Numbers::kCopied ? Carries::kApproximately : Carries::kNot)
            << result.target->name;
      }
    }
  }
  std::filesystem::remove_all(options.folder);
}

// Radiance takes a tensor tree's cells as they are: cells of 4 degrees leave little of a lobe of 3 degrees' width,
// which interpolation between them would hide.
TEST(ErrorMeter, TakesATensorTreeWithoutInterpolation) {
  SyntheticCase narrow = test::Plastic();
  narrow.values[0] = narrow.values[1] = {0.045};
  ExportOptions options;
  options.targets = {&FindTarget("bsdf-xml")};
  options.folder = std::filesystem::path(testing::TempDir()) / "tensor_tree_error";
  options.name = "sample";
  const ExportResult result = ExportMaterial(test::MaterialOf(narrow), options).results[0];
  EXPECT_GT(result.error.lobe.median, 0.45);
  EXPECT_LT(result.error.lobe.median, 0.65);
  std::filesystem::remove_all(options.folder);
}

TEST(ErrorMeter, SaysWhatIsThere) {
  const FittedBrdf fit(test::MaterialOf(test::Tilted()));
  const ErrorMeter meter(fit);
  const ExportError same = meter.Compare(fit.function());
  EXPECT_EQ(same.lobe.maximum, 0);
  EXPECT_EQ(same.off.maximum, 0);
  EXPECT_EQ(same.albedo, 0);
  EXPECT_GT(same.lobe.compared, 3 * 1000U);
  EXPECT_EQ(same.uniform.compared, 3 * 6000U);
  const ExportError more = meter.Compare([f = fit.function()](const Vec3& wi, const Vec3& wo, double* values) {
    f(wi, wo, values);
    for (int c = 0; c < 3; ++c) values[c] *= 1.1;
  });
  for (const ErrorLevels* levels : {&more.uniform, &more.lobe, &more.off}) EXPECT_NEAR(levels->median, 0.1, 1e-9);
  EXPECT_NEAR(more.albedo, 0.1, 1e-9);
}

// A body colour that is halved under a mirror-like lobe: 50 % off the lobe, though it is a millionth of the peak.
TEST(ErrorMeter, SeesTheBodyUnderANarrowPeak) {
  const SyntheticCase narrow = OneLobe(Ndf::kGgx, 0.005, 0.005, 0, 0, 0, {0.5, 0.5, 0.5}, {0.01, 0.01, 0.01});
  SyntheticCase darker = narrow;
  darker.values.back() = {0.005, 0.005, 0.005};
  const FittedBrdf fit(test::MaterialOf(narrow)), other(test::MaterialOf(darker));
  const ExportError error = ErrorMeter(fit).Compare(other.function());
  EXPECT_NEAR(error.uniform.median, 0.5, 0.01);
  EXPECT_NEAR(error.off.median, 0.5, 0.01);
  EXPECT_LT(error.lobe.median, 1e-3);
  // The body is 0.01 of an albedo of 0.5 and more.
  EXPECT_NEAR(error.albedo, 0.005 / 0.51, 1e-3);
}

// Beyond the angles that refitting looks at.
TEST(ErrorMeter, LooksToGrazingDirections) {
  const FittedBrdf fit(test::MaterialOf(test::Plastic()));
  const ExportError error =
      ErrorMeter(fit).Compare([f = fit.function()](const Vec3& wi, const Vec3& wo, double* values) {
        f(wi, wo, values);
        const bool grazing = std::min(wi.z, wo.z) < std::cos(DegreesToRadians(82));
        for (int c = 0; c < 3; ++c) values[c] *= grazing ? 2 : 1;
      });
  EXPECT_EQ(error.off.median, 0);
  EXPECT_GT(error.off.maximum, 0.99);
  EXPECT_GT(error.albedo, 0.5);
}

// Two sets of numbers: one right but for the energy of a missing lobe, one with all of it and a little off.
TEST(ErrorMeter, TheChoiceWeighsAlbedo) {
  ExportError without, with;
  without.lobe.median = 3e-4, without.lobe.percentile_90 = 7e-3, without.albedo = 0.26;
  with.lobe.median = 5e-4, with.lobe.percentile_90 = 1e-2, with.albedo = 0.06;
  EXPECT_TRUE(IsBetter(with, without));
  EXPECT_FALSE(IsBetter(without, with));
  EXPECT_FALSE(IsBetter(with, with));
}

}  // namespace
}  // namespace lobefit

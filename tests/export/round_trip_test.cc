// Files that were written, read back: the same f_r; and the error that the export states.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/export/materials.h"
#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/export.h"
#include "lobefit/export/import.h"
#include "lobefit/export/targets.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

struct MaterialCase {
  const char* name;
  SyntheticCase (*material)();
};
std::ostream& operator<<(std::ostream& out, const MaterialCase& c) { return out << c.name; }

class RoundTrip : public testing::TestWithParam<MaterialCase> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("round_trip_") + GetParam().name);
    material_ = test::MaterialOf(GetParam().material());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<ExportResult> Export(const std::vector<const Target*>& targets, Numbers numbers) const {
    ExportOptions options;
    options.targets = targets;
    options.folder = folder_;
    options.name = "a material";
    options.numbers = numbers;
    options.threads = 2;
    return ExportMaterial(material_, options).results;
  }

  std::filesystem::path folder_;
  Material material_;
};

TEST_P(RoundTrip, TextsOfRenderersSayWhatTheModelsHold) {
  const FittedBrdf fit(material_);
  for (const Target& target : ExportTargets()) {
    if (target.evaluate == nullptr || (target.refusal != nullptr && !target.refusal(fit).empty())) continue;
    const std::vector<ExportResult> results = Export({&target}, Numbers::kCopied);
    const BrdfFunction wanted = target.evaluate(fit), read = ImportMaterial(results[0].files[0]).brdf;
    // Nine digits, a normal map of 16 bits; glTF's of 8 bits is good to 0.01 degrees.
    const double tolerance = fit.IsTilted() ? (std::string(target.name) == "gltf" ? 1e-2 : 3e-4) : 1e-6;
    ShapeGenerator directions(3);
    for (int k = 0; k < 300; ++k) {
      const Vec3 wi = directions.Upper(), wo = directions.Upper(), n = fit.lobes()[0].axis;
      // Near its own horizon a leaning lobe changes with the last bit of its normal.
      if (fit.IsTilted() && std::min(Dot(wi, n), Dot(wo, n)) < 0.1) continue;
      double a[3] = {}, b[3] = {};
      wanted(wi, wo, a);
      read(wi, wo, b);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(b[c], a[c], tolerance * (a[c] + 1e-2)) << target.name << " pair " << k;
    }
  }
}

TEST_P(RoundTrip, EachTargetStatesItsErrorAndWhatItLoses) {
  const FittedBrdf fit(material_);
  std::vector<const Target*> targets;
  for (const char* name : {"json", "glsl", "osl", "brdf-explorer", "pbrt", "mitsuba", "materialx", "openpbr", "gltf"}) {
    targets.push_back(&FindTarget(name));
  }
  for (const ExportResult& result : Export(targets, Numbers::kBetter)) {
    const std::string name = result.target->name;
    // Texts of the model itself are not read back: their error is not measured, and is not said to be 0.
    const bool is_text = name == "glsl" || name == "osl" || name == "brdf-explorer";
    if (is_text) {
      EXPECT_EQ(result.error.uniform.compared, 0U) << name;
      EXPECT_TRUE(std::isnan(result.error.albedo)) << name;
    } else {
      EXPECT_GT(result.error.uniform.compared, 5000U) << name;
    }
    const bool all_exact = std::all_of(result.carries.begin(), result.carries.end(),
                                       [](const Carried& row) { return row.how == Carries::kExactly; });
    if (all_exact) {
      EXPECT_LT(result.error.off.maximum, 1e-6) << name;
    } else {
      EXPECT_GT(std::max(result.error.lobe.maximum, result.error.off.maximum), 1e-6) << name;
    }
    // Where both were tried, the better one was written.
    if (result.other) {
      EXPECT_FALSE(IsBetter(*result.other, result.error)) << name;
    }
    EXPECT_GT(result.bytes, 100U);
    // The text says where it comes from, at its top; JSON as the first member.
    if (name != "json") {
      const FileBytes file(result.files[0]);
      const std::string top(file.bytes().substr(0, 1500));
      for (const char* words : {"exported by lobefit", "sample.csv", "log 0.0123", "command:"}) {
        EXPECT_NE(top.find(words), std::string::npos) << name << ": " << words;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, RoundTrip,
                         testing::Values(MaterialCase{"tilted", test::Tilted}, MaterialCase{"turned", test::Turned},
                                         MaterialCase{"plastic", test::Plastic},
                                         MaterialCase{"two_lobes", test::TwoLobes}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(Conductors, NearestIndexHasTheReflectanceAndIsNearerThanPbrts) {
  for (const double f0 : {0.04, 0.3, 0.7, 0.95}) {
    const auto schlick = [&](double c) { return f0 + (1 - f0) * std::pow(1 - c, 5); };
    const ConductorIndex nearest = NearestConductor(schlick), plain = ConductorOfReflectance(f0);
    const auto at = [](const ConductorIndex& index, double c) {
      return index.k > 0 ? FresnelConductor(c, index) : FresnelDielectric(c, index.eta);
    };
    EXPECT_NEAR(at(nearest, 1), f0, 1e-9);
    EXPECT_NEAR(at(plain, 1), f0, 1e-9);
    double error_nearest = 0, error_plain = 0;
    for (double c = 0.05; c < 1; c += 0.05) {
      error_nearest += c * std::pow(at(nearest, c) - schlick(c), 2);
      error_plain += c * std::pow(at(plain, c) - schlick(c), 2);
    }
    EXPECT_LE(error_nearest, error_plain * 1.001) << f0;
  }
}

}  // namespace
}  // namespace lobefit

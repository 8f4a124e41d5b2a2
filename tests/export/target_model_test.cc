// What the importers evaluate, against the models of the renderers written here anew from their documents: numbers are
// taken from the exported text by patterns, formulas by other routes (complex Fresnel amplitudes, masking by the
// tangent of the effective angle).
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <regex>

#include "tests/export/materials.h"
#include "tests/support/renderer_models.h"
#include "tests/support/shapes.h"
#include <gtest/gtest.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/export.h"
#include "lobefit/export/import.h"
#include "lobefit/export/targets.h"
#include "lobefit/renderer/normal_map.h"
#include "lobefit/renderer/roughness.h"

namespace lobefit {
namespace {

using test::ComplexFresnel;
using test::Frame;
using test::LobeAlbedo;
using test::LobeFactor;
using test::SchlickFresnel;
using test::TurnedFrame;
using Rgb3 = std::array<double, 3>;

// Every number in the first match's group of `pattern`.
std::vector<double> Find(const std::string& text, const std::string& pattern, int occurrence = 0) {
  std::vector<double> numbers;
  const std::regex wanted(pattern);
  auto match = std::sregex_iterator(text.begin(), text.end(), wanted);
  std::advance(match, occurrence);
  const std::string group = (*match)[1].str();
  const std::regex number("[-+]?[0-9.]+(e[-+]?[0-9]+)?");
  for (auto at = std::sregex_iterator(group.begin(), group.end(), number); at != std::sregex_iterator(); ++at) {
    numbers.push_back(std::stod(at->str()));
  }
  return numbers;
}

class TargetModel : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("target_model_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Exports the copied numbers and returns the text of the file.
  std::string Export(const SyntheticCase& synthetic, const char* target, const char* file) {
    ExportOptions options;
    options.targets = {&FindTarget(target)};
    options.folder = folder_;
    options.name = "sample";
    options.numbers = Numbers::kCopied;
    ExportMaterial(test::MaterialOf(synthetic), options);
    path_ = folder_ / file;
    return std::string(FileBytes(path_).bytes());
  }

  void ExpectSame(const std::function<Rgb3(const Vec3&, const Vec3&)>& expected, double tolerance, double least_cos = 0,
                  const Vec3& axis = {0, 0, 1}) const {
    const BrdfFunction imported = ImportMaterial(path_).brdf;
    ShapeGenerator directions(7);
    for (int k = 0; k < 200; ++k) {
      const Vec3 wi = directions.Upper(), wo = k % 5 == 0 ? Vec3{-wi.x, -wi.y, wi.z} : directions.Upper();
      if (Dot(wo, axis) < least_cos || Dot(wi, axis) < least_cos) continue;
      Rgb3 found = {};
      imported(wi, wo, found.data());
      const Rgb3 wanted = expected(wi, wo);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(found[c], wanted[c], tolerance * (wanted[c] + 1e-3)) << "channel " << c << ", pair " << k;
      }
    }
  }

  std::filesystem::path folder_, path_;
};

TEST_F(TargetModel, Pbrt) {
  const std::string text = Export(test::Tilted(), "pbrt", "sample.pbrt");
  const std::vector<double> eta = Find(text, "\"rgb eta\" \\[([^\\]]*)\\]"),
                            k = Find(text, "\"rgb k\" \\[([^\\]]*)\\]");
  const std::vector<double> rho = Find(text, "\"rgb reflectance\" \\[([^\\]]*)\\]");
  const double ax = Find(text, "\"float uroughness\" (\\S+)")[0], ay = Find(text, "\"float vroughness\" (\\S+)")[0];
  const double amount = Find(text, "\"float amount\" (\\S+)")[0];
  EXPECT_NE(text.find("\"bool remaproughness\" false"), std::string::npos);
  const double turn = DegreesToRadians(Find(text, "uv-rotation-deg: (\\S+)")[0]);
  const std::filesystem::path map = folder_ / "sample_normal1.png";
  const Vec3 m = NormalOfPng(FileBytes(map).bytes(), 1, map);
  const Vec3 n = {std::cos(turn) * m.x - std::sin(turn) * m.y, std::sin(turn) * m.x + std::cos(turn) * m.y, m.z};
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const double c = Dot(wi, Normalized(wi + wo));
        const double lobe = LobeFactor(TurnedFrame(turn, n), ax, ay, wi, wo, "correlated");
        Rgb3 f = {};
        for (std::size_t j = 0; j < 3; ++j) {
          f[j] = (1 - amount) * lobe * ComplexFresnel(eta[j], k[j], c) + amount * rho[j] / kPi;
        }
        return f;
      },
      1e-8);
}

TEST_F(TargetModel, Mitsuba) {
  const std::string text = Export(test::Turned(), "mitsuba", "sample.mitsuba.xml");
  const auto value = [&](const std::string& name) { return Find(text, "name=\"" + name + "\" value=\"([^\"]*)\""); };
  EXPECT_NE(text.find("<string name=\"distribution\" value=\"ggx\"/>"), std::string::npos);
  const std::vector<double> eta = value("eta"), k = value("k"), rho = value("reflectance");
  const double ax = value("alpha_u")[0], ay = value("alpha_v")[0], weight = value("weight")[0];
  const double turn = DegreesToRadians(Find(text, "uv-rotation-deg: (\\S+)")[0]);
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const double c = Dot(wi, Normalized(wi + wo));
        const double lobe = LobeFactor(TurnedFrame(turn, {0, 0, 1}), ax, ay, wi, wo, "separable");
        Rgb3 f = {};
        for (std::size_t j = 0; j < 3; ++j) {
          f[j] = (1 - weight) * lobe * ComplexFresnel(eta[j], k[j], c) + weight * rho[j] / kPi;
        }
        return f;
      },
      1e-8);
}

TEST_F(TargetModel, MaterialX) {
  const std::string text = Export(test::Turned(), "materialx", "sample.mtlx");
  const auto value = [&](const std::string& name) {
    return Find(text, "name=\"" + name + "\" type=\"[a-z0-9]*\" value=\"([^\"]*)\"");
  };
  const std::vector<double> f0 = value("color0"), alpha = value("roughness"), rho = value("color");
  EXPECT_EQ(value("color90"), (std::vector<double>{1, 1, 1}));
  // The tangent as nodes: cos T + sin B.
  const double cos = Find(text, "_tangent_0\"[^>]*>\\s*<input[^>]*>\\s*<input name=\"in2\"[^>]*value=\"([^\"]*)\"")[0];
  const double sin = Find(text, "_tangent_1\"[^>]*>\\s*<input[^>]*>\\s*<input name=\"in2\"[^>]*value=\"([^\"]*)\"")[0];
  EXPECT_NEAR(cos * cos + sin * sin, 1, 1e-8);
  const double mean = std::sqrt(alpha[0] * alpha[1]);
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const double c = Dot(wi, Normalized(wi + wo));
        const double lobe =
            LobeFactor(TurnedFrame(std::atan2(sin, cos), {0, 0, 1}), alpha[0], alpha[1], wi, wo, "mean");
        const double e = LobeAlbedo(mean, wo.z);
        Rgb3 f = {};
        for (std::size_t j = 0; j < 3; ++j) {
          const double fresnel = SchlickFresnel(f0[j], c);
          f[j] = lobe * fresnel * (1 + fresnel * (1 - e) / e) + rho[j] / kPi;
        }
        return f;
      },
      // The albedo's table.
      3e-3, 0.1);
}

// MaterialX' layer: the coat and, less its albedo seen from the viewer, what lies below, whose colours have the light's
// way in at normal incidence and the absorption both ways.
TEST_F(TargetModel, MaterialXCoat) {
  SyntheticCase coated;
  coated.model.lobes = {{Ndf::kGgx}, {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered}};
  const double ior = 1.6, alpha = 0.3, coat_alpha = 0.1, f0 = std::pow((ior - 1) / (ior + 1), 2);
  const std::vector<double> tau = {0, 0.1, 0.3}, rho = {0.3, 0.2, 0.1}, base = {0.6, 0.4, 0.2};
  coated.values = {{alpha}, {alpha},         {0}, {0}, {0}, base, {coat_alpha}, {coat_alpha}, {0}, {0},
                   {0},     {ior, ior, ior}, tau, rho};
  const std::string text = Export(coated, "materialx", "sample.mtlx");
  EXPECT_NE(text.find("<layer name=\"sample_coated\""), std::string::npos);
  EXPECT_NE(text.find("<input name=\"scatter_mode\" type=\"string\" value=\"R\"/>"), std::string::npos);
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const double c = Dot(wi, Normalized(wi + wo));
        const auto frame = TurnedFrame(0, {0, 0, 1});
        const double e = LobeAlbedo(alpha, wo.z), coat_e = LobeAlbedo(coat_alpha, wo.z);
        const double F = FresnelDielectric(c, ior), lost = (1 - coat_e) / coat_e;
        const double coat = LobeFactor(frame, coat_alpha, coat_alpha, wi, wo, "mean") * F * (1 + F * lost);
        const double left = 1 - LobeAlbedo(coat_alpha, wo.z, f0) * (1 + lost * FresnelDielectric(wo.z, ior));
        Rgb3 f = {};
        for (std::size_t j = 0; j < 3; ++j) {
          const double kept = (1 - f0) * std::exp(-2 * tau[j]);
          const double fresnel = kept * SchlickFresnel(base[j], c);
          const double below = LobeFactor(frame, alpha, alpha, wi, wo, "mean") * fresnel * (1 + fresnel * (1 - e) / e) +
                               rho[j] * std::exp(-2 * tau[j]) / kPi;
          f[j] = coat + left * below;
        }
        return f;
      },
      3e-3, 0.1);
}

// The same as the coat of an OpenPBR surface, over a metal and over a dielectric: it makes the lobe below rougher and
// the dielectric's index count relative to its own, which the numbers undo. Darkening is off.
TEST_F(TargetModel, OpenPbrCoat) {
  const double ior = 1.6, alpha = 0.3, coat_alpha = 0.1, f0 = std::pow((ior - 1) / (ior + 1), 2);
  const std::vector<double> tau = {0, 0.1, 0.3}, rho = {0.3, 0.2, 0.1};
  for (const std::vector<double>& base : {std::vector<double>{0.9, 0.6, 0.4}, std::vector<double>{0.08, 0.05, 0.02}}) {
    SyntheticCase coated;
    coated.model.lobes = {{Ndf::kGgx}, {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered}};
    coated.values = {{alpha}, {alpha},         {0}, {0}, {0}, base, {coat_alpha}, {coat_alpha}, {0}, {0},
                     {0},     {ior, ior, ior}, tau, rho};
    const std::string text = Export(coated, "openpbr", "sample.openpbr.mtlx");
    const auto value = [&](const std::string& name) {
      return Find(text, "name=\"" + name + "\" type=\"[a-z0-9]*\" value=\"([^\"]*)\"");
    };
    EXPECT_EQ(value("coat_weight")[0], 1);
    EXPECT_EQ(value("coat_darkening")[0], 0);
    EXPECT_NEAR(value("coat_ior")[0], ior, 1e-6);
    EXPECT_NEAR(std::pow(value("coat_roughness")[0], 2), coat_alpha, 1e-6);
    const double roughness = value("specular_roughness")[0];
    const double below_alpha = std::sqrt(std::pow(roughness, 4) + 2 * std::pow(value("coat_roughness")[0], 4));
    EXPECT_NEAR(below_alpha, alpha, 1e-6);
    const double metalness = value("base_metalness")[0], index = value("specular_ior")[0] / value("coat_ior")[0];
    const std::vector<double> color = value("base_color"), tint = value("specular_color");
    ExpectSame(
        [&](const Vec3& wi, const Vec3& wo) {
          const double c = Dot(wi, Normalized(wi + wo));
          const auto frame = TurnedFrame(0, {0, 0, 1});
          const double e = LobeAlbedo(below_alpha, wo.z), coat_e = LobeAlbedo(coat_alpha, wo.z);
          const double lost = (1 - e) / e, coat_lost = (1 - coat_e) / coat_e;
          const double F = FresnelDielectric(c, ior);
          const double coat = LobeFactor(frame, coat_alpha, coat_alpha, wi, wo, "mean") * F * (1 + F * coat_lost);
          const double left = 1 - LobeAlbedo(coat_alpha, wo.z, f0) * (1 + coat_lost * FresnelDielectric(wo.z, ior));
          const double lobe = LobeFactor(frame, below_alpha, below_alpha, wi, wo, "mean");
          const double d = FresnelDielectric(c, index), d0 = FresnelDielectric(1, index);
          const double passes = 1 - LobeAlbedo(below_alpha, wo.z, d0) * (1 + lost * FresnelDielectric(wo.z, index));
          Rgb3 f = {};
          for (std::size_t j = 0; j < 3; ++j) {
            const double m = SchlickFresnel(color[j], c);
            const double below = metalness * lobe * m * (1 + m * lost) +
                                 (1 - metalness) * (lobe * d * (1 + d * lost) * tint[j] + passes * color[j] / kPi);
            f[j] = coat + left * below;
          }
          return f;
        },
        3e-3, 0.1);
    const BrdfFunction imported = ImportMaterial(path_).brdf;
    double peak[3];
    imported({0, 0, 1}, {0, 0, 1}, peak);
    const double kept = (1 - f0) * std::exp(-2 * tau[0]) * (1 - LobeAlbedo(coat_alpha, 1, f0));
    EXPECT_NEAR(peak[0], f0 / (4 * kPi * coat_alpha * coat_alpha) + kept * base[0] / (4 * kPi * alpha * alpha) + 0.1,
                0.06 * peak[0])
        << "what lies below has the fit's reflectance and width";
  }
}

// An edge tint over a rough diffuse part.
SyntheticCase Tinted() {
  SyntheticCase synthetic = test::Turned();
  synthetic.model.lobes[0].fresnel = Fresnel::kSchlickF82;
  synthetic.model.diffuse = Diffuse::kOrenNayar;
  const std::vector<double> diffuse = {0.3, 0.2, 0.1};
  synthetic.values.back() = {0.5, 0.8, 1};
  synthetic.values.push_back({0.7, 0.7, 0.7});
  synthetic.values.push_back(diffuse);
  return synthetic;
}

// Share of light that a rough surface sends back at once [the terms of MaterialX' GLSL].
double RoughShare(double c, double roughness) {
  const double sn = std::sqrt(1 - c * c), a = 1 / (1 + (0.5 - 2 / (3 * kPi)) * roughness);
  const double g = sn * (std::acos(c) - sn * c) + 2.0 / 3 * (sn / c * (1 - sn * sn * sn) - sn);
  return a * (1 + roughness * g / kPi);
}

TEST_F(TargetModel, MaterialXTintAndRoughDiffuse) {
  const std::string text = Export(Tinted(), "materialx", "sample.mtlx");
  const auto value = [&](const std::string& name) {
    return Find(text, "name=\"" + name + "\" type=\"[a-z0-9]*\" value=\"([^\"]*)\"");
  };
  const std::vector<double> f0 = value("color0"), tint = value("color82"), rho = value("color");
  EXPECT_EQ(tint, (std::vector<double>{0.5, 0.8, 1}));
  const std::vector<double> alpha = value("roughness");
  const double roughness = Find(text, "name=\"roughness\" type=\"float\" value=\"([^\"]*)\"")[0];
  EXPECT_EQ(roughness, 0.7);
  EXPECT_NE(text.find("<input name=\"energy_compensation\" type=\"boolean\" value=\"true\"/>"), std::string::npos);
  const double mean = std::sqrt(alpha[0] * alpha[1]), turn = FittedBrdf(test::MaterialOf(Tinted())).lobes()[0].rotation;
  const double single = 1 / (1 + (0.5 - 2 / (3 * kPi)) * roughness);
  const double average = single * (1 + (2.0 / 3 - 28 / (15 * kPi)) * roughness);
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const double c = Dot(wi, Normalized(wi + wo)),
                     lobe = LobeFactor(TurnedFrame(turn, {0, 0, 1}), alpha[0], alpha[1], wi, wo, "mean");
        const double e = LobeAlbedo(mean, wo.z), s = std::max(0.0, Dot(wi, wo)) - wi.z * wo.z;
        const double st = s > 0 ? s / std::max(wi.z, wo.z) : s;
        Rgb3 f = {};
        for (std::size_t j = 0; j < 3; ++j) {
          const double edge = SchlickFresnel(f0[j], 1.0 / 7) * (1 - tint[j]) * 7 / std::pow(6.0 / 7, 6);
          const double fresnel = SchlickFresnel(f0[j], c) - edge * c * std::pow(1 - c, 6);
          const double again = rho[j] * rho[j] * average / (1 - rho[j] * (1 - average)) *
                               (1 - RoughShare(wo.z, roughness)) * (1 - RoughShare(wi.z, roughness)) / (1 - average);
          f[j] = lobe * fresnel * (1 + fresnel * (1 - e) / e) + (rho[j] * single * (1 + roughness * st) + again) / kPi;
        }
        return f;
      },
      // The albedo's table.
      3e-3, 0.1);
}

// A metal with an edge tint and nothing else is OpenPBR's own.
TEST_F(TargetModel, OpenPbrHoldsATintedMetalExactly) {
  SyntheticCase metal = Tinted();
  metal.model.diffuse = Diffuse::kNone;
  metal.values.resize(metal.values.size() - 2);
  const std::string text = Export(metal, "openpbr", "sample.openpbr.mtlx");
  const auto value = [&](const std::string& name) {
    return Find(text, "name=\"" + name + "\" type=\"[a-z0-9]*\" value=\"([^\"]*)\"");
  };
  EXPECT_EQ(value("base_metalness")[0], 1);
  EXPECT_EQ(value("base_color"), (std::vector<double>{0.7, 0.66, 0.58}));
  EXPECT_EQ(value("specular_color"), (std::vector<double>{0.5, 0.8, 1}));
  for (const Carried& row : FindTarget("openpbr").carries(FittedBrdf(test::MaterialOf(metal)))) {
    EXPECT_TRUE(row.feature != Feature::kFresnel || row.how == Carries::kExactly) << row.note;
  }
}

TEST_F(TargetModel, Gltf) {
  const std::string text = Export(test::Tilted(), "gltf", "sample.gltf");
  const auto value = [&](const std::string& name) { return Find(text, "\"" + name + "\": (\\[[^\\]]*\\]|[-0-9.e]+)"); };
  const std::vector<double> base = value("baseColorFactor");
  const double metal = value("metallicFactor")[0], r = value("roughnessFactor")[0], s = value("anisotropyStrength")[0];
  const double turn = value("anisotropyRotation")[0];
  const double ay = r * r, ax = ay + (1 - ay) * s * s;
  const Vec3 n = Normalized(FittedBrdf(test::MaterialOf(test::Tilted())).lobes()[0].axis);
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const double c = Dot(wi, Normalized(wi + wo));
        const Frame frame = TurnedFrame(turn, n);
        const double lobe = LobeFactor(frame, ax, ay, wi, wo, "correlated");
        const double dielectric = SchlickFresnel(0.04, c);
        const double below = Dot(n, wi) > 0 && Dot(n, wo) > 0 ? Dot(n, wi) / wi.z : 0;
        Rgb3 f = {};
        for (std::size_t k = 0; k < 3; ++k) {
          f[k] = metal * lobe * SchlickFresnel(base[k], c) +
                 (1 - metal) * (lobe * dielectric + (1 - dielectric) * base[k] / kPi * below);
        }
        return f;
      },
      // The normal map's 8 bits: 0.01 degrees, which count near the tilted horizon.
      5e-3, 0.1, n);
}

// What a viewer is known to lack is said of files that need it, and of no others.
TEST_F(TargetModel, GltfNamesWhatViewersLack) {
  const auto notes = [&](const SyntheticCase& synthetic) {
    ExportOptions options;
    options.targets = {&FindTarget("gltf")};
    options.folder = folder_;
    options.name = "sample";
    options.numbers = Numbers::kCopied;
    std::string all;
    const ExportOutcome outcome = ExportMaterial(test::MaterialOf(synthetic), options);
    for (const std::string& note : outcome.results[0].notes) all += note;
    return all;
  };
  SyntheticCase plain = test::Plastic(), tinted = test::Plastic(), coated = test::Plastic();
  plain.values[5] = {0.04, 0.04, 0.04};
  tinted.values[5] = {0.04, 0.03, 0.02};
  coated.model.lobes.push_back({Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered});
  coated.values.insert(coated.values.begin() + 6, {{0.1}, {0.1}, {0}, {0}, {0}, {1.5, 1.5, 1.5}, {0, 0, 0}});
  EXPECT_EQ(notes(plain), "");
  EXPECT_NE(notes(tinted).find("KHR_materials_specular"), std::string::npos);
  EXPECT_NE(notes(coated).find("clear coat"), std::string::npos);
  EXPECT_NE(notes(test::Turned()).find("KHR_materials_anisotropy"), std::string::npos);
}

// [KHR_materials_clearcoat]: mix(base, coat, w F), F Schlick's of 0.04 at the viewer's cosine to the surface.
TEST_F(TargetModel, GltfCoat) {
  SyntheticCase coated;
  coated.model.lobes = {{Ndf::kGgx}, {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered}};
  const double ior = 1.4, alpha = 0.3, coat_alpha = 0.1, f0 = std::pow((ior - 1) / (ior + 1), 2);
  coated.values = {{alpha},       {alpha},      {0}, {0}, {0}, {0.9, 0.6, 0.4},
                   {coat_alpha},  {coat_alpha}, {0}, {0}, {0}, {ior, ior, ior},
                   {0, 0.1, 0.3}, {0, 0, 0}};
  const std::string text = Export(coated, "gltf", "sample.gltf");
  const auto value = [&](const std::string& name) { return Find(text, "\"" + name + "\": (\\[[^\\]]*\\]|[-0-9.e]+)"); };
  const std::vector<double> base = value("baseColorFactor");
  const double weight = value("clearcoatFactor")[0], roughness = value("clearcoatRoughnessFactor")[0];
  EXPECT_EQ(value("metallicFactor")[0], 1);
  EXPECT_NEAR(weight, f0 / 0.04, 1e-12);
  EXPECT_NEAR(roughness * roughness, coat_alpha, 1e-12);
  EXPECT_NEAR(base[1], 0.6 * (1 - f0) * std::exp(-0.2), 1e-12);
  ExpectSame(
      [&](const Vec3& wi, const Vec3& wo) {
        const auto frame = TurnedFrame(0, {0, 0, 1});
        const double c = Dot(wi, Normalized(wi + wo)), mixed = weight * SchlickFresnel(0.04, wo.z);
        Rgb3 f = {};
        for (std::size_t k = 0; k < 3; ++k) {
          f[k] = mixed * LobeFactor(frame, coat_alpha, coat_alpha, wi, wo, "correlated") +
                 (1 - mixed) * LobeFactor(frame, alpha, alpha, wi, wo, "correlated") * SchlickFresnel(base[k], c);
        }
        return f;
      },
      1e-6);
}

TEST_F(TargetModel, OpenPbr) {
  const std::string text = Export(test::Turned(), "openpbr", "sample.openpbr.mtlx");
  const auto value = [&](const std::string& name) {
    return Find(text, "name=\"" + name + "\" type=\"[a-z0-9]*\" value=\"([^\"]*)\"");
  };
  const Widths widths = OpenPbrWidths({value("specular_roughness")[0], value("specular_roughness_anisotropy")[0]});
  EXPECT_NEAR(widths.alpha_1, 0.35, 1e-8);
  EXPECT_NEAR(widths.alpha_2, 0.11, 1e-8);
  const double metal = value("base_metalness")[0];
  const std::vector<double> base = value("base_color");
  EXPECT_GT(metal, 0.9);
  // The reflectance of metal and dielectric base together is the fit's.
  const double mean = std::sqrt(widths.alpha_1 * widths.alpha_2), e = LobeAlbedo(mean, 1);
  const Vec3 up = {0, 0, 1};
  Rgb3 found = {};
  ImportMaterial(path_).brdf(up, up, found.data());
  const double lobe = LobeFactor(TurnedFrame(0, up), widths.alpha_1, widths.alpha_2, up, up, "mean");
  for (std::size_t c = 0; c < 3; ++c) {
    const double lost = (1 - e) / e, dielectric = 0.04;
    const double specular =
        metal * lobe * base[c] * (1 + base[c] * lost) + (1 - metal) * lobe * dielectric * (1 + dielectric * lost);
    const double diffuse = (1 - metal) * base[c] * (1 - dielectric * e * (1 + dielectric * lost)) / kPi;
    EXPECT_NEAR(found[c] / (specular + diffuse), 1, 1e-3) << c;
  }
}

}  // namespace
}  // namespace lobefit

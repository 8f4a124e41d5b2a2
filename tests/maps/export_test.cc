// Exported maps read back at 1000 texels: the textures are found by the document, decoded, and evaluated by the models
// of the renderers as they are written anew in tests/support/renderer_models.h.
#include <array>
#include <functional>
#include <map>
#include <regex>

#include "tests/maps/texels.h"
#include "tests/support/folder_test.h"
#include "tests/support/renderer_models.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include "lobefit/base/error.h"
#include "lobefit/export/targets.h"
#include "lobefit/maps/output/pixels.h"
#include "lobefit/maps/stack/image_rows.h"
#include "lobefit/maps/textures/export_maps.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/region_median.h"

namespace lobefit {
namespace {

using test::LobeFactor;
using test::SchlickFresnel;
using Rgb3 = std::array<double, 3>;
// Stored values in [0, 1], or floats, of one texel.
using Pixel = std::array<double, 4>;
using Evaluator = std::function<Rgb3(std::size_t texel, const Vec3& wi, const Vec3& wo)>;

constexpr std::size_t kSize = 40;

double FromSrgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

std::vector<Pixel> RgbaPixels(const std::string& bytes) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  std::vector<Pixel> pixels;
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) return pixels;
  image.format = PNG_FORMAT_RGBA;
  std::vector<png_byte> codes(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, codes.data(), 0, nullptr);
  for (std::size_t t = 0; t < codes.size() / 4; ++t) {
    pixels.push_back(
        {codes[4 * t] / 255.0, codes[4 * t + 1] / 255.0, codes[4 * t + 2] / 255.0, codes[4 * t + 3] / 255.0});
  }
  return pixels;
}

Vec3 NormalIn(const Pixel& pixel) { return Normalized(Vec3{2 * pixel[0] - 1, 2 * pixel[1] - 1, 2 * pixel[2] - 1}); }
double TurnIn(const Pixel& pixel) { return std::atan2(2 * pixel[1] - 1, 2 * pixel[0] - 1); }

struct Case {
  const char* target;
  const char* document;
  MapLobe lobe;
  bool calibrated;
};

class ExportedMaps : public FolderTest {
 protected:
  // Hills with texels whose numbers are missing or outside.
  void Export(const Case& c) {
    hills_ = MakeHills(kSize, c.lobe);
    const auto plane = [&](const std::string& name) {
      return PlaneIndex(hills_.maps.planes, MapPart::kParameters, name);
    };
    for (std::size_t t = 700; t < 720; ++t) {
      hills_.maps.rows.values[plane(c.lobe == MapLobe::kGgx ? "alpha" : "alpha_x")][t] = NAN;
    }
    for (std::size_t t = 900; t < 903; ++t) hills_.maps.rows.values[plane("normal.x")][t] = NAN;
    for (std::size_t t = 1000; t < 1010; ++t) hills_.maps.rows.values.back()[t] = kMapOutside;
    Write("truth.maps.exr", "bytes for a digest");
    ExportOptions options;
    options.targets = {&FindTarget(c.target)};
    options.folder = folder_;
    options.name = "sample";
    outcome_ = ExportMaps(hills_.maps, {c.calibrated, {}, "hills"}, folder_ / "truth.maps.exr", options, {});
    numbers_ = std::make_unique<MapNumbers>(hills_.maps, c.calibrated, kNan);
    text_ = Read(c.document);
  }

  const std::vector<Pixel>& Picture(const std::string& file) {
    std::vector<Pixel>& pixels = pictures_[file];
    if (!pixels.empty()) return pixels;
    if (file.find("specular.png") != std::string::npos && file.find("gltf") != std::string::npos) {
      pixels = RgbaPixels(Read(file));
      return pixels;
    }
    const std::unique_ptr<ImageRows> rows = OpenImage(folder_ / file);
    EXPECT_EQ(rows->width(), kSize) << file;
    std::vector<float> row(rows->width() * rows->channels());
    for (std::size_t y = 0; y < rows->height(); ++y) {
      rows->Next(row.data());
      for (std::size_t x = 0; x < rows->width(); ++x) {
        Pixel pixel = {};
        for (std::size_t c = 0; c < rows->channels(); ++c)
          pixel[c] = static_cast<double>(row[x * rows->channels() + c]);
        pixels.push_back(pixel);
      }
    }
    return pixels;
  }

  // The first group of the pattern in the document.
  std::string Match(const std::string& pattern) const {
    std::smatch match;
    return std::regex_search(text_, match, std::regex(pattern)) ? match[1].str() : "nothing matches " + pattern;
  }

  Evaluator Gltf(const Case& c);
  Evaluator Conductors(const Case& c, const std::map<std::string, std::string>& files, const std::string& masking);
  Evaluator Pbrt(const Case& c);
  Evaluator Mitsuba(const Case& c);
  Evaluator MaterialX(const Case& c);
  Evaluator OpenPbr(const Case& c);
  // The file of the image that an input of a MaterialX node is connected to.
  std::string ImageOf(const std::string& input) const {
    return Match("<image name=\"" + Match("name=\"" + input + "\" type=\"[a-z0-9]*\" nodename=\"([^\"]*)\"") +
                 "\"[^>]*>\\s*<input name=\"file\" type=\"filename\" value=\"([^\"]*)\"");
  }
  std::string NodeFile(const std::string& node) const {
    return Match("<image name=\"" + node + "\"[^>]*>\\s*<input name=\"file\" type=\"filename\" value=\"([^\"]*)\"");
  }

  Hills hills_;
  ExportOutcome outcome_;
  std::unique_ptr<MapNumbers> numbers_;
  std::string text_;
  std::map<std::string, std::vector<Pixel>> pictures_;
};

Evaluator ExportedMaps::Gltf(const Case& c) {
  const nlohmann::json json = nlohmann::json::parse(text_);
  const nlohmann::json& material = json["materials"][0];
  const auto file = [&](const nlohmann::json& use) {
    return json["images"][json["textures"][use["index"].get<std::size_t>()]["source"].get<std::size_t>()]["uri"]
        .get<std::string>();
  };
  const nlohmann::json& specular = material["extensions"]["KHR_materials_specular"];
  EXPECT_EQ(file(specular["specularTexture"]), file(specular["specularColorTexture"]));
  const double factor = specular["specularColorFactor"][0].get<double>();
  const bool turned = c.lobe == MapLobe::kGgxAnisotropic;
  const std::string base = file(material["pbrMetallicRoughness"]["baseColorTexture"]),
                    rough = file(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]),
                    color = file(specular["specularTexture"]), normal = file(material["normalTexture"]),
                    along = turned ? file(material["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"]) : "";
  return [=, this](std::size_t t, const Vec3& wi, const Vec3& wo) {
    const Pixel mr = Picture(rough)[t], s = Picture(color)[t];
    const Vec3 n = NormalIn(Picture(normal)[t]);
    const double strength = turned ? Picture(along)[t][2] : 0, ay = mr[1] * mr[1],
                 ax = ay + (1 - ay) * strength * strength;
    const double lobe =
        LobeFactor(test::TurnedFrame(turned ? TurnIn(Picture(along)[t]) : 0, n), ax, ay, wi, wo, "correlated");
    const double cos_d = Dot(wi, Normalized(wi + wo)), rest = std::pow(1 - cos_d, 5);
    Rgb3 f = {}, dielectric = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const double f0 = std::min(1.0, 0.04 * factor * FromSrgb(s[k])) * s[3];
      dielectric[k] = f0 + (s[3] - f0) * rest;
    }
    const double most = *std::max_element(dielectric.begin(), dielectric.end());
    for (std::size_t k = 0; k < 3; ++k) {
      const double b = FromSrgb(Picture(base)[t][k]);
      f[k] = mr[2] * lobe * SchlickFresnel(b, cos_d) +
             (1 - mr[2]) * (lobe * dielectric[k] + (1 - most) * b / kPi * Dot(n, wi) / wi.z);
    }
    return f;
  };
}

Evaluator ExportedMaps::Conductors(const Case& c, const std::map<std::string, std::string>& files,
                                   const std::string& masking) {
  return [=, this](std::size_t t, const Vec3& wi, const Vec3& wo) {
    const auto at = [&](const char* name) { return Picture(files.at(name))[t]; };
    const Vec3 n = NormalIn(at("normal"));
    const double share = at("share")[0], cos_d = Dot(wi, Normalized(wi + wo));
    const double lobe =
        share == 1 ? 0 : LobeFactor(test::TurnedFrame(0, n), at("alpha_u")[0], at("alpha_v")[0], wi, wo, masking);
    Rgb3 f = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const double number = at("specular")[k];
      double fresnel = number;  // a coloured mirror
      if (c.calibrated || masking != "separable") {
        const bool extinction = masking == "separable";
        fresnel = test::ComplexFresnel(1, extinction ? number : 2 * std::sqrt(number / (1 - number)), cos_d);
      }
      f[k] = (1 - share) * lobe * fresnel + share * at("diffuse")[k] / kPi * Dot(n, wi) / wi.z;
    }
    return f;
  };
}

Evaluator ExportedMaps::Pbrt(const Case& c) {
  EXPECT_THAT(text_, testing::HasSubstr("\"bool remaproughness\" false"));
  EXPECT_THAT(text_, testing::HasSubstr("\"string materials\" [\"sample.lobe\" \"sample.base\"]"));
  const auto texture = [&](const std::string& use) {
    return Match("Texture \"" + Match(use) +
                 "\" \"[a-z]*\" \"imagemap\" \"string filename\" \"([^\"]*)\" \"string encoding\" \"linear\"");
  };
  return Conductors(c,
                    {{"specular", texture("\"conductor\" \"texture reflectance\" \"([^\"]*)\"")},
                     {"diffuse", texture("\"diffuse\" \"texture reflectance\" \"([^\"]*)\"")},
                     {"share", texture("\"texture amount\" \"([^\"]*)\"")},
                     {"alpha_u", texture("\"texture uroughness\" \"([^\"]*)\"")},
                     {"alpha_v", texture("\"texture vroughness\" \"([^\"]*)\"")},
                     {"normal", Match("\"string normalmap\" \"([^\"]*)\"")}},
                    "correlated");
}

Evaluator ExportedMaps::Mitsuba(const Case& c) {
  EXPECT_THAT(text_, testing::HasSubstr("<string name=\"distribution\" value=\"ggx\"/>"));
  EXPECT_THAT(text_, testing::HasSubstr(c.calibrated ? "<rgb name=\"eta\" value=\"1\"/>"
                                                     : "<string name=\"material\" value=\"none\"/>"));
  const auto texture = [&](const std::string& name) {
    return Match("name=\"" + name +
                 "\">\\s*<string name=\"filename\" value=\"([^\"]*)\"/>\\s*<boolean name=\"raw\" value=\"true\"/>");
  };
  return Conductors(c,
                    {{"specular", texture(c.calibrated ? "k" : "specular_reflectance")},
                     {"diffuse", texture("reflectance")},
                     {"share", texture("weight")},
                     {"alpha_u", texture("alpha_u")},
                     {"alpha_v", texture("alpha_v")},
                     {"normal", texture("normalmap")}},
                    "separable");
}

Evaluator ExportedMaps::MaterialX(const Case& c) {
  const bool turned = c.lobe == MapLobe::kGgxAnisotropic;
  const std::string f0 = ImageOf("color0"), weight = ImageOf("weight"), rho = ImageOf("color"),
                    ax_file = NodeFile("sample_alpha_x"), ay_file = turned ? NodeFile("sample_alpha_y") : ax_file,
                    normal = NodeFile("sample_normal_map"), along = turned ? NodeFile("sample_direction_map") : "";
  EXPECT_EQ(text_.find("<input name=\"color90\" type=\"color3\" value=\"1, 1, 1\"/>") != std::string::npos,
            c.calibrated);
  return [=, this, schlick = c.calibrated](std::size_t t, const Vec3& wi, const Vec3& wo) {
    const Vec3 n = NormalIn(Picture(normal)[t]);
    const double ax = Picture(ax_file)[t][0], ay = Picture(ay_file)[t][0], cos_d = Dot(wi, Normalized(wi + wo));
    double lobe = 0, lost = 0;
    if (Picture(weight)[t][0] > 0) {
      lobe = LobeFactor(test::TurnedFrame(turned ? TurnIn(Picture(along)[t]) : 0, n), ax, ay, wi, wo, "mean");
      lost = 1 / test::LobeAlbedo(std::sqrt(ax * ay), Dot(n, wo), 1, 24) - 1;
    }
    Rgb3 f = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const double r = Picture(f0)[t][k], fresnel = schlick ? SchlickFresnel(r, cos_d) : r;
      f[k] = lobe * fresnel * (1 + fresnel * lost) + Picture(rho)[t][k] / kPi * Dot(n, wi) / wi.z;
    }
    return f;
  };
}

Evaluator ExportedMaps::OpenPbr(const Case& c) {
  const bool turned = c.lobe == MapLobe::kGgxAnisotropic;
  const std::string base = ImageOf("base_color"), tint = ImageOf("specular_color"), weight = ImageOf("specular_weight"),
                    numbers = NodeFile("sample_parameters"), normal = NodeFile("sample_normal_map"),
                    along = turned ? NodeFile("sample_direction_map") : "";
  const double ior = std::stod(Match("name=\"specular_ior\" type=\"float\" value=\"([^\"]*)\"")),
               most = std::pow((ior - 1) / (ior + 1), 2);
  for (const char* use : {"base_metalness\" type=\"float\" nodename=\"sample_split\" output=\"outx",
                          "specular_roughness\" type=\"float\" nodename=\"sample_split\" output=\"outy",
                          "specular_roughness_anisotropy\" type=\"float\" nodename=\"sample_split\" output=\"outz"}) {
    EXPECT_THAT(text_, testing::HasSubstr(use));
  }
  return [=, this](std::size_t t, const Vec3& wi, const Vec3& wo) {
    const Pixel p = Picture(numbers)[t], b = Picture(base)[t], color = Picture(tint)[t];
    const Vec3 n = NormalIn(Picture(normal)[t]);
    const double left = 1 - p[2], ax = p[1] * p[1] * std::sqrt(2 / (1 + left * left)), ay = left * ax,
                 mean = std::sqrt(ax * ay);
    const double lobe =
        LobeFactor(test::TurnedFrame(turned ? TurnIn(Picture(along)[t]) : 0, n), ax, ay, wi, wo, "mean");
    const double root = std::sqrt(Picture(weight)[t][0] * most), eta = (1 + root) / (1 - root), f0 = root * root;
    const double cos_d = Dot(wi, Normalized(wi + wo)), cos_o = Dot(n, wo);
    const double e = test::LobeAlbedo(mean, cos_o, 1, 24), lost = 1 / e - 1;
    const double dielectric = test::ComplexFresnel(eta, 0, cos_d);
    const double layer =
        std::min(1.0, test::LobeAlbedo(mean, cos_o, f0, 24) * (1 + lost * test::ComplexFresnel(eta, 0, cos_o)));
    Rgb3 f = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const double metal = SchlickFresnel(b[k], cos_d);
      f[k] = p[0] * lobe * metal * (1 + metal * lost) +
             (1 - p[0]) * (lobe * dielectric * (1 + dielectric * lost) * color[k] +
                           b[k] * (1 - layer) / kPi * Dot(n, wi) / wi.z);
    }
    return f;
  };
}

class EachExport : public ExportedMaps, public testing::WithParamInterface<Case> {};
INSTANTIATE_TEST_SUITE_P(Targets, EachExport,
                         testing::Values(Case{"gltf", "sample.gltf", MapLobe::kGgx, true},
                                         Case{"gltf", "sample.gltf", MapLobe::kGgxAnisotropic, true},
                                         Case{"gltf", "sample.gltf", MapLobe::kGgx, false},
                                         Case{"pbrt", "sample.pbrt", MapLobe::kGgx, true},
                                         Case{"pbrt", "sample.pbrt", MapLobe::kGgxAnisotropic, true},
                                         Case{"mitsuba", "sample.mitsuba.xml", MapLobe::kGgxAnisotropic, true},
                                         Case{"mitsuba", "sample.mitsuba.xml", MapLobe::kGgx, false},
                                         Case{"materialx", "sample.mtlx", MapLobe::kGgxAnisotropic, true},
                                         Case{"materialx", "sample.mtlx", MapLobe::kGgx, false},
                                         Case{"openpbr", "sample.openpbr.mtlx", MapLobe::kGgxAnisotropic, true}),
                         [](const auto& each) {
                           return std::string(each.param.target) +
                                  (each.param.lobe == MapLobe::kGgx ? "Round" : "Turned") +
                                  (each.param.calibrated ? "" : "WithoutFresnel");
                         });

TEST_P(EachExport, FilesAreWhatTheReportedErrorSays) {
  const Case& c = GetParam();
  Export(c);
  ASSERT_EQ(outcome_.results.size(), 1U);
  const std::string name = c.target;
  const Evaluator evaluate = name == "gltf"        ? Gltf(c)
                             : name == "pbrt"      ? Pbrt(c)
                             : name == "mitsuba"   ? Mitsuba(c)
                             : name == "materialx" ? MaterialX(c)
                                                   : OpenPbr(c);
  // The quadratures of two programs for the albedo of a lobe.
  const double tolerance = name == "materialx" || name == "openpbr" ? 2e-2 : 1e-5;
  const MapTarget& target = *FindMapTarget(name);
  const std::vector<Texture> textures = target.textures(*numbers_);
  RandomNumbers random(5);
  std::vector<double> off;
  std::size_t texels = 0;
  for (std::size_t t = 0; t < kSize * kSize && texels < 1000; t += 1 + (t % 3 == 0 ? 1 : 0)) {
    if (!numbers_->Inside(t)) continue;
    ++texels;
    const TexelNumbers texel = numbers_->At(t);
    std::vector<TextureValue> read;
    for (const Texture& texture : textures) read.push_back(Stored(texture, texel));
    Surface surface = target.surface(*numbers_, read);
    surface.albedo_side = 10;
    const BrdfFunction claimed = SurfaceBrdf(surface), fit = SurfaceBrdf(SurfaceOf(texel, c.calibrated));
    for (int pair = 0; pair < 2; ++pair) {
      const auto draw = [&] {
        while (true) {
          const double z = random.Uniform(0.1, 1), r = std::sqrt(1 - z * z), phi = random.Uniform(0, 2 * kPi);
          const Vec3 w = {r * std::cos(phi), r * std::sin(phi), z};
          if (Dot(w, texel.normal) > 0.1) return w;
        }
      };
      const Vec3 wi = draw(), wo = draw();
      double wanted[3], exact[3];
      claimed(wi, wo, wanted), fit(wi, wo, exact);
      const Rgb3 found = evaluate(t, wi, wo);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_NEAR(found[k], wanted[k], tolerance * (wanted[k] + 1e-4)) << "texel " << t << ", channel " << k;
        off.push_back(std::fabs(found[k] - exact[k]) / exact[k]);
      }
    }
  }
  EXPECT_EQ(texels, 1000U);
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
  const double median = off[off.size() / 2], reported = outcome_.results[0].error.uniform.median;
  std::printf("  median %.3g, reported %.3g\n", median, reported);
  EXPECT_LT(median, 1.5 * reported);
  EXPECT_GT(median, reported / 1.5);
}

TEST_F(ExportedMaps, TheMapsModelIsTheEngines) {
  // The oracle of the errors above is what the engine fits.
  for (const MapLobe lobe : {MapLobe::kGgx, MapLobe::kGgxAnisotropic}) {
    const Hills hills = MakeHills(kSize, lobe);
    const std::vector<Vec3> lights = DomeLights(20, 80 * kPi / 180);
    Relighting relighting(hills.maps, {lights, {}}, true, {});
    const MapNumbers numbers(hills.maps, true, kNan);
    for (std::size_t t = 0; t < kSize * kSize; t += 7) {
      std::vector<double> values(3 * lights.size());
      relighting.Texel(t, values.data(), lights.size());
      const BrdfFunction f_r = SurfaceBrdf(SurfaceOf(numbers.At(t), true));
      for (std::size_t l = 0; l < lights.size(); ++l) {
        double f[3];
        f_r(lights[l], {0, 0, 1}, f);
        for (std::size_t k = 0; k < 3; ++k) {
          EXPECT_NEAR(f[k] * lights[l].z, values[k * lights.size() + l], 1e-9) << t;
        }
      }
    }
  }
}

TEST_F(ExportedMaps, WhatIsNotDeterminedIsFilledAndCounted) {
  Export({"materialx", "sample.mtlx", MapLobe::kGgx, true});
  EXPECT_EQ(numbers_->filled().width, 20U);
  EXPECT_EQ(numbers_->filled().normal, 3U);
  EXPECT_EQ(numbers_->inside(), kSize * kSize - 10);
  ASSERT_FALSE(outcome_.remarks.empty());
  EXPECT_THAT(outcome_.remarks[0], testing::HasSubstr("the normal in 3 texels, the width in 20 texels"));
  EXPECT_THAT(outcome_.remarks[1], testing::HasSubstr("10 texels outside the mask are black"));
  // The filled width lies among those around.
  const double filled = numbers_->At(710).widths.alpha_1;
  EXPECT_GT(filled, 0.12);
  EXPECT_LT(filled, 0.4);
  EXPECT_EQ(numbers_->At(1005).diffuse, (Color3{0, 0, 0}));
  EXPECT_FALSE(numbers_->At(0).lobe);  // by evidence
}

TEST(RegionMedians, TakeTheSmallestBlockThatHoldsEnough) {
  constexpr std::size_t kWide = 64;
  std::vector<float> values(kWide * kWide, 5.0F);
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 16; ++x) values[y * kWide + x] = x < 8 ? NAN : 2.0F;
    for (std::size_t x = 16; x < 32; ++x) values[y * kWide + x] = NAN;
  }
  const std::vector<float> medians = RegionMedians(values, kWide, kWide);
  EXPECT_EQ(medians[0], 2.0F);   // of its own block
  EXPECT_EQ(medians[20], 5.0F);  // of the block of 32: 128 of 2, 512 of 5
  const std::vector<float> nothing = RegionMedians(std::vector<float>(100, NAN), 10, 10);
  EXPECT_TRUE(std::isnan(nothing[37]));
}

TEST_F(ExportedMaps, TargetsOfOneMaterialRefuse) {
  const Hills hills = MakeHills(8, MapLobe::kGgx);
  ExportOptions options;
  options.targets = {&FindTarget("merl"), &FindTarget("csv")};
  options.folder = folder_ / "out";
  options.name = "sample";
  EXPECT_THAT([&] { ExportMaps(hills.maps, {}, folder_ / "x", options, {}); },
              testing::ThrowsMessage<InputError>(
                  testing::HasSubstr("targets that can: pbrt, mitsuba, materialx, openpbr, gltf")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace lobefit

// Cameras that stand somewhere, ellipsoids over a normal that is held, and the lobe that both need.
#include "tests/maps/texels.h"
#include "tests/support/folder_test.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/maps/output/pixels.h"
#include "lobefit/maps/run.h"

namespace lobefit {
namespace {

// Cameras of their own, among them slanted ones.
LightPaths SomePaths(std::size_t count) {
  LightPaths paths = {DomeLights(count, 80 * (kPi / 180)), DomeLights(count, 60 * (kPi / 180))};
  std::reverse(paths.wo.begin(), paths.wo.end());
  return paths;
}

MapPoint SomePoint(MapLobe lobe) {
  MapPoint point;
  point.normal = Normalized(Vec3{0.3, -0.2, 0.9});
  point.width = {-1.3, lobe == MapLobe::kGgx ? 0.0 : 0.07, lobe == MapLobe::kGgx ? -1.3 : -1.9};
  if (lobe == MapLobe::kEllipsoid) point.slope = {0.25, -0.4};
  point.diffuse = {0.3, 0.1, 0.2}, point.f0 = {0.4, 0.5, 0.1};
  return point;
}

class SeenFromAnywhere : public testing::TestWithParam<MapLobe> {};
INSTANTIATE_TEST_SUITE_P(Lobes, SeenFromAnywhere,
                         testing::Values(MapLobe::kGgx, MapLobe::kGgxAnisotropic, MapLobe::kEllipsoid));

TEST_P(SeenFromAnywhere, AgreesWithCoreInTheTurnedFrame) {
  const MapPoint point = SomePoint(GetParam());
  const MapFrame frame = FrameOf(point.normal);
  const LightPaths paths = SomePaths(60);
  LightArrays lights;
  lights.Resize(paths.wi.size());
  lights.Set(paths, true);
  ShapeArrays shape;
  shape.Resize(lights.padded);
  EvaluateShape(GetParam(), point, lights, false, &shape);
  const SlopeCoordinates slopes = {{point.slope[0], point.slope[1], point.width[0], point.width[1], point.width[2]}};
  int below = 0, clamped = 0;
  for (std::size_t l = 0; l < paths.wi.size(); ++l) {
    const auto local = [&](const Vec3& w) { return Vec3{Dot(frame.t, w), Dot(frame.b, w), Dot(frame.n, w)}; };
    const Vec3 wi = local(paths.wi[l]), wo = local(paths.wo[l]);
    if (wi.z <= 0 || wo.z <= 0) {
      ++below;
      EXPECT_EQ(shape.specular[l], 0);
      continue;
    }
    double cos_d;
    const double expected = wi.z * GgxLobe(wi, wo, slopes, Masking::kSmithSeparable, &cos_d, nullptr);
    clamped += expected != wi.z * GgxLobe(wi, wo, slopes, Masking::kSmithUnclamped, &cos_d, nullptr) ? 1 : 0;
    EXPECT_NEAR(shape.specular[l], expected, 1e-12 * expected);
    EXPECT_NEAR(shape.cosine[l], wi.z, 1e-14);
    EXPECT_NEAR(lights.k[l], std::pow(1 - cos_d, 5), 1e-13);
  }
  EXPECT_GT(below, 0);
  EXPECT_EQ(clamped > 0, GetParam() == MapLobe::kEllipsoid);
}

TEST_P(SeenFromAnywhere, DerivativesAreThoseOfTheCost) {
  const MapModel model = {GetParam(), 3, true};
  const LightPaths paths = SomePaths(41);
  TexelData data;
  data.Resize(paths.wi.size());
  data.lights.Set(paths, true);
  RandomNumbers random(4);
  for (std::size_t l = 0; l < paths.wi.size(); ++l) {
    for (int c = 0; c < 3; ++c) data.value[c][l] = random.Uniform();
  }
  data.scale = 0.7;
  TexelObjective objective;
  objective.Resize(data.lights.padded);
  const MapPoint point = SomePoint(GetParam());
  const double loss = 0.4;
  MapVector gradient;
  MapMatrix hessian;
  objective.Derivatives(model, data, point, loss, Curvature::kWhole, &gradient, &hessian);
  const MapFrame frame = FrameOf(point.normal);
  for (int j = 0; j < model.Unknowns(); ++j) {
    const auto moved = [&](double step) {
      MapPoint p = point;
      if (j < 2 && model.TurnsNormal()) {
        p.normal = Normalized(point.normal + step * (j == 0 ? frame.t : frame.b));
      } else if (j < 2) {
        p.slope[static_cast<std::size_t>(j)] += step;
      } else if (j < model.Shape()) {
        p.width[static_cast<std::size_t>(j - 2)] += step;
      } else {
        const int at = j - model.Shape();
        (at % 2 == 0 ? p.diffuse : p.f0)[static_cast<std::size_t>(at / 2)] += step;
      }
      return objective.Cost(model, data, p, loss);
    };
    const double h = 2e-4;
    const double expected = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
    EXPECT_NEAR(gradient[static_cast<std::size_t>(j)], expected, 1e-9) << "unknown " << j;
  }
}

// What the recipe finds of a stack that WriteStack photographed.
class StackFits : public FolderTest {
 protected:
  Maps Fitted(const Stack& stack, MapRecipe recipe, int threads = 2) const {
    MapsOptions options;
    options.recipe = std::move(recipe);
    options.recipe.rules.schlick = stack.calibrated;
    options.folder = folder_, options.name = "fit", options.threads = threads;
    RunMaps(stack, options, "");
    return ReadMapsExr(folder_ / "fit.maps.exr");
  }
};

TEST_F(StackFits, ACameraAtAPositionSeesEachTexelFromItsOwnSide) {
  const Hills hills = MakeHills(20, MapLobe::kGgxAnisotropic, 0.6);
  StackSynthesis synthesis;
  synthesis.lights = DomeLights(128, 60 * (kPi / 180));
  synthesis.distance = 2, synthesis.camera_distance = 1.2, synthesis.bits = 32;
  WriteStack(hills.maps, synthesis, folder_ / "s");
  Stack stack = OpenStack(folder_ / "s", {});
  ASSERT_EQ(stack.cameras.size(), 1U);
  MapRecipe recipe;
  recipe.rules.lobe = MapLobe::kGgxAnisotropic;
  const Maps maps = Fitted(stack, recipe);
  for (std::size_t t = 0; t < 400; ++t) {
    EXPECT_LT(test::AngleBetween(test::NormalAt(maps, t), test::NormalAt(hills.maps, t)), 1e-6) << t;
    for (const char* name : {"alpha_x", "alpha_y", "f0.G", "diffuse.B"}) {
      const double truth = test::At(hills.maps, MapPart::kParameters, name, t);
      if (std::isnan(truth)) continue;
      EXPECT_NEAR(test::At(maps, MapPart::kParameters, name, t), truth, 3e-6) << name << t;
    }
  }
  // Taken as orthographic, the same photographs bend the normals.
  stack.cameras.clear();
  const Maps wrong = Fitted(stack, recipe);
  double worst = 0;
  for (std::size_t t = 0; t < 400; ++t) {
    const double off = test::AngleBetween(test::NormalAt(wrong, t), test::NormalAt(hills.maps, t));
    worst = std::isfinite(off) ? std::max(worst, off) : worst;
  }
  EXPECT_GT(worst, 1 * (kPi / 180));
}

// A capture as MaterialGAN's: a flash beside the camera, at nine places over a square of 20 cm.
class Capture : public StackFits {
 protected:
  static constexpr std::size_t kSide = 16;

  void Write(const nlohmann::json& json) const { WriteFileAtomically(folder_ / "c.json", json.dump()); }
  nlohmann::json Json() const {
    nlohmann::json places = nlohmann::json::array();
    for (int k = 0; k < 9; ++k) places.push_back({6.0 * (k % 3 - 1), 6.0 * (k / 3 - 1) + 0.5, 24.0 + (k % 2)});
    return {{"im_size", 20},        {"target_dir", "."},   {"idx", {0, 1, 2, 3, 4, 5, 6, 7, 8}},
            {"camera_pos", places}, {"light_pos", places}, {"light_pow", {1500, 1400, 1300}}};
  }
  void WriteImages(const std::vector<std::vector<double>>& radiance) const {
    for (std::size_t k = 0; k < radiance.size(); ++k) {
      std::vector<std::uint16_t> pixels;
      for (const double v : radiance[k]) {
        pixels.push_back(static_cast<std::uint16_t>(std::lround(255 * std::pow(std::min(v, 1.0), 1 / 2.2))));
      }
      WriteFileAtomically(folder_ / fmt::format("{:02}.png", k), EncodePixels(pixels, kSide, kSide, 3, 8));
    }
  }
  void ExpectRefused(const nlohmann::json& json, const std::string& words) const {
    Write(json);
    try {
      OpenStack(folder_ / "c.json", {});
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(words));
    }
  }
};

TEST_F(Capture, HasAbsoluteValuesAndAViewATexel) {
  // A matt square of albedo 0.5 in the plane: radiance = power albedo / pi cos / d^2, in cm.
  const nlohmann::json json = Json();
  std::vector<std::vector<double>> images;
  for (const nlohmann::json& at : json["light_pos"]) {
    std::vector<double> image;
    for (std::size_t t = 0; t < kSide * kSide; ++t) {
      const double x = ((static_cast<double>(t % kSide) + 0.5) / kSide - 0.5) * 20;
      const double y = (0.5 - (static_cast<double>(t / kSide) + 0.5) / kSide) * 20;
      const Vec3 beam = {at[0].get<double>() - x, at[1].get<double>() - y, at[2].get<double>()};
      const double square = Dot(beam, beam), cosine = beam.z / std::sqrt(square);
      for (int c = 0; c < 3; ++c) image.push_back((1500 - 100 * c) * 0.5 / kPi * cosine / square);
    }
    images.push_back(image);
  }
  WriteImages(images);
  Write(json);
  const Stack stack = OpenStack(folder_, {});
  EXPECT_EQ(stack.layout, "MaterialGAN capture");
  EXPECT_TRUE(stack.calibrated);
  ASSERT_EQ(stack.cameras.size(), 9U);
  EXPECT_EQ(stack.cameras[0].x, -60);
  // Without a lobe, which 8 bits of nine photographs speak for in some texels.
  MapRecipe recipe;
  recipe.rules.lobe = MapLobe::kNone;
  const Maps maps = Fitted(stack, recipe);
  for (std::size_t t = 0; t < kSide * kSide; ++t) {
    EXPECT_LT(test::AngleBetween(test::NormalAt(maps, t), {0, 0, 1}), 1 * (kPi / 180)) << t;
    for (const char* name : {"diffuse.R", "diffuse.G", "diffuse.B"}) {
      EXPECT_NEAR(test::At(maps, MapPart::kParameters, name, t), 0.5, 0.01) << name << t;
    }
  }
}

TEST_F(Capture, FaultsAreNamed) {
  WriteImages(std::vector<std::vector<double>>(9, std::vector<double>(3 * kSide * kSide, 0.2)));
  nlohmann::json json = Json();
  json.erase("light_pow");
  ExpectRefused(json, "'light_pow' is missing");
  json = Json(), json["light_pos"][3][2] = -4;
  ExpectRefused(json, "light 4 at z = -40 mm is not in front of the picture");
  json = Json(), json["camera_pos"][2] = {1, 2};
  ExpectRefused(json, "camera_pos[2] must be three finite numbers");
  json = Json(), json["camera_pos"].erase(0);
  ExpectRefused(json, "8 places of cameras, but 9 of lights");
  json = Json(), json["im_size"] = "20";
  ExpectRefused(json, "im_size must be a positive number");
  json = Json(), json["idx"] = {0, 1};
  ExpectRefused(json, "2 numbers in idx, but 9 places of lights");
  json = Json(), json["light_pow"] = {1, 0, 1};
  ExpectRefused(json, "light_pow must be positive");
  json = Json(), json["idx"][8] = 9;
  ExpectRefused(json, "09.png: cannot be opened");
}

TEST_F(StackFits, CamerasThatStandNowhereAreRefused) {
  StackSynthesis synthesis;
  synthesis.lights = DomeLights(8, 60 * (kPi / 180));
  WriteStack(MakeHills(8, MapLobe::kGgx).maps, synthesis, folder_ / "s");
  const std::string manifest(FileBytes(folder_ / "s/stack.toml").bytes());
  const auto refused = [&](const std::string& more, const std::string& words) {
    WriteFileAtomically(folder_ / "s/stack.toml", manifest + more);
    try {
      OpenStack(folder_ / "s", {});
      ADD_FAILURE() << more;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(words)) << more;
    }
  };
  const std::string plane = "[plane]\nwidth_mm = 100\n";
  refused("[camera]\nposition = [0, 0, 500]\n", "cameras at a position need [plane] with width_mm");
  refused("[camera]\nposition = [0, 0]\n" + plane, "position must be three numbers, mm");
  refused("[camera]\nposition = [0, 0, -1]\n" + plane, "camera 1 at z = -1 mm is not in front of the picture");
  refused("[camera]\nplace = [0, 0, 1]\n" + plane, "unknown key 'place' in [camera]");
  refused("[camera]\nkind = \"position\"\n" + plane, "needs position = [x, y, z] or file");
  refused("[camera]\nkind = \"orthographic\"\nposition = [0, 0, 9]\n" + plane,
          "an orthographic camera has no position");
  WriteFileAtomically(folder_ / "s/c.txt", "0 0 500\n0 0 500\n");
  refused("[camera]\nfile = \"c.txt\"\n" + plane, "2 places of cameras for 8 images");
}

TEST(TexelFitter, EllipsoidsOverAHeldNormalAreRecovered) {
  LightPaths paths = {DomeLights(96, 65 * (kPi / 180)), {}};
  TexelFit truth;
  truth.normal = Normalized(Vec3{0.2, -0.1, 1});
  truth.alpha_x = 0.3, truth.alpha_y = 0.15, truth.angle = 0.4, truth.tilt[0] = 0.12, truth.tilt[1] = -0.2;
  for (int c = 0; c < 3; ++c) truth.diffuse[c] = 0.1 + 0.1 * c, truth.f0[c] = 0.3 - 0.05 * c;
  const MapKind kind = {MapLobe::kEllipsoid, 3};
  Maps maps;
  maps.lobe = kind.lobe, maps.channels = 3, maps.planes = PlanesFor(kind), maps.rows = {0, 1, 1, {}};
  std::vector<float> numbers(maps.planes.size());
  Fill(truth, kind, numbers.data());
  for (const float number : numbers) maps.rows.values.push_back({number});
  Relighting relighting(maps, paths, true, {});
  std::vector<double> exact(3 * 96);
  relighting.Texel(0, exact.data(), 96);
  const std::vector<float> values(exact.begin(), exact.end());
  MapRules rules;
  rules.lobe = MapLobe::kEllipsoid, rules.schlick = true, rules.normal_free = false;
  TexelFitter fitter(rules, paths, 3);
  HeldNumbers held;
  held.normal = true, held.point.normal = truth.normal;
  const TexelFit fit = fitter.Fit(values.data(), 96, held);
  EXPECT_EQ(fit.status, 0U);
  EXPECT_NEAR(fit.alpha_x, truth.alpha_x, 1e-5);
  EXPECT_NEAR(fit.alpha_y, truth.alpha_y, 1e-5);
  EXPECT_NEAR(fit.angle, truth.angle, 1e-5);
  for (int k = 0; k < 2; ++k) {
    EXPECT_NEAR(fit.tilt[k], truth.tilt[k], 1e-5) << k;
    EXPECT_LT(fit.tilt_error[k], 1e-3) << k;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(fit.f0[c], truth.f0[c], 1e-5) << c;
  EXPECT_NEAR(fit.normal.x, truth.normal.x, 1e-9);
  EXPECT_TRUE(std::isnan(fit.normal_angle_error));
}

}  // namespace
}  // namespace lobefit

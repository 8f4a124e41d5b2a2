// Numbers that texels share, clusters of texels, and maps of normals.
#include "tests/maps/texels.h"
#include "tests/support/folder_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/maps/output/pixels.h"
#include "lobefit/maps/run.h"
#include "lobefit/maps/stack/normal_map.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

// Hills of three materials in columns, each of one albedo, f0 and width.
constexpr std::size_t kSide = 36;
struct Material {
  double diffuse[3], f0, alpha;
};
constexpr Material kMaterials[3] = {
    {{0.5, 0.1, 0.1}, 0.05, 0.3}, {{0.1, 0.4, 0.1}, 0.2, 0.15}, {{0.1, 0.1, 0.5}, 0.1, 0.2}};

// Half of the texels are of the first, a third of the second.
std::size_t MaterialOf(std::size_t texel) {
  const std::size_t x = texel % kSide;
  return 2 * x < kSide ? 0 : 6 * x < 5 * kSide ? 1 : 2;
}

class SharedNumbersTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    hills_ = MakeHills(kSide, MapLobe::kGgx, 0.5);
    Maps& maps = hills_.maps;
    const auto set = [&](const char* name, std::size_t t, double value) {
      maps.rows.values[PlaneIndex(maps.planes, MapPart::kParameters, name)][t] = static_cast<float>(value);
    };
    for (std::size_t t = 0; t < kSide * kSide; ++t) {
      const Material& m = kMaterials[MaterialOf(t)];
      set("diffuse.R", t, m.diffuse[0]), set("diffuse.G", t, m.diffuse[1]), set("diffuse.B", t, m.diffuse[2]);
      for (const char* f0 : {"f0.R", "f0.G", "f0.B"}) set(f0, t, m.f0);
      set("alpha", t, m.alpha);
      maps.rows.values.back()[t] = 0;
    }
    StackSynthesis synthesis;
    synthesis.lights = DomeLights(48, 65 * kPi / 180);
    synthesis.noise.multiplicative = 0.03, synthesis.noise.additive = 0.002;
    WriteStack(maps, synthesis, folder_ / "s");
    stack_ = OpenStack(folder_ / "s", {});
  }

  MapRecipe RecipeOf(const std::string& text) const {
    WriteFileAtomically(folder_ / "r.toml", text);
    MapRecipe recipe = ReadMapRecipe(folder_ / "r.toml");
    recipe.rules.schlick = true;
    return recipe;
  }
  MapsResult Run(const MapRecipe& recipe, int threads) const {
    MapsOptions options;
    options.recipe = recipe, options.folder = folder_, options.threads = threads, options.name = "fit";
    return RunMaps(stack_, options, "");
  }
  std::string Bytes() const { return std::string(FileBytes(folder_ / "fit.maps.exr").bytes()); }
  void ExpectRefused(const std::string& recipe, const std::string& words) const {
    try {
      RecipeOf(recipe);
      ADD_FAILURE() << recipe;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(words)) << recipe;
    }
  }

  Hills hills_;
  Stack stack_;
};

TEST_F(SharedNumbersTest, ClustersAreTheMaterialsAndHoldTheirNumbers) {
  const MapRecipe recipe = RecipeOf("[share]\nalpha = \"cluster:3\"\nf0 = \"cluster:3\"\n");
  const MapsResult result = Run(recipe, 1);
  const std::string one = Bytes();
  ASSERT_EQ(result.shared.groups.size(), 3U);
  for (std::size_t g = 0; g < 3; ++g) {
    const SharedNumbers::Group& group = result.shared.groups[g];
    const double off = group.held.point.width[0] - std::log(kMaterials[g].alpha);
    EXPECT_LT(std::fabs(off), 4 * group.error[2]) << g;
    EXPECT_LT(group.error[2], 0.03) << g;
    const int f0 = MapModel{MapLobe::kGgx, 3, true}.F0At(1);
    EXPECT_NEAR(group.held.point.f0[1], kMaterials[g].f0, 4 * group.error[static_cast<std::size_t>(f0)]) << g;
  }
  const Maps maps = ReadMapsExr(folder_ / "fit.maps.exr");
  std::size_t right = 0;
  for (std::size_t t = 0; t < kSide * kSide; ++t) {
    right += test::At(maps, MapPart::kQuality, "cluster", t) == static_cast<double>(MaterialOf(t) + 1) ? 1 : 0;
  }
  EXPECT_GT(right, kSide * kSide * 99 / 100);
  Run(recipe, 3);
  EXPECT_EQ(Bytes(), one);
}

TEST_F(SharedNumbersTest, WhatIsSharedIsReadBackToTheBit) {
  const SharedNumbers shared = Run(RecipeOf("[share]\nalpha = \"cluster:2\"\ndiffuse = \"image\"\n"), 2).shared;
  WriteShared(shared, folder_ / "shared");
  const std::optional<SharedNumbers> read = ReadShared(folder_ / "shared");
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->clusters.centers, shared.clusters.centers);
  ASSERT_EQ(read->groups.size(), 2U);
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_EQ(read->groups[g].held.point.width, shared.groups[g].held.point.width);
    EXPECT_EQ(read->groups[g].held.point.diffuse, shared.groups[g].held.point.diffuse);
    EXPECT_EQ(read->groups[g].held.diffuse, true);
    EXPECT_EQ(read->groups[g].held.f0, false);
  }
  // Of the image: the same in both.
  EXPECT_EQ(shared.groups[0].held.point.diffuse, shared.groups[1].held.point.diffuse);
  WriteFileAtomically(folder_ / "shared", std::string(FileBytes(folder_ / "shared").bytes()).substr(0, 300));
  EXPECT_FALSE(ReadShared(folder_ / "shared").has_value());
}

TEST_F(SharedNumbersTest, NormalsOfAPictureAreHeld) {
  const Maps& truth = hills_.maps;
  for (const bool down : {false, true}) {
    std::vector<std::uint16_t> pixels;
    for (std::size_t t = 0; t < kSide * kSide; ++t) {
      const Vec3 n = test::NormalAt(truth, t);
      for (const double v : {n.x, down ? -n.y : n.y, n.z}) {
        pixels.push_back(static_cast<std::uint16_t>(std::lround((v + 1) / 2 * 65535)));
      }
    }
    pixels[3 * 7] = pixels[3 * 7 + 1] = pixels[3 * 7 + 2] = 32767;  // no normal
    WriteFileAtomically(folder_ / "n.png", EncodePixels(pixels, kSide, kSide, 3, 16));
    MapRecipe recipe = RecipeOf("model = \"ellipsoid\"\nnormal = \"map:n.png\"\n");
    EXPECT_EQ(recipe.normal_map, folder_ / "n.png");
    SetNormalMap(recipe.normal_map, down, &stack_);
    Run(recipe, 2);
    const Maps maps = ReadMapsExr(folder_ / "fit.maps.exr");
    EXPECT_EQ(maps.lobe, MapLobe::kEllipsoid);
    double tilt = 0, known = 0;
    for (std::size_t t = 0; t < kSide * kSide; ++t) {
      if (t == 7) continue;
      EXPECT_LT(test::AngleBetween(test::NormalAt(maps, t), test::NormalAt(truth, t)), 1e-4) << t;
      const double y = test::At(maps, MapPart::kParameters, "tilt_y_deg", t);
      if (!std::isnan(y)) tilt += std::fabs(y), ++known;
    }
    // The truth's lobes stand upright.
    EXPECT_GT(known, 500);
    EXPECT_LT(tilt / known, 1.5);
    EXPECT_EQ(test::At(maps, MapPart::kQuality, "status", 7), kMapTooFew | kMapNotDetermined);
  }
}

TEST_F(SharedNumbersTest, MapsOfNormalsThatAreNoneAreRefused) {
  const auto refused = [&](std::size_t width, int channels, int bits, const std::string& words) {
    const std::vector<std::uint16_t> pixels(width * kSide * static_cast<std::size_t>(channels), 100);
    WriteFileAtomically(folder_ / "n.png", EncodePixels(pixels, width, kSide, channels, bits));
    try {
      SetNormalMap(folder_ / "n.png", false, &stack_);
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  };
  refused(kSide + 1, 3, 16, "the map of normals is 37 x 36 pixels, the images are 36 x 36");
  refused(kSide, 1, 16, "this one is gray");
  refused(kSide, 3, 8, "normals in 8 bits a channel are rounded");
}

TEST_F(SharedNumbersTest, SharesThatContradictThemselvesAreRefused) {
  ExpectRefused("[share]\nalpha = \"cluster:0\"\n",
                "r.toml:2: 'alpha' must be texel, image or cluster:N with N from 1");
  ExpectRefused("[share]\nalpha = \"clusters:4\"\n", "'alpha' must be texel, image or cluster:N");
  ExpectRefused("[share]\nalpha = \"cluster:4\"\nf0 = \"cluster:5\"\n", "must name the same N");
  ExpectRefused("[share]\nwidth = \"image\"\n", "unknown key 'width' in [share]");
  ExpectRefused("[share]\ntilt = \"image\"\n", "only model = \"ellipsoid\" has a tilt");
  ExpectRefused("model = \"lambert\"\n[share]\nalpha = \"image\"\n", "has no alpha");
  ExpectRefused("normal = \"fixed\"\n[share]\nnormal = \"image\"\n", "is not shared");
  ExpectRefused("share = \"image\"\n", "'share' must be a table");
  ExpectRefused("normal = \"map:\"\n", "'normal' must be one of free, fixed, map:FILE");
  ExpectRefused("model = \"ellipsoid\"\n", "the tilt of an ellipsoid and a free normal say the same");
}

}  // namespace
}  // namespace lobefit

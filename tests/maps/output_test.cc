// Maps as they are named, filled, written and read back; textures as they are stored.
#include <cmath>
#include <random>
#include <set>

#include "tests/support/folder_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/maps/output/exr.h"
#include "lobefit/maps/textures/texture.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// A fit whose every number is its own.
TexelFit Numbered() {
  TexelFit fit;
  fit.normal = {0.1, 0.2, 0.97};
  fit.normal_error = {0.01, 0.02, 0.03};
  fit.normal_angle_error = 0.04, fit.normal_doubt = 0.05;
  for (int c = 0; c < 3; ++c) {
    fit.diffuse[c] = 1 + c, fit.diffuse_error[c] = 0.1 * (1 + c);
    fit.f0[c] = 10 + c, fit.f0_error[c] = 0.1 * (10 + c);
  }
  fit.alpha_x = 0.5, fit.alpha_y = 0.25, fit.angle = 0.6;
  fit.log_alpha_x_error = 0.05, fit.log_alpha_y_error = 0.025, fit.angle_error = 0.06;
  fit.tilt[0] = 0.7, fit.tilt[1] = 0.8, fit.tilt_error[0] = 0.07, fit.tilt_error[1] = 0.08;
  fit.rms = 0.9, fit.scale = 3, fit.used = 40, fit.cluster = 2, fit.status = 5;
  return fit;
}

TEST(Planes, HoldWhatTheirNamesSay) {
  const double deg = 180 / kPi;
  const TexelFit fit = Numbered();
  for (const MapLobe lobe : {MapLobe::kNone, MapLobe::kGgx, MapLobe::kGgxAnisotropic, MapLobe::kEllipsoid}) {
    for (const int channels : {1, 3}) {
      for (const bool more : {false, true}) {
        const MapKind kind = {lobe, channels, more, more};
        const std::vector<MapPlane> planes = PlanesFor(kind);
        std::vector<float> values(planes.size() + 1, -7);
        Fill(fit, kind, values.data());
        EXPECT_EQ(values.back(), -7) << "writes no further than its planes";
        std::set<std::string> names;
        for (const MapPlane& plane : planes) names.insert(PartName(plane.part) + std::string("/") + plane.name);
        EXPECT_EQ(names.size(), planes.size()) << "two planes of one name";
        EXPECT_EQ(planes.back().name, "status");
        const auto is = [&](MapPart part, const char* name, double value) {
          const std::size_t at = PlaneIndex(planes, part, name);
          ASSERT_LT(at, planes.size()) << name;
          EXPECT_FLOAT_EQ(values[at], static_cast<float>(value)) << name;
        };
        const auto none = [&](MapPart part, const char* name) {
          EXPECT_EQ(PlaneIndex(planes, part, name), planes.size()) << name;
        };
        constexpr MapPart kP = MapPart::kParameters, kE = MapPart::kErrors, kQ = MapPart::kQuality;
        is(kP, "normal.z", 0.97), is(kE, "normal.y", 0.02), is(kE, "normal.angle_deg", 0.04 * deg);
        is(kP, channels == 1 ? "diffuse.Y" : "diffuse.B", channels);
        is(kE, channels == 1 ? "diffuse.Y" : "diffuse.G", channels == 1 ? 0.1 : 0.2);
        is(kQ, "rms", 0.9), is(kQ, "scale", 3), is(kQ, "used", 40), is(kQ, "status", 5);
        more ? is(kQ, "cluster", 2) : none(kQ, "cluster");
        more ? is(kQ, "normal.doubt_deg", 0.05 * deg) : none(kQ, "normal.doubt_deg");
        if (lobe == MapLobe::kNone) {
          none(kP, "f0.R"), none(kP, "alpha"), none(kP, "alpha_x");
          continue;
        }
        is(kP, channels == 1 ? "f0.Y" : "f0.G", channels == 1 ? 10 : 11);
        is(kP, WidestAlpha(lobe), 0.5);
        is(kE, lobe == MapLobe::kGgx ? "ln_alpha" : "ln_alpha_x", 0.05);
        if (lobe == MapLobe::kGgx) continue;
        is(kP, "alpha_y", 0.25), is(kE, "ln_alpha_y", 0.025);
        is(kP, "angle_deg", 0.6 * deg), is(kE, "angle_deg", 0.06 * deg);
        if (lobe != MapLobe::kEllipsoid) {
          none(kP, "tilt_x_deg");
          continue;
        }
        is(kP, "tilt_x_deg", 0.7 * deg), is(kP, "tilt_y_deg", 0.8 * deg), is(kE, "tilt_y_deg", 0.08 * deg);
      }
    }
  }
}

class MapsExr : public FolderTest {};

// Tiles of 64: sizes below, at and above, with NaN where nothing is known.
TEST_F(MapsExr, EveryPixelComesBack) {
  const std::vector<MapPlane> planes = PlanesFor({MapLobe::kGgxAnisotropic, 3, true, true});
  for (const auto& size : {std::pair<std::size_t, std::size_t>{1, 1}, {64, 64}, {65, 3}, {3, 130}}) {
    const std::size_t width = size.first, height = size.second;
    std::mt19937 engine(9);
    MapRows all = {0, height, width, std::vector<std::vector<float>>(planes.size())};
    for (std::size_t p = 0; p < planes.size(); ++p) {
      for (std::size_t i = 0; i < width * height; ++i) {
        const double value = std::uniform_real_distribution<double>(-2, 2)(engine);
        all.values[p].push_back(planes[p].type == MapType::kCount ? static_cast<float>(engine() % 1000)
                                : i % 7 == 3                      ? std::nanf("")
                                                                  : static_cast<float>(value));
      }
    }
    std::size_t asked = 0;
    const auto source = [&](std::size_t first, std::size_t end) {
      asked += end - first;
      MapRows rows = {first, end - first, width, {}};
      for (const std::vector<float>& plane : all.values) {
        rows.values.emplace_back(plane.begin() + static_cast<std::ptrdiff_t>(first * width),
                                 plane.begin() + static_cast<std::ptrdiff_t>(end * width));
      }
      return rows;
    };
    const std::filesystem::path path = folder_ / "a.maps.exr";
    WriteMapsExr(planes, width, height, source, path);
    EXPECT_EQ(asked, height) << "each row once";
    EXPECT_EQ(Files(), std::vector<std::string>{"a.maps.exr"}) << "nothing beside it";
    EXPECT_TRUE(IsMapsExr(path));
    const Maps maps = ReadMapsExr(path);
    EXPECT_EQ(maps.lobe, MapLobe::kGgxAnisotropic);
    EXPECT_EQ(maps.channels, 3);
    ASSERT_EQ(maps.planes.size(), planes.size());
    ASSERT_TRUE(maps.rows.width == width && maps.rows.rows == height);
    for (std::size_t p = 0; p < planes.size(); ++p) {
      EXPECT_TRUE(maps.planes[p].name == planes[p].name && maps.planes[p].part == planes[p].part);
      const float step = planes[p].type == MapType::kHalf ? 1.0F / 2048 : 0;  // of half floats, relative
      for (std::size_t i = 0; i < width * height; ++i) {
        const float expected = all.values[p][i], found = maps.rows.values[p][i];
        ASSERT_TRUE(std::isnan(expected) ? std::isnan(found)
                                         : std::fabs(found - expected) <= step * std::fabs(expected) + step / 4096)
            << planes[p].name << " " << i << ": " << found << " instead of " << expected;
      }
    }
    const Maps some = ReadMapsExr(path, [](const MapPlane& plane) { return plane.name == "status"; });
    EXPECT_EQ(some.rows.values.back(), all.values.back());
    EXPECT_TRUE(some.rows.values.front().empty());
  }
}

TEST_F(MapsExr, OtherFilesAreRefusedByName) {
  Write("a.exr", "no image");
  EXPECT_FALSE(IsMapsExr(folder_ / "a.exr"));
  EXPECT_FALSE(IsMapsExr(folder_ / "not there.exr"));
  EXPECT_THAT([&] { ReadMapsExr(folder_ / "a.exr"); }, ThrowsMessage<InputError>(HasSubstr("a.exr")));
  const auto one = [](std::size_t first, std::size_t end) {
    return MapRows{first, end - first, 1, std::vector<std::vector<float>>(8, std::vector<float>(end - first, 1.0F))};
  };
  const std::vector<MapPlane> planes = PlanesFor({MapLobe::kNone, 1, false, false});
  ASSERT_GE(planes.size(), 8U);
  const auto all = [&](std::size_t first, std::size_t end) {
    MapRows rows = one(first, end);
    rows.values.resize(planes.size(), rows.values[0]);
    return rows;
  };
  WriteMapsExr(planes, 1, 1, all, folder_ / "b.maps.exr");
  const std::string whole = Read("b.maps.exr");
  for (const std::size_t end : {whole.size() - 1, whole.size() / 2, whole.size() / 5, std::size_t{10}}) {
    Write("cut.maps.exr", whole.substr(0, end));
    EXPECT_THROW(ReadMapsExr(folder_ / "cut.maps.exr"), InputError) << end << " of " << whole.size();
  }
}

TEST(Textures, NormalsAndRotationsComeBack) {
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  for (const bool down : {false, true}) {
    const Texture texture = NormalTexture(down);
    for (int k = 0; k < 200; ++k) {
      TexelNumbers numbers;
      numbers.normal = Normalized(Vec3{normal(engine), normal(engine), std::fabs(normal(engine))});
      const Vec3 read = NormalOf(Stored(texture, numbers));
      const Vec3 expected = {numbers.normal.x, down ? -numbers.normal.y : numbers.normal.y, numbers.normal.z};
      EXPECT_NEAR(Norm(read - expected), 0, 4e-5) << "sixteen bits";
    }
  }
  for (double rotation = -3.1; rotation < 3.1; rotation += 0.07)
    EXPECT_NEAR(RotationOf(DirectionValue(rotation, 0.3)), rotation, 1e-12);
}

// Codes of 8 and 16 bits are the nearest ones, on the sRGB curve too; what is beyond the range is cut, alpha is linear.
TEST(Textures, AreStoredToHalfAStep) {
  for (const int bits : {8, 16}) {
    for (const bool srgb : {false, true}) {
      const double step = 1.0 / ((1 << bits) - 1);
      for (double v = -0.2; v <= 1.2; v += 0.013) {
        Texture texture = {"_t.png", 4, bits, srgb, [v](const TexelNumbers&) { return TextureValue{v, v, v, v}; }};
        const TextureValue read = Stored(texture, {});
        const double inside = std::fmin(std::fmax(v, 0), 1);
        EXPECT_NEAR(read[3], inside, 0.5 * step * (1 + 1e-9)) << "alpha";
        const auto encoded = [&](double l) {
          return !srgb ? l : l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
        };
        EXPECT_NEAR(encoded(read[0]), encoded(inside), 0.5 * step * (1 + 1e-3)) << v << " in " << bits;
        EXPECT_EQ(read[0], read[2]);
      }
    }
  }
  const Texture floats = {"_t.exr", 1, 32, false, [](const TexelNumbers&) { return TextureValue{7.25}; }};
  EXPECT_EQ(Stored(floats, {})[0], 7.25) << "floating point is not cut";
}

}  // namespace
}  // namespace lobefit

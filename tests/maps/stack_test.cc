#include <cmath>

#include "tests/support/folder_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/maps/output/pixels.h"
#include "lobefit/maps/stack/reader.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

class StackReading : public FolderTest {
 protected:
  // Images of 3 x 2 pixels, gray or RGB; pixel p of image i is 100 i + p (8 bits) or that times 256.
  void WriteImages(int count, int bits, int channels = 3, std::size_t width = 3) const {
    for (int i = 0; i < count; ++i) {
      std::vector<std::uint16_t> pixels;
      for (std::size_t p = 0; p < width * 2 * static_cast<std::size_t>(channels); ++p) {
        pixels.push_back(static_cast<std::uint16_t>((20 * i + static_cast<int>(p)) * (bits == 16 ? 256 : 1)));
      }
      Write("im " + std::to_string(i) + ".png", EncodePixels(pixels, width, 2, channels, bits));
    }
  }
  void WriteLights(int count, double z = 0.8) const {
    std::string lp = std::to_string(count) + "\r\n";
    for (int i = 0; i < count; ++i) {
      lp += "im " + std::to_string(i) + ".png 0.6 " + std::to_string(0.1 * i) + " " + std::to_string(z) + "\r\n";
    }
    Write("a.lp", lp);
  }
  void ExpectRefused(const std::string& words, const StackOptions& options = {}) const {
    EXPECT_THAT([&] { OpenStack(folder_, options); }, ThrowsMessage<InputError>(HasSubstr(words)));
  }
};

TEST_F(StackReading, LightFileWithBlanksInNames) {
  WriteImages(5, 16);
  WriteLights(5);
  const Stack stack = OpenStack(folder_, {});
  EXPECT_EQ(stack.layout, "RTI light file");
  EXPECT_EQ(stack.images.size(), 5U);
  EXPECT_EQ(stack.width, 3U);
  EXPECT_EQ(stack.height, 2U);
  EXPECT_EQ(stack.channels, 3U);
  EXPECT_NEAR(Norm(stack.lights[4].direction), 1, 1e-15);
  EXPECT_NEAR(stack.lights[4].direction.y / stack.lights[4].direction.x, 0.4 / 0.6, 1e-12);
}

TEST_F(StackReading, ValuesComeInTheirPlaces) {
  WriteImages(4, 16);
  WriteLights(4);
  Stack stack = OpenStack(folder_, {});
  stack.lights[2].intensity = {1, 2, 4};
  StackReader reader(stack);
  const StackBand band = reader.Read(1, 1);  // the first row is passed over
  for (std::size_t x = 0; x < 3; ++x) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t l = 0; l < 4; ++l) {
        const double stored =
            (20.0 * static_cast<double>(l) + 9 + 3 * static_cast<double>(x) + static_cast<double>(c)) * 256 / 65535;
        EXPECT_NEAR(band.values[(x * 3 + c) * 4 + l], stored / (l == 2 ? std::exp2(c) : 1), 1e-7);
      }
    }
  }
}

TEST_F(StackReading, EightBitsNeedAnEncoding) {
  WriteImages(4, 8);
  WriteLights(4);
  ExpectRefused("8 bits a channel, whose encoding is not said; say --encoding srgb");
  ExpectRefused("encoding 'rec709' is unknown", {"rec709"});
  const Stack stack = OpenStack(folder_, {"srgb"});
  StackReader reader(stack);
  const double stored = (20 + 5) / 255.0;
  EXPECT_NEAR(reader.Read(0, 1).values[(1 * 3 + 2) * 4 + 1], std::pow((stored + 0.055) / 1.055, 2.4), 1e-6);
}

TEST_F(StackReading, SaturatedPixelsAreInfinite) {
  WriteImages(4, 8);
  WriteLights(4);
  Stack stack = OpenStack(folder_, {"linear"});
  stack.response.saturation = 60.0 / 255;
  StackReader reader(stack);
  const StackBand band = reader.Read(0, 1);
  EXPECT_TRUE(std::isinf(band.values[3]));   // image 3: 60
  EXPECT_FALSE(std::isinf(band.values[2]));  // image 2: 40
}

TEST_F(StackReading, RefusesWhatDoesNotFit) {
  WriteImages(5, 16);
  WriteLights(5);
  Write("a.lp", "5\nim 0.png 0 0 1\n");
  ExpectRefused("a.lp: the first line promises 5 lights, 1 follow");
  Write("a.lp", "im 0.png 0 0 1\n");
  ExpectRefused("a.lp:1: 'im 0.png 0 0 1' is no number of lights");
  Write("a.lp", "1\nim 0.png 0 one 1\n");
  ExpectRefused("a.lp:2: 'im 0.png 0 one 1' is not FILE x y z");
  Write("a.lp", "1\nim 0.png 0 0 0\n");
  ExpectRefused("a.lp:2: (0, 0, 0) is no direction");
  Write("a.lp", "1\nim 0.png 0 nan 1\n");
  ExpectRefused("is no direction");
  WriteLights(6);
  ExpectRefused("im 5.png: cannot be opened");
  WriteLights(5, -0.8);
  ExpectRefused("5 of 5 lights are behind the surface (z <= 0); z must point to the camera");
  WriteLights(3);
  ExpectRefused("3 images; 4 to 4096 are expected");
  WriteLights(5);
  Write("im 2.png", "no picture");
  ExpectRefused("im 2.png: neither PNG, JPEG, TIFF nor OpenEXR");
  Write("im 2.png", EncodePixels(std::vector<std::uint16_t>(12), 2, 2, 3, 16));
  ExpectRefused("im 2.png: 2 x 2 pixels, 3 channels, but");
}

TEST_F(StackReading, ABrokenImageIsNamed) {
  WriteImages(4, 16);
  WriteLights(4);
  const std::string whole = Read("im 3.png");
  Write("im 3.png", whole.substr(0, whole.size() - 30));
  const Stack stack = OpenStack(folder_, {});
  StackReader reader(stack);
  EXPECT_THAT([&] { reader.Read(0, 2); }, ThrowsMessage<InputError>(HasSubstr("im 3.png: broken PNG")));
}

TEST_F(StackReading, DiligentFolder) {
  WriteImages(4, 16);
  Write("filenames.txt", "im 0.png\nim 1.png\nim 2.png\nim 3.png\n");
  Write("light_directions.txt", "0 0 1\n0 0.6 0.8\n0.6 0 0.8\n-0.6 0 0.8\n");
  Write("light_intensities.txt", "1 1 1\n2 2 2\n1 1 1\n1 1 1\n");
  Write("mask.png", EncodePixels({0, 255, 255, 255, 0, 0}, 3, 2, 1, 8));
  const Stack stack = OpenStack(folder_, {});
  EXPECT_EQ(stack.layout, "DiLiGenT folder");
  EXPECT_EQ(stack.Texels(), 3U);
  EXPECT_EQ(stack.lights[1].intensity[2], 2);
  EXPECT_EQ(stack.lights[1].direction.y, 0.6);
  // As three rows of numbers.
  Write("light_directions.txt", "0 0 0.6 -0.6\n0 0.6 0 0\n1 0.8 0.8 0.8\n");
  EXPECT_EQ(OpenStack(folder_, {}).lights[1].direction.y, 0.6);
  Write("light_intensities.txt", "1 1 1\n2 2 2\n1 1 1\n");
  ExpectRefused("3 intensities, but 4 lights");
  Write("light_intensities.txt", "1 1 1\n2 2 2\n1 1 1\n0 1 1\n");
  ExpectRefused("light 4: intensity 0 is not positive");
  Write("light_directions.txt", "0 0 1\n0 0.6 0.8\n0.6 0 0.8\n");
  ExpectRefused("3 lights, but 4 images");
  Write("light_directions.txt", "0 0 1\n0 0.6 x\n0.6 0 0.8\n");
  ExpectRefused("light_directions.txt:2: 'x' is no finite number");
}

TEST_F(StackReading, MaskOfAnotherSizeOrEmpty) {
  WriteImages(4, 16);
  WriteLights(4);
  Write("stack.toml", "mask = \"m.png\"\n[lights]\nfile = \"a.lp\"\n");
  Write("m.png", EncodePixels({0, 255}, 2, 1, 1, 8));
  ExpectRefused("m.png: the mask is 2 x 1 pixels, the images are 3 x 2");
  Write("m.png", EncodePixels(std::vector<std::uint16_t>(6), 3, 2, 1, 8));
  ExpectRefused("the mask leaves no texel");
}

TEST_F(StackReading, DarkAndWhiteFieldsAreTakenOut) {
  // Pixel of image i: dark + white_i (i + 1) / 10, where the board of albedo 0.8 reflects white_i.
  std::string lp = "4\n";
  for (int i = 0; i < 4; ++i) {
    std::vector<std::uint16_t> image, board;
    for (int p = 0; p < 6; ++p) {
      const int white = 20000 + 1000 * i + 500 * p;
      board.push_back(static_cast<std::uint16_t>(1000 + white));
      image.push_back(static_cast<std::uint16_t>(1000 + white * (i + 1) / 10));
    }
    Write("im" + std::to_string(i) + ".png", EncodePixels(image, 3, 2, 1, 16));
    Write("w" + std::to_string(i) + ".png", EncodePixels(board, 3, 2, 1, 16));
    lp += "im" + std::to_string(i) + ".png 0.6 0 0.8\n";
  }
  Write("dark.png", EncodePixels(std::vector<std::uint16_t>(6, 1000), 3, 2, 1, 16));
  Write("a.lp", lp);
  const std::string lights = "[lights]\nfile = \"a.lp\"\n";
  Write("stack.toml", "dark = \"dark.png\"\nwhite = \"w*.png\"\nwhite_albedo = 0.8\nencoding = \"linear\"\n" + lights);
  const Stack stack = OpenStack(folder_, {});
  EXPECT_TRUE(stack.calibrated);
  StackReader reader(stack);
  const StackBand band = reader.Read(1, 1);
  for (std::size_t x = 0; x < 3; ++x) {
    for (std::size_t l = 0; l < 4; ++l) {
      EXPECT_NEAR(band.values[x * 4 + l], 0.8 * kInvPi * 0.8 * static_cast<double>(l + 1) / 10, 1e-5);
    }
  }
  const std::string digest = DigestOf(stack);
  Write("dark.png", EncodePixels(std::vector<std::uint16_t>(6, 900), 3, 2, 1, 16));
  EXPECT_NE(DigestOf(OpenStack(folder_, {})), digest);
  Write("dark.png", EncodePixels(std::vector<std::uint16_t>(4, 900), 2, 2, 1, 16));
  ExpectRefused("dark.png: 2 x 2 pixels, 1 channels");
  Write("stack.toml", "white = \"w0.png\"\n" + lights);
  ExpectRefused("stack.toml:1: 1 photographs of the white board, but 4 images");
  Write("stack.toml", "white = \"w*.png\"\n" + lights + "intensity = \"i.txt\"\n");
  Write("i.txt", "1 1 1\n1 1 1\n1 1 1\n1 1 1\n");
  ExpectRefused("white and the lights' intensity say the same");
  Write("stack.toml", "white_albedo = 0.5\n" + lights);
  ExpectRefused("white_albedo needs white");
}

TEST_F(StackReading, DomeOfRelightLab) {
  WriteImages(4, 16);
  const auto dome = [&](const std::string& more) { Write("d.dome", "{\"label\": \"x\", " + more + "}"); };
  const auto points = [](double z) {
    std::string list = "[";
    for (int i = 0; i < 4; ++i) {
      list += std::string(i == 0 ? "" : ", ") + "{\"x\": 3, \"y\": " + std::to_string(i) +
              ", \"z\": " + std::to_string(z) + "}";
    }
    return list + "]";
  };
  dome("\"lightConfiguration\": \"directional\", \"directions\": " + points(4) + ", \"ledAdjust\": [{\"r\": 1}]");
  const Stack distant = OpenStack(folder_, {});
  EXPECT_EQ(distant.layout, "RelightLab dome");
  EXPECT_EQ(distant.images.size(), 4U);
  EXPECT_NEAR(distant.lights[0].direction.z, 0.8, 1e-15);
  EXPECT_FALSE(distant.near.has_value());
  EXPECT_THAT(distant.remarks[0], HasSubstr("ledAdjust of the dome is not used"));
  dome("\"imageWidth\": 12, \"lightConfiguration\": \"lights3d\", \"positions3d\": " + points(40));
  const Stack near = OpenStack(folder_ / "d.dome", {});
  ASSERT_TRUE(near.near.has_value());
  EXPECT_EQ(near.width_mm, 12);
  EXPECT_EQ(near.lights[2].place.z, 40);
  dome("\"lightConfiguration\": \"spherical\", \"positionsSphere\": " + points(40));
  ExpectRefused("need imageWidth");
  dome("\"imageWidth\": 12, \"lightConfiguration\": \"lights3d\", \"positions3d\": " + points(-40));
  ExpectRefused("light 1 at z = -40 mm is not in front of the picture");
  dome("\"lightConfiguration\": \"direction\", \"directions\": []");
  ExpectRefused("lightConfiguration 'direction' is unknown");
  dome("\"directions\": []");
  ExpectRefused("'directions' holds no lights");
  dome("\"directions\": [{\"x\": 1, \"y\": \"2\", \"z\": 3}]");
  ExpectRefused("directions[0] has no number 'y'");
  dome("\"directions\": [{\"x\": 0, \"y\": 0, \"z\": 0}]");
  ExpectRefused("d.dome, directions[0]: (0, 0, 0) is no direction");
  Write("d.dome", "{");
  ExpectRefused("is no JSON object, as a dome of RelightLab is");
}

TEST_F(StackReading, NamesOfAngles) {
  const std::vector<std::uint16_t> pixels(6, 1000);
  for (const char* name : {"tl000 pl000 tv000 pv000.png", "tl060_pl090_tv000_pv000.png", "tl060_pl180_tv000_pv000.png",
                           "tl015 pl022.5 tv000 pv000.png", "tl015 pl000 tv030 pv000.png", "note.png"}) {
    Write(name, EncodePixels(pixels, 3, 2, 1, 16));
  }
  const Stack stack = OpenStack(folder_, {});
  ASSERT_EQ(stack.images.size(), 4U);
  EXPECT_THAT(stack.remarks, testing::Contains(HasSubstr("1 photographs of slanted views are left out")));
  EXPECT_THAT(stack.remarks, testing::Contains(HasSubstr("1 images whose names hold no angles")));
  for (std::size_t l = 0; l < 4; ++l) {
    const std::string name = stack.images[l].filename().string();
    const Vec3& w = stack.lights[l].direction;
    if (name.rfind("tl060_pl090", 0) == 0) {
      EXPECT_NEAR(w.y, std::sin(kPi / 3), 1e-12);
      EXPECT_NEAR(w.z, 0.5, 1e-12);
    }
    if (name.rfind("tl015 pl022.5", 0) == 0) {
      EXPECT_NEAR(std::atan2(w.y, w.x), 22.5 * kPi / 180, 1e-12);
    }
  }
  Write("tl095 pl000 tv000 pv000.png", EncodePixels(pixels, 3, 2, 1, 16));
  ExpectRefused("polar angles 95 and 0 are not within 0 and 90 degrees");
}

TEST_F(StackReading, ManifestErrorsNameTheLine) {
  WriteImages(4, 16);
  WriteLights(4);
  Write("stack.toml", "imags = \"*.png\"\n");
  ExpectRefused("stack.toml:1: unknown key 'imags' (did you mean 'images'?)");
  Write("stack.toml", "images = \"*.tif\"\n[lights]\nfile = \"a.lp\"\n");
  ExpectRefused("no file matches images = '*.tif'");
  Write("stack.toml", "saturation = 7\n[lights]\nfile = \"a.lp\"\n");
  ExpectRefused("stack.toml:1: 'saturation' must be a number from 0.1 to 1");
  Write("stack.toml", "[lights]\nfile = \"a.lp\"\nkind = \"near\"\n");
  ExpectRefused("stack.toml:3: kind = 'near' is unknown; allowed: distant, position");
  Write("stack.toml", "[lights]\nfile = \"a.lp\"\nkind = \"position\"\n");
  ExpectRefused("need [plane] with width_mm, the width of the picture");
  Write("stack.toml", "[lights]\nfile = \"a.lp\"\nkind = \"position\"\n[plane]\nwidth_mm = 0\n");
  ExpectRefused("stack.toml:5: 'width_mm' must be a number from 0.001");
  Write("stack.toml", "[lights]\nfile = \"a.lp\"\nexponent = 1\n");
  ExpectRefused("falloff and exponent are for kind = \"position\"");
  Write("stack.toml", "[lights]\nfile = \"a.lp\"\nkind = \"position\"\n[plane]\nwidth_mm = 9\n");
  WriteLights(4, -5);
  ExpectRefused("light 1 at z = -5 mm is not in front of the picture");
  Write("stack.toml", "images = [\n");
  ExpectRefused("stack.toml:");
}

}  // namespace
}  // namespace lobefit

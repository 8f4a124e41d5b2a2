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
  ExpectRefused("im 2.png: neither PNG nor OpenEXR");
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

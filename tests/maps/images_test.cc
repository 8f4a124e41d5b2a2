// Stacks of images that are not PNG, written by the libraries of their formats.
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/support/folder_test.h"
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <jpeglib.h>
#include <tiffio.h>

#include "lobefit/base/error.h"
#include "lobefit/maps/stack/reader.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct TiffLayout {
  int bits = 16, channels = 3, compression = COMPRESSION_NONE;
  std::uint32_t rows_per_strip = 4, tile = 0;  // tile: side; 0: strips
  bool is_float = false;
  int predictor = 1, samples = 0;  // samples: with others behind the channels; 0: none
  const char* mode = "w";
};

class StackImagesOf : public FolderTest {
 protected:
  static constexpr std::uint32_t kWidth = 37, kHeight = 21;
  // Pixel of channel c, of the stored range.
  static double Stored(std::uint32_t x, std::uint32_t y, int c) { return (3.0 * x + 5.0 * y + 11.0 * c) / 255; }

  void WriteTiff(const std::string& name, const TiffLayout& layout, std::uint32_t width = kWidth) const {
    const int samples = layout.samples == 0 ? layout.channels : layout.samples;
    TIFF* tiff = TIFFOpen((folder_ / name).c_str(), layout.mode);
    ASSERT_NE(tiff, nullptr);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width), TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, layout.bits), TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, samples);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, layout.is_float ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, layout.channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, layout.compression);
    if (layout.predictor > 1) TIFFSetField(tiff, TIFFTAG_PREDICTOR, layout.predictor);
    const std::uint32_t side = layout.tile == 0 ? width : layout.tile, lines = layout.tile == 0 ? 1 : layout.tile;
    if (layout.tile > 0) {
      TIFFSetField(tiff, TIFFTAG_TILEWIDTH, side), TIFFSetField(tiff, TIFFTAG_TILELENGTH, side);
    } else {
      TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, layout.rows_per_strip);
    }
    std::vector<std::uint8_t> block(std::size_t{side} * lines * static_cast<std::size_t>(samples * layout.bits / 8));
    for (std::uint32_t y0 = 0; y0 < kHeight; y0 += lines) {
      for (std::uint32_t x0 = 0; x0 < width; x0 += side) {
        for (std::uint32_t y = 0; y < lines; ++y) {
          for (std::uint32_t x = 0; x < side; ++x) {
            for (int c = 0; c < samples; ++c) {
              const std::size_t at =
                  (std::size_t{y} * side + x) * static_cast<std::size_t>(samples) + static_cast<std::size_t>(c);
              const double value = c < layout.channels ? Stored(x0 + x, y0 + y, c) : 0.5;
              Put(layout, value, &block, at);
            }
          }
        }
        if (layout.tile > 0) {
          ASSERT_GE(TIFFWriteTile(tiff, block.data(), x0, y0, 0, 0), 0);
        } else {
          ASSERT_EQ(TIFFWriteScanline(tiff, block.data(), y0, 0), 1);
        }
      }
    }
    TIFFClose(tiff);
  }
  static void Put(const TiffLayout& layout, double value, std::vector<std::uint8_t>* block, std::size_t at) {
    if (layout.bits == 8) (*block)[at] = static_cast<std::uint8_t>(std::lround(255 * std::min(value, 1.0)));
    const auto code = static_cast<std::uint16_t>(std::lround(65535 * std::min(value, 1.0)));
    const auto real = static_cast<float>(value);
    if (layout.bits == 16 && !layout.is_float) std::memcpy(block->data() + 2 * at, &code, 2);
    const std::uint16_t half = 0x3800;  // 0.5
    if (layout.bits == 16 && layout.is_float) std::memcpy(block->data() + 2 * at, &half, 2);
    if (layout.bits == 32) std::memcpy(block->data() + 4 * at, &real, 4);
  }

  void ExpectPixels(const std::string& name, int channels, int bits, double tolerance) const {
    const std::unique_ptr<ImageRows> image = OpenImage(folder_ / name);
    ASSERT_EQ(image->width(), kWidth) << name;
    ASSERT_EQ(image->height(), kHeight) << name;
    ASSERT_EQ(image->channels(), static_cast<std::size_t>(channels)) << name;
    EXPECT_EQ(image->bits(), bits) << name;
    std::vector<float> row(kWidth * static_cast<std::size_t>(channels));
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      image->Next(row.data());
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        for (int c = 0; c < channels; ++c) {
          ASSERT_NEAR(row[x * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c)], Stored(x, y, c),
                      tolerance)
              << name << " " << x << " " << y << " " << c;
        }
      }
    }
  }
  static void ReadAll(const std::filesystem::path& path) {
    const std::unique_ptr<ImageRows> image = OpenImage(path);
    std::vector<float> row(image->width() * image->channels());
    for (std::size_t y = 0; y < image->height(); ++y) image->Next(row.data());
  }
  void ExpectRefused(const std::string& name, const std::string& words) const {
    EXPECT_THAT([&] { ReadAll(folder_ / name); }, ThrowsMessage<InputError>(HasSubstr(name + ": " + words))) << words;
  }

  // Gray, or RGB whose pixels are alike in blocks of 16 x 16, so that subsampled colours are exact.
  void WriteJpeg(const std::string& name, int channels, bool progressive = false, const std::string& exif = "") const {
    jpeg_compress_struct jpeg = {};
    jpeg_error_mgr errors = {};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    std::FILE* file = std::fopen((folder_ / name).c_str(), "wb");
    ASSERT_NE(file, nullptr);
    jpeg_stdio_dest(&jpeg, file);
    jpeg.image_width = 48, jpeg.image_height = 32, jpeg.input_components = channels;
    jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    if (progressive) jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    if (!exif.empty()) {
      const std::vector<JOCTET> bytes(exif.begin(), exif.end());
      jpeg_write_marker(&jpeg, JPEG_APP0 + 1, bytes.data(), static_cast<unsigned>(bytes.size()));
    }
    for (int y = 0; y < 32; ++y) {
      std::vector<JSAMPLE> row;
      for (int x = 0; x < 48; ++x) {
        for (int c = 0; c < channels; ++c) row.push_back(static_cast<JSAMPLE>(JpegCode(x, y, c)));
      }
      JSAMPROW pointer = row.data();
      jpeg_write_scanlines(&jpeg, &pointer, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::fclose(file);
  }
  static int JpegCode(int x, int y, int c) { return 40 + 50 * (x / 16) + 30 * (y / 16) + 20 * c; }

  void WriteLights(int count, const std::string& ending) const {
    std::string lp = std::to_string(count) + "\n";
    for (int i = 0; i < count; ++i) lp += "im" + std::to_string(i) + ending + " 0.6 0." + std::to_string(i) + " 0.8\n";
    Write("a.lp", lp);
  }
};

TEST_F(StackImagesOf, TiffOfEveryLayout) {
  for (const int compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS, COMPRESSION_ZSTD}) {
    for (const std::uint32_t tile : {0U, 16U}) {
      for (const int channels : {1, 3}) {
        WriteTiff("a.tif", {.bits = 8, .channels = channels, .compression = compression, .tile = tile});
        ExpectPixels("a.tif", channels, 8, 1e-7);
        WriteTiff("a.tif", {.bits = 16, .channels = channels, .compression = compression, .tile = tile});
        ExpectPixels("a.tif", channels, 16, 1e-5);
        WriteTiff("a.tif",
                  {.bits = 32, .channels = channels, .compression = compression, .tile = tile, .is_float = true});
        ExpectPixels("a.tif", channels, 32, 1e-7);
      }
    }
  }
}

TEST_F(StackImagesOf, TiffOfOtherOrderPredictorAlphaAndBigTiff) {
  WriteTiff("a.tif", {.compression = COMPRESSION_LZW, .predictor = 2, .mode = "wb"});  // MM
  ExpectPixels("a.tif", 3, 16, 1e-5);
  WriteTiff("a.tif", {.mode = "w8"});
  ExpectPixels("a.tif", 3, 16, 1e-5);
  WriteTiff("a.tif", {.bits = 32, .compression = COMPRESSION_ADOBE_DEFLATE, .is_float = true, .predictor = 3});
  ExpectPixels("a.tif", 3, 32, 1e-7);
  WriteTiff("a.tif", {.samples = 4});
  ExpectPixels("a.tif", 3, 16, 1e-5);
  WriteTiff("a.tif", {.rows_per_strip = kHeight});
  ExpectPixels("a.tif", 3, 16, 1e-5);
  WriteTiff("a.tif", {.bits = 16, .channels = 1, .is_float = true});
  const std::unique_ptr<ImageRows> image = OpenImage(folder_ / "a.tif");
  EXPECT_EQ(image->bits(), 32);
  std::vector<float> row(kWidth);
  image->Next(row.data());
  EXPECT_EQ(row[3], 0.5F);
}

TEST_F(StackImagesOf, TiffThatIsNotRead) {
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
    for (const std::uint32_t tile : {0U, 16U}) {
      WriteTiff("a.tif", {.compression = compression, .tile = tile});
      // libtiff writes the directory last: moved to the front, so that pixels are what is missing.
      const std::string whole = Read("a.tif");
      Write("b.tif", whole.substr(0, whole.size() - 20));
      ExpectRefused("b.tif", "broken TIFF: ");
    }
  }
  WriteTiff("a.tif", {.bits = 32});
  ExpectRefused("a.tif", "a TIFF of 32 bits a sample in format 1; 8 and 16 bits without sign");
  const auto with = [&](const std::function<void(TIFF*)>& change) {
    WriteTiff("a.tif", {});
    TIFF* tiff = TIFFOpen((folder_ / "a.tif").c_str(), "r+");
    change(tiff);
    TIFFRewriteDirectory(tiff);
    TIFFClose(tiff);
  };
  with([](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_BOTLEFT); });
  ExpectRefused("a.tif", "a TIFF that is to be turned (orientation 4)");
  with([](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_CIELAB); });
  ExpectRefused("a.tif", "a TIFF of photometric interpretation 8");
  WriteTiff("a.tif", {});
  WriteTiff("a.tif", {.mode = "a"});
  ExpectRefused("a.tif", "a TIFF of several pages; one photograph a file");
}

// What a head claims is refused before memory is taken for it.
TEST_F(StackImagesOf, TiffThatClaimsTooMuch) {
  const auto claim = [&](std::uint32_t width, std::uint32_t height, std::uint32_t tile) {
    std::string bytes("II*\0\x08\0\0\0", 8);
    const std::vector<std::array<std::uint32_t, 4>> entries = {
        {256, 4, 1, width}, {257, 4, 1, height}, {258, 3, 1, 16},   {259, 3, 1, 8}, {262, 3, 1, 1},
        {277, 3, 1, 1},     {322, 4, 1, tile},   {323, 4, 1, tile}, {324, 4, 1, 8}, {325, 4, 1, 8}};
    const auto put = [&](std::uint32_t value, int count) {
      for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8U * static_cast<unsigned>(i)) & 255U);
    };
    put(static_cast<std::uint32_t>(entries.size()), 2);
    for (const auto& e : entries) put(e[0], 2), put(e[1], 2), put(e[2], 4), put(e[3], 4);
    put(0, 4);
    Write("a.tif", bytes);
  };
  claim(1U << 31U, 9, 16);
  ExpectRefused("a.tif", "broken TIFF: ");
  claim(60000, 60000, 60000);
  ExpectRefused("a.tif", "a TIFF whose rows of tiles, 60000 high, take more than 64 MB");
  claim(60000, 60000, 16);
  ExpectRefused("a.tif", "broken TIFF: ");
}

TEST_F(StackImagesOf, JpegPixels) {
  for (const int channels : {1, 3}) {
    WriteJpeg("a.JPG", channels);
    const std::unique_ptr<ImageRows> image = OpenImage(folder_ / "a.JPG");
    EXPECT_EQ(image->width(), 48U);
    EXPECT_EQ(image->height(), 32U);
    EXPECT_EQ(image->channels(), static_cast<std::size_t>(channels));
    EXPECT_EQ(image->bits(), 8);
    std::vector<float> row(48 * static_cast<std::size_t>(channels));
    for (int y = 0; y < 32; ++y) {
      image->Next(row.data());
      // Away from the edges of the blocks, where colours of half the resolution mix; rounding of the colour transform.
      for (int x = 4; x < 48; x = x % 16 == 11 ? x + 9 : x + 1) {
        if (y % 16 < 4 || y % 16 > 11) continue;
        for (int c = 0; c < channels; ++c) {
          ASSERT_NEAR(row[static_cast<std::size_t>(x * channels + c)] * 255, JpegCode(x, y, c),
                      channels == 1 ? 0.01 : 1.01)
              << x << " " << y << " " << c;
        }
      }
    }
  }
}

TEST_F(StackImagesOf, JpegThatIsNotRead) {
  WriteJpeg("a.jpg", 3);
  const std::string whole = Read("a.jpg");
  for (const std::size_t bytes : {whole.size() / 2, whole.size() - 30, std::size_t{30}}) {
    Write("b.jpg", whole.substr(0, bytes));
    SCOPED_TRACE(bytes);
    ExpectRefused("b.jpg", "broken JPEG: ");
  }
  std::string spoilt = whole;
  for (std::size_t i = whole.size() - 30; i < whole.size() - 10; ++i) spoilt[i] = '\xff';
  Write("b.jpg", spoilt);
  ExpectRefused("b.jpg", "broken JPEG: ");
  WriteJpeg("a.jpg", 3, true);
  ExpectRefused("a.jpg", "a progressive JPEG cannot be read row by row; jpegtran writes it");
  WriteJpeg("a.jpg", 4);
  ExpectRefused("a.jpg", "a JPEG in CMYK");
  for (const char turn : {'\1', '\6'}) {
    std::string exif("Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0", 24);
    exif += turn;
    exif += std::string(7, '\0');
    WriteJpeg("a.jpg", 3, false, exif);
    if (turn == '\1') {
      EXPECT_NO_THROW(ReadAll(folder_ / "a.jpg"));
    } else {
      ExpectRefused("a.jpg", "its EXIF data turn the picture (orientation 6), which lights do not follow");
    }
  }
}

TEST_F(StackImagesOf, EightBitsNeedAnEncodingInEveryFormat) {
  for (int i = 0; i < 4; ++i) {
    WriteJpeg("im" + std::to_string(i) + ".jpg", 1);
    WriteTiff("im" + std::to_string(i) + ".tif", {.bits = 8});
  }
  for (const char* ending : {".jpg", ".tif"}) {
    WriteLights(4, ending);
    EXPECT_THAT([&] { OpenStack(folder_, {}); },
                ThrowsMessage<InputError>(HasSubstr("8 bits a channel, whose encoding is not said")));
    const Stack stack = OpenStack(folder_, {"gamma:2"});
    StackReader reader(stack);
    const double stored = ending[1] == 'j' ? JpegCode(5, 0, 0) / 255.0 : Stored(5, 0, 0);
    const StackBand band = reader.Read(0, 1);
    EXPECT_NEAR(band.values[5 * stack.channels * 4 + 2], stored * stored, 1e-6);
  }
}

// Parts "light 0" to "light N-1" and one that is no photograph of the stack.
class StackOfParts : public StackImagesOf {
 protected:
  static float Value(std::size_t part, std::size_t x, std::size_t y, std::size_t c) {
    return static_cast<float>(part + 1) *
           (0.01F + 0.001F * static_cast<float>(x + 40 * y) + 0.2F * static_cast<float>(c));
  }
  void WriteParts(std::size_t count, Imf::Compression compression, bool tiled = false) const {
    std::vector<Imf::Header> headers;
    for (std::size_t i = 0; i < count; ++i) {
      Imf::Header header(static_cast<int>(kWidth), static_cast<int>(kHeight));
      for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
      header.compression() = compression;
      header.setName("light " + std::to_string(i));
      header.setType(tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
      if (tiled) header.setTileDescription(Imf::TileDescription(16, 16));
      headers.push_back(header);
    }
    ASSERT_FALSE(tiled) << "only scan lines are written here";
    Imf::MultiPartOutputFile file((folder_ / "all.exr").c_str(), headers.data(), static_cast<int>(count));
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<float> pixels;
      for (std::size_t y = 0; y < kHeight; ++y) {
        for (std::size_t x = 0; x < kWidth; ++x) {
          for (std::size_t c = 0; c < 3; ++c) pixels.push_back(Value(i, x, y, c));
        }
      }
      Imf::FrameBuffer buffer;
      const char* names[3] = {"R", "G", "B"};
      for (std::size_t c = 0; c < 3; ++c) {
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, static_cast<char*>(static_cast<void*>(pixels.data() + c)), 12,
                                           12 * kWidth));
      }
      Imf::OutputPart part(file, static_cast<int>(i));
      part.setFrameBuffer(buffer);
      part.writePixels(static_cast<int>(kHeight));
    }
  }
  void WriteManifest(const std::string& light_file) const {
    Write("stack.toml", "images = \"all.exr\"\n[lights]\nfile = \"" + light_file + "\"\n");
  }
};

TEST_F(StackOfParts, AreItsImagesInTheOrderOfTheLights) {
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    WriteParts(6, compression);
    Write("a.lp", "4\nlight 4 0.6 0 0.8\nlight 0 0.6 0.1 0.8\nlight 5 0.6 0.2 0.8\nlight 2 0.6 0.3 0.8\n");
    WriteManifest("a.lp");
    const Stack stack = OpenStack(folder_, {});
    EXPECT_EQ(stack.parts, (std::vector<std::string>{"light 4", "light 0", "light 5", "light 2"}));
    const std::size_t order[4] = {4, 0, 5, 2};
    // In bands, the first passed over.
    StackReader reader(stack);
    for (const std::size_t first : {3U, 10U, 20U}) {
      const StackBand band = reader.Read(first, 1);
      for (std::size_t x = 0; x < kWidth; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t l = 0; l < 4; ++l) {
            ASSERT_EQ(band.values[(x * 3 + c) * 4 + l], Value(order[l], x, first, c)) << first << " " << x;
          }
        }
      }
    }
  }
  // Lights without names take the parts as they come.
  Write("d.txt", "0.6 0 0.8\n0.6 0.1 0.8\n0.6 0.2 0.8\n0.6 0.3 0.8\n0.6 0.4 0.8\n0.6 0.5 0.8\n");
  WriteManifest("d.txt");
  const Stack all = OpenStack(folder_, {});
  EXPECT_EQ(all.parts.size(), 6U);
  const std::string digest = DigestOf(all);
  WriteParts(6, Imf::NO_COMPRESSION);
  EXPECT_NE(DigestOf(OpenStack(folder_, {})), digest);
}

TEST_F(StackOfParts, WhatIsWrongIsNamed) {
  WriteParts(5, Imf::NO_COMPRESSION);
  Write("a.lp", "4\nlight 4 0.6 0 0.8\nlight 9 0.6 0.1 0.8\nlight 3 0.6 0.2 0.8\nlight 2 0.6 0.3 0.8\n");
  WriteManifest("a.lp");
  EXPECT_THAT([&] { OpenStack(folder_, {}); },
              ThrowsMessage<InputError>(HasSubstr("all.exr: has no part 'light 9' (did you mean 'light")));
  Write("d.txt", "0.6 0 0.8\n0.6 0.1 0.8\n0.6 0.2 0.8\n0.6 0.3 0.8\n");
  WriteManifest("d.txt");
  EXPECT_THAT([&] { OpenStack(folder_, {}); }, ThrowsMessage<InputError>(HasSubstr("5 images, but 4 lights")));
  const std::string whole = Read("all.exr");
  Write("d.txt", "0.6 0 0.8\n0.6 0.1 0.8\n0.6 0.2 0.8\n0.6 0.3 0.8\n0.6 0.4 0.8\n");
  Write("all.exr", whole.substr(0, whole.size() - 500));
  const Stack stack = OpenStack(folder_, {});
  StackReader reader(stack);
  EXPECT_THAT([&] { reader.Read(0, kHeight); },
              ThrowsMessage<InputError>(HasSubstr("all.exr, part 'light 4': broken OpenEXR")));
  // An attribute that claims two gigabytes.
  std::string spoilt = whole;
  const std::size_t at = spoilt.find("channels\0chlist", 0);
  ASSERT_NE(spoilt.find("chlist"), std::string::npos) << at;
  spoilt[spoilt.find("chlist") + 10] = '\x7f';
  Write("all.exr", spoilt);
  EXPECT_THAT([&] { OpenStack(folder_, {}); }, ThrowsMessage<InputError>(HasSubstr("attribute 'channels' claims")));
}

}  // namespace
}  // namespace lobefit

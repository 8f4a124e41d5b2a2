#include "lobefit/maps/output/pixels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <png.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

[[noreturn]] void OnPixelError(png_structp, png_const_charp message) {
  throw OutputError(std::string("PNG: ") + message);
}
void OnPixelWarning(png_structp, png_const_charp) {}
void OnPixelWrite(png_structp png, png_bytep data, png_size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(static_cast<const char*>(static_cast<const void*>(data)), length);
}
void OnPixelFlush(png_structp) {}

}  // namespace

std::string EncodePixels(const std::vector<std::uint16_t>& pixels, std::size_t width, std::size_t height, int channels,
                         int bits) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, OnPixelError, OnPixelWarning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr) throw OutputError("PNG: out of memory");
  png_set_write_fn(png, &bytes, OnPixelWrite, OnPixelFlush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               channels == 1   ? PNG_COLOR_TYPE_GRAY
               : channels == 3 ? PNG_COLOR_TYPE_RGB
                               : PNG_COLOR_TYPE_RGB_ALPHA,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t count = width * static_cast<std::size_t>(channels);
  std::vector<png_byte> row(count * (bits > 8 ? 2 : 1));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t i = 0; i < count; ++i) {
      const unsigned v = pixels[y * count + i];
      if (bits > 8) {
        row[2 * i] = static_cast<png_byte>(v >> 8U), row[2 * i + 1] = static_cast<png_byte>(v & 255U);
      } else {
        row[i] = static_cast<png_byte>(v);
      }
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string EncodeExr(std::vector<float> image, std::size_t width, std::size_t height, std::size_t channels) {
  Imf::Header header(static_cast<int>(width), static_cast<int>(height));
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::string name(1, channels == 1 ? 'Y' : "RGB"[c]);
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    char* base = static_cast<char*>(static_cast<void*>(image.data() + c));
    buffer.insert(name, Imf::Slice(Imf::FLOAT, base, sizeof(float) * channels, sizeof(float) * channels * width));
  }
  Imf::StdOSStream bytes;
  {
    Imf::OutputFile file(bytes, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(static_cast<int>(height));
  }
  return bytes.str();
}

}  // namespace lobefit

// One photograph, decoded row by row, so that all images of a stack advance together in bounded memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

namespace lobefit {

class ImageRows {
 public:
  virtual ~ImageRows() = default;
  ImageRows(const ImageRows&) = delete;
  ImageRows& operator=(const ImageRows&) = delete;

  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  std::size_t channels() const { return channels_; }  // 1 or 3
  int bits() const { return bits_; }                  // 1 to 16 of an integer format; 32: floating point
  // The next row from the top: values[column channels + channel], integers divided by their largest number. Throws
  // InputError where the file ends or is broken.
  virtual void Next(float* values) = 0;

 protected:
  ImageRows() = default;
  std::size_t width_ = 0, height_ = 0, channels_ = 0;
  int bits_ = 0;
};

// By the first bytes: PNG (not interlaced), JPEG (not progressive), TIFF or OpenEXR. Pixels come as they are stored: a
// mark that turns the picture is refused. Memory: some rows, or a row of tiles. Throws InputError.
std::unique_ptr<ImageRows> OpenImage(const std::filesystem::path& path);

// Of each kind, for OpenImage. TIFF: 8 and 16 bits, floating point of 16 and 32; strips and tiles of any compression
// that libtiff has; rows of tiles of at most 64 MB.
std::unique_ptr<ImageRows> OpenPngRows(const std::filesystem::path& path);
std::unique_ptr<ImageRows> OpenJpegRows(const std::filesystem::path& path);
std::unique_ptr<ImageRows> OpenTiffRows(const std::filesystem::path& path);
std::unique_ptr<ImageRows> OpenExrRows(const std::filesystem::path& path);

}  // namespace lobefit

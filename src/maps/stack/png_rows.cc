#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "lobefit/base/error.h"
#include "lobefit/base/printable.h"
#include "lobefit/maps/stack/image_rows.h"

namespace lobefit {
namespace {

constexpr png_uint_32 kMostEdge = 65536;

// libpng reports errors by a call that must not return; an exception leaves its C frames, which hold nothing.
[[noreturn]] void OnReadError(png_structp png, png_const_charp message) {
  throw InputError(fmt::format("{}: broken PNG: {}; write the file again",
                               *static_cast<const std::string*>(png_get_error_ptr(png)), message));
}
void OnReadWarning(png_structp, png_const_charp) {}

class PngRows : public ImageRows {
 public:
  explicit PngRows(const std::filesystem::path& path) : name_(PrintableName(path)) {
    file_ = std::fopen(path.c_str(), "rb");
    if (file_ == nullptr) throw InputError(name_ + ": cannot be opened: " + std::strerror(errno));
    try {
      ReadHead();
    } catch (...) {
      Close();
      throw;
    }
  }
  ~PngRows() override { Close(); }

  void Next(float* values) override {
    png_read_row(png_, row_.data(), nullptr);
    const std::size_t count = width_ * channels_;
    if (bits_ <= 8) {
      for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(row_[i]) / 255.0F;
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        values[i] = static_cast<float>(row_[2 * i] << 8U | row_[2 * i + 1]) / 65535.0F;
      }
    }
  }

 private:
  void ReadHead() {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &name_, OnReadError, OnReadWarning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) throw InputError(name_ + ": out of memory");
    png_set_user_limits(png_, kMostEdge, kMostEdge);
    png_init_io(png_, file_);
    png_read_info(png_, info_);
    if (png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE) {
      throw InputError(name_ + ": an interlaced PNG cannot be read row by row; write it without interlacing");
    }
    width_ = png_get_image_width(png_, info_), height_ = png_get_image_height(png_, info_);
    bits_ = png_get_bit_depth(png_, info_);
    const int color = png_get_color_type(png_, info_);
    if (color == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_), bits_ = 8;
    if (color == PNG_COLOR_TYPE_GRAY && bits_ < 8) png_set_expand_gray_1_2_4_to_8(png_);
    if ((color & PNG_COLOR_MASK_ALPHA) != 0) png_set_strip_alpha(png_);
    channels_ = (color & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1;
    png_read_update_info(png_, info_);
    row_.resize(png_get_rowbytes(png_, info_));
    if (row_.size() < width_ * channels_ * (bits_ > 8 ? 2 : 1)) throw InputError(name_ + ": an unusual PNG");
  }
  void Close() {
    if (png_ != nullptr) png_destroy_read_struct(&png_, &info_, nullptr);
    std::fclose(file_);
  }

  std::string name_;
  std::FILE* file_ = nullptr;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::vector<png_byte> row_;
};

}  // namespace

std::unique_ptr<ImageRows> OpenPngRows(const std::filesystem::path& path) { return std::make_unique<PngRows>(path); }

}  // namespace lobefit

#include <string>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/stack/image_rows.h"
#include "lobefit/maps/stack/open_file.h"

namespace lobefit {
namespace {

constexpr png_uint_32 kMostEdge = 65536;

// libpng reports errors by a call that must not return; an exception leaves its C frames, which hold nothing.
[[noreturn]] void OnReadError(png_structp png, png_const_charp message) {
  throw InputError(fmt::format("{}: broken PNG: {}; write the file again",
                               *static_cast<const std::string*>(png_get_error_ptr(png)), message));
}
void OnReadWarning(png_structp, png_const_charp) {}

struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() {
    if (png != nullptr) png_destroy_read_struct(&png, &info, nullptr);
  }
};

class PngRows : public ImageRows {
 public:
  explicit PngRows(const std::filesystem::path& path) : name_(PrintableName(path)), file_(OpenToRead(path)) {
    ReadHead();
  }

  void Next(float* values) override {
    png_read_row(reader_.png, row_.data(), nullptr);
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
    const png_structp png = reader_.png =
        png_create_read_struct(PNG_LIBPNG_VER_STRING, &name_, OnReadError, OnReadWarning);
    const png_infop info = reader_.info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr) throw InputError(name_ + ": out of memory");
    png_set_user_limits(png, kMostEdge, kMostEdge);
    png_init_io(png, file_.get());
    png_read_info(png, info);
    if (png_get_interlace_type(png, info) != PNG_INTERLACE_NONE) {
      throw InputError(name_ + ": an interlaced PNG cannot be read row by row; write it without interlacing");
    }
    width_ = png_get_image_width(png, info), height_ = png_get_image_height(png, info);
    bits_ = png_get_bit_depth(png, info);
    const int color = png_get_color_type(png, info);
    if (color == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png), bits_ = 8;
    if (color == PNG_COLOR_TYPE_GRAY && bits_ < 8) png_set_expand_gray_1_2_4_to_8(png);
    if ((color & PNG_COLOR_MASK_ALPHA) != 0) png_set_strip_alpha(png);
    channels_ = (color & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1;
    png_read_update_info(png, info);
    row_.resize(png_get_rowbytes(png, info));
    if (row_.size() < width_ * channels_ * (bits_ > 8 ? 2 : 1)) throw InputError(name_ + ": an unusual PNG");
  }

  std::string name_;
  OpenFile file_;
  PngReader reader_;
  std::vector<png_byte> row_;
};

}  // namespace

std::unique_ptr<ImageRows> OpenPngRows(const std::filesystem::path& path) { return std::make_unique<PngRows>(path); }

}  // namespace lobefit

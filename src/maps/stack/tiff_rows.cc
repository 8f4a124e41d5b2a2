#include <cstdarg>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <Imath/half.h>
#include <fmt/format.h>
#include <tiffio.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/stack/image_rows.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostTiffEdge = 65536, kMostSamples = 16;
// Of one image: a row of tiles, and any table that libtiff reads.
constexpr std::size_t kMostTiffBytes = std::size_t{1} << 26;

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

class TiffRows : public ImageRows {
 public:
  explicit TiffRows(const std::filesystem::path& path) : name_(PrintableName(path)) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, OnError, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options, OnWarning, this);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, kMostTiffBytes);
    tiff_.reset(TIFFOpenExt(path.c_str(), "r", options));
    TIFFOpenOptionsFree(options);
    if (tiff_ == nullptr) FailBroken();
    ReadHead();
    CheckOnePage();
  }

  void Next(float* values) override {
    const std::uint8_t* row = tile_height_ == 0 ? ReadLine() : ReadTiles();
    ++row_;
    for (std::size_t x = 0; x < width_; ++x) {
      for (std::size_t c = 0; c < channels_; ++c) values[x * channels_ + c] = Value(row, x * samples_ + c);
    }
  }

 private:
  static int OnError(TIFF*, void* self, const char*, const char* format, std::va_list arguments) {
    char text[512] = {};
    std::vsnprintf(text, sizeof text, format, arguments);
    std::string& message = static_cast<TiffRows*>(self)->message_;
    if (message.empty()) message = Printable(text);  // the first is the cause
    return 1;
  }
  // Unknown tags are warnings, and so is what libjpeg inside makes up for missing data.
  static int OnWarning(TIFF* tiff, void* self, const char* module, const char* format, std::va_list arguments) {
    if (module != nullptr && std::strcmp(module, "JPEGLib") == 0) OnError(tiff, self, module, format, arguments);
    return 1;
  }
  [[noreturn]] void FailBroken() const {
    throw InputError(fmt::format("{}: broken TIFF: {}; write the file again", name_,
                                 message_.empty() ? "no reason given" : message_));
  }
  [[noreturn]] void FailKind(const std::string& found, const std::string& cure) const {
    throw InputError(fmt::format("{}: a TIFF {}; {}", name_, found, cure));
  }

  template <class T>
  T Tag(std::uint32_t tag) const {
    T value = {};
    TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
    return value;
  }

  void ReadHead() {
    width_ = Tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH), height_ = Tag<std::uint32_t>(TIFFTAG_IMAGELENGTH);
    if (width_ == 0 || height_ == 0 || width_ > kMostTiffEdge || height_ > kMostTiffEdge) {
      FailKind(fmt::format("of {} x {} pixels", width_, height_), "1 to 65536 a side are allowed");
    }
    const auto compression = Tag<std::uint16_t>(TIFFTAG_COMPRESSION);
    if (TIFFIsCODECConfigured(compression) == 0) {
      FailKind(fmt::format("of compression {}, which libtiff does not read", compression),
               "write it with lzw, zip or none (tiffcp -c)");
    }
    bits_ = Tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE);
    const auto format = Tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT);
    is_float_ = format == SAMPLEFORMAT_IEEEFP;
    const bool whole = (format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID) && (bits_ == 8 || bits_ == 16);
    if (!whole && !(is_float_ && (bits_ == 16 || bits_ == 32))) {
      FailKind(fmt::format("of {} bits a sample in format {}", bits_, format),
               "8 and 16 bits without sign and floating point of 16 and 32 bits are read");
    }
    sample_bytes_ = static_cast<std::size_t>(bits_) / 8;
    if (is_float_) bits_ = 32;
    samples_ = Tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL);
    const auto kind = Tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC);
    const bool jpeg = compression == COMPRESSION_JPEG && kind == PHOTOMETRIC_YCBCR;
    if (jpeg) TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (kind != PHOTOMETRIC_MINISBLACK && kind != PHOTOMETRIC_RGB && !jpeg) {
      FailKind(fmt::format("of photometric interpretation {}", kind), "gray with 0 black and RGB are read: convert it");
    }
    channels_ = kind == PHOTOMETRIC_MINISBLACK ? 1 : 3;
    if (samples_ < channels_ || samples_ > kMostSamples) {
      FailKind(fmt::format("of {} samples a pixel", samples_), "1 or 3, perhaps with others behind them, are read");
    }
    if (samples_ > 1 && Tag<std::uint16_t>(TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG) {
      FailKind("whose channels lie apart", "write it with them together (tiffcp -p contig)");
    }
    const auto orientation = Tag<std::uint16_t>(TIFFTAG_ORIENTATION);
    if (orientation != ORIENTATION_TOPLEFT) {
      FailKind(fmt::format("that is to be turned (orientation {}), which lights do not follow", orientation),
               "turn the pixels, or remove the mark where the lights are those of the pixels as stored");
    }
    MakeRoom();
  }

  void MakeRoom() {
    const std::size_t line = samples_ * sample_bytes_;
    if (TIFFIsTiled(tiff_.get()) == 0) {
      if (TIFFScanlineSize64(tiff_.get()) != width_ * line) FailKind("with rows of an unusual size", "convert it");
      buffer_.resize(width_ * line);
      return;
    }
    tile_width_ = Tag<std::uint32_t>(TIFFTAG_TILEWIDTH), tile_height_ = Tag<std::uint32_t>(TIFFTAG_TILELENGTH);
    if (tile_width_ == 0 || tile_height_ == 0 || tile_width_ > kMostTiffEdge || tile_height_ > kMostTiffEdge) {
      FailKind(fmt::format("of tiles of {} x {}", tile_width_, tile_height_), "write it in strips (tiffcp -s)");
    }
    const std::size_t tile = tile_width_ * line * tile_height_, across = (width_ + tile_width_ - 1) / tile_width_;
    if (tile * (across + 1) > kMostTiffBytes) {
      FailKind(fmt::format("whose rows of tiles, {} high, take more than 64 MB", tile_height_),
               "write it in strips (tiffcp -s)");
    }
    if (TIFFTileSize64(tiff_.get()) != tile) FailKind("with tiles of an unusual size", "convert it");
    tile_.resize(tile);
    buffer_.resize(tile * across);
  }

  // A stack has one photograph a file: pages that are smaller copies of it are passed over.
  void CheckOnePage() {
    if (TIFFLastDirectory(tiff_.get()) != 0) return;
    if (TIFFReadDirectory(tiff_.get()) == 0) FailBroken();
    if ((Tag<std::uint32_t>(TIFFTAG_SUBFILETYPE) & FILETYPE_REDUCEDIMAGE) == 0) {
      FailKind("of several pages", "one photograph a file is expected (tiffsplit)");
    }
    if (TIFFSetDirectory(tiff_.get(), 0) == 0) FailBroken();
    if (Tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_YCBCR) {
      TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    }
  }

  const std::uint8_t* ReadLine() {
    if (TIFFReadScanline(tiff_.get(), buffer_.data(), row_, 0) != 1 || !message_.empty()) FailBroken();
    return buffer_.data();
  }

  const std::uint8_t* ReadTiles() {
    const std::size_t line = tile_width_ * samples_ * sample_bytes_, across = (width_ + tile_width_ - 1) / tile_width_;
    if (row_ % tile_height_ == 0) {
      for (std::size_t t = 0; t < across; ++t) {
        const auto x = static_cast<std::uint32_t>(t * tile_width_);
        if (TIFFReadTile(tiff_.get(), tile_.data(), x, row_, 0, 0) < 0 || !message_.empty()) FailBroken();
        for (std::size_t y = 0; y < tile_height_; ++y) {
          std::memcpy(buffer_.data() + (y * across + t) * line, tile_.data() + y * line, line);
        }
      }
    }
    return buffer_.data() + row_ % tile_height_ * across * line;
  }

  float Value(const std::uint8_t* row, std::size_t at) const {
    if (sample_bytes_ == 1) return static_cast<float>(row[at]) / 255.0F;
    if (sample_bytes_ == 4) {
      float value;
      std::memcpy(&value, row + 4 * at, sizeof value);
      return value;
    }
    std::uint16_t code;
    std::memcpy(&code, row + 2 * at, sizeof code);
    if (!is_float_) return static_cast<float>(code) / 65535.0F;
    Imath::half value;
    value.setBits(code);
    return value;
  }

  std::string name_, message_;  // the error that libtiff told first
  std::unique_ptr<TIFF, CloseTiff> tiff_;
  bool is_float_ = false;
  std::size_t samples_ = 0, sample_bytes_ = 0, tile_width_ = 0, tile_height_ = 0;  // tile_height_ 0: strips
  std::uint32_t row_ = 0;
  std::vector<std::uint8_t> buffer_, tile_;
};

}  // namespace

std::unique_ptr<ImageRows> OpenTiffRows(const std::filesystem::path& path) { return std::make_unique<TiffRows>(path); }

}  // namespace lobefit

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>
// Needs std::FILE and sizes before it.
#include <jerror.h>
#include <jpeglib.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/stack/image_rows.h"
#include "lobefit/maps/stack/open_file.h"

namespace lobefit {
namespace {

std::string MessageOf(j_common_ptr jpeg) {
  char text[JMSG_LENGTH_MAX] = {};
  jpeg->err->format_message(jpeg, text);
  return Printable(text);
}

[[noreturn]] void FailBroken(j_common_ptr jpeg) {
  throw InputError(fmt::format("{}: broken JPEG: {}; write the file again",
                               *static_cast<const std::string*>(jpeg->client_data), MessageOf(jpeg)));
}

// libjpeg fills with gray what is missing and calls that a warning: here it is an error, as in every other format.
void OnJpegMessage(j_common_ptr jpeg, int level) {
  if (level >= 0) return;
  switch (jpeg->err->msg_code) {
    case JWRN_ADOBE_XFORM:
    case JWRN_EXTRANEOUS_DATA:
    case JWRN_JFIF_MAJOR:
      return;  // the pixels are whole
    default:
      FailBroken(jpeg);
  }
}

// Orientation of the EXIF data, [EXIF 2.3, 4.6.4 A]: 1 to 8; 1 where there is none.
int OrientationOf(const jpeg_marker_struct* marker) {
  constexpr std::size_t kTiff = 6, kEntry = 12;
  for (; marker != nullptr; marker = marker->next) {
    const std::size_t size = marker->data_length;
    const JOCTET* data = marker->data;
    if (size < kTiff + 10 || std::memcmp(data, "Exif\0\0", kTiff) != 0) continue;
    const bool little = data[kTiff] == 'I';
    const auto number = [&](std::size_t at, std::size_t bytes) {
      std::size_t value = 0;
      for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | data[at + (little ? bytes - 1 - i : i)];
      return value;
    };
    std::size_t at = kTiff + number(kTiff + 4, 4);
    if (at > size - 2) continue;
    const std::size_t entries = number(at, 2);
    at += 2;
    for (std::size_t i = 0; i < entries && at + kEntry <= size; ++i, at += kEntry) {
      constexpr std::size_t kOrientation = 0x112;
      if (number(at, 2) == kOrientation) return static_cast<int>(number(at + 8, 2));
    }
  }
  return 1;
}

struct JpegReader {
  jpeg_decompress_struct jpeg = {};
  JpegReader() = default;
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

class JpegRows : public ImageRows {
 public:
  explicit JpegRows(const std::filesystem::path& path) : name_(PrintableName(path)), file_(OpenToRead(path)) {
    ReadHead();
  }

  void Next(float* values) override {
    JSAMPROW row = row_.data();
    jpeg_read_scanlines(&reader_.jpeg, &row, 1);
    for (std::size_t i = 0; i < row_.size(); ++i) values[i] = static_cast<float>(row_[i]) / 255.0F;
  }

 private:
  void ReadHead() {
    jpeg_decompress_struct& jpeg = reader_.jpeg;
    jpeg.err = jpeg_std_error(&errors_);
    // An exception leaves libjpeg's C frames, which hold nothing.
    errors_.error_exit = [](j_common_ptr broken) { FailBroken(broken); };
    errors_.emit_message = OnJpegMessage;
    jpeg.client_data = &name_;
    jpeg_create_decompress(&jpeg);
    constexpr unsigned kMostExif = 4096;  // the orientation stands at its beginning
    jpeg_save_markers(&jpeg, JPEG_APP0 + 1, kMostExif);
    jpeg_stdio_src(&jpeg, file_.get());
    jpeg_read_header(&jpeg, TRUE);
    if (jpeg_has_multiple_scans(&jpeg) != 0) {
      throw InputError(
          name_ + ": a progressive JPEG cannot be read row by row; jpegtran writes it as a baseline one without loss");
    }
    if (jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK) {
      throw InputError(name_ + ": a JPEG in CMYK; images of a stack are gray or RGB: convert it");
    }
    const int orientation = OrientationOf(jpeg.marker_list);
    if (orientation != 1) {
      throw InputError(fmt::format(
          "{}: its EXIF data turn the picture (orientation {}), which lights do not follow; turn the pixels (exiftran "
          "-a) "
          "or, where the lights are those of the pixels as stored, remove the mark (exiftool -Orientation=)",
          name_, orientation));
    }
    channels_ = jpeg.jpeg_color_space == JCS_GRAYSCALE ? 1 : 3;
    jpeg.out_color_space = channels_ == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&jpeg);
    width_ = jpeg.output_width, height_ = jpeg.output_height, bits_ = 8;
    row_.resize(width_ * channels_);
  }

  std::string name_;
  OpenFile file_;
  jpeg_error_mgr errors_ = {};  // outlives the reader, which points to it
  JpegReader reader_;
  std::vector<JSAMPLE> row_;
};

}  // namespace

std::unique_ptr<ImageRows> OpenJpegRows(const std::filesystem::path& path) { return std::make_unique<JpegRows>(path); }

}  // namespace lobefit

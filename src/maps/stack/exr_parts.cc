#include "lobefit/maps/stack/exr_parts.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/exr/head.h"

namespace lobefit {

struct ExrParts::File {
  std::string name;
  std::size_t bytes = 0;
  std::unique_ptr<Imf::MultiPartInputFile> exr;
};

namespace {

constexpr std::int64_t kMostExrEdge = 65536;
constexpr std::size_t kMostExrHead = std::size_t{1} << 24;
// What is decoded at once, of one image; and no compression packs even a constant image closer than this.
constexpr std::size_t kMostExrBlock = std::size_t{1} << 26, kMostPixelBytesPerByte = 4096;

// Throws InputError where the head cannot be true.
void CheckHead(const std::filesystem::path& path, std::size_t file_bytes) {
  std::string head(std::min(kMostExrHead, file_bytes), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  CheckExrHead({path, head}, file_bytes);
}

std::size_t PixelBytes(const Imf::ChannelList& channels) {
  std::size_t bytes = 0;
  for (Imf::ChannelList::ConstIterator c = channels.begin(); c != channels.end(); ++c) {
    bytes += c.channel().type == Imf::HALF ? 2 : 4;
  }
  return bytes;
}

// Lines that are compressed together.
std::size_t LinesTogether(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 32;
  }
}

class ExrPartRows : public ImageRows {
 public:
  ExrPartRows(std::shared_ptr<const void> file, Imf::MultiPartInputFile* exr, std::size_t file_bytes, int part,
              std::string name)
      : name_(std::move(name)), file_(std::move(file)) {
    const Imf::Header& header = exr->header(part);
    const Imath::Box2i window = header.dataWindow();
    first_column_ = window.min.x, row_ = window.min.y;
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                       height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width > kMostExrEdge || height > kMostExrEdge) throw InputError(name_ + ": more than 65536 pixels a side");
    width_ = static_cast<std::size_t>(width), height_ = static_cast<std::size_t>(height);
    bits_ = 32;
    const Imf::ChannelList& channels = header.channels();
    if (channels.findChannel("R") != nullptr && channels.findChannel("G") != nullptr &&
        channels.findChannel("B") != nullptr) {
      names_ = {"R", "G", "B"};
    } else if (channels.findChannel("Y") != nullptr) {
      names_ = {"Y"};
    } else {
      throw InputError(name_ + ": has neither channels R, G, B nor Y; write the image with these names");
    }
    channels_ = names_.size();
    if (header.hasType() && !Imf::isImage(header.type())) throw InputError(name_ + ": deep data are no photograph");
    const bool tiled = header.hasTileDescription();
    const std::size_t lines = tiled ? header.tileDescription().ySize : LinesTogether(header.compression());
    const std::size_t block = width_ * std::min(lines, height_) * PixelBytes(channels);
    if (block > kMostExrBlock || block / kMostPixelBytesPerByte > file_bytes) {
      throw InputError(name_ + ": lines that are decoded together claim " + std::to_string(block) +
                       " bytes; at most 64 MB are allowed, and no more than 4096 times the file");
    }
    Guarded([&] { part_ = std::make_unique<Imf::InputPart>(*exr, part); });
  }

  void Next(float* values) override {
    Guarded([&] {
      Imf::FrameBuffer buffer;
      for (std::size_t c = 0; c < channels_; ++c) {
        // The library counts columns of the data window and, with a stride of 0, stays in this row.
        char* base = static_cast<char*>(static_cast<void*>(values + c));
        base -= static_cast<std::ptrdiff_t>(sizeof(float) * channels_) * first_column_;
        buffer.insert(names_[c], Imf::Slice(Imf::FLOAT, base, sizeof(float) * channels_, 0));
      }
      part_->setFrameBuffer(buffer);
      part_->readPixels(row_, row_);
      ++row_;
    });
  }

 private:
  template <class F>
  void Guarded(const F& read) {
    try {
      read();
    } catch (const std::exception& error) {
      throw InputError(name_ + ": broken OpenEXR: " + Printable(error.what()) + "; write the file again");
    }
  }

  std::string name_;
  std::shared_ptr<const void> file_;  // that part_ reads from
  std::unique_ptr<Imf::InputPart> part_;
  std::vector<std::string> names_;
  int first_column_ = 0, row_ = 0;
};

}  // namespace

ExrParts::ExrParts(const std::filesystem::path& path) : file_(std::make_shared<File>()) {
  file_->name = PrintableName(path);
  std::error_code error;
  file_->bytes = static_cast<std::size_t>(std::filesystem::file_size(path, error));
  if (error) throw InputError(file_->name + ": cannot be read: " + error.message());
  CheckHead(path, file_->bytes);
  try {
    file_->exr = std::make_unique<Imf::MultiPartInputFile>(path.c_str(), 0);
  } catch (const std::exception& what) {
    throw InputError(file_->name + ": not readable as OpenEXR: " + Printable(what.what()));
  }
  for (int part = 0; part < file_->exr->parts(); ++part) {
    const Imf::Header& header = file_->exr->header(part);
    names_.push_back(header.hasName() ? header.name() : std::string());
  }
}

std::unique_ptr<ImageRows> ExrParts::Open(const std::string& part) const {
  const auto found = std::find(names_.begin(), names_.end(), part);
  if (found == names_.end()) {
    throw InputError(fmt::format("{}: has no part '{}'{}", file_->name, Excerpt(part), DidYouMean(part, names_)));
  }
  const std::string name = names_.size() > 1 ? fmt::format("{}, part '{}'", file_->name, Excerpt(part)) : file_->name;
  return std::make_unique<ExrPartRows>(file_, file_->exr.get(), file_->bytes, static_cast<int>(found - names_.begin()),
                                       name);
}

bool IsExrImage(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  char head[4] = {};
  in.read(head, 4);
  return std::memcmp(head, "\x76\x2f\x31\x01", 4) == 0;
}

std::unique_ptr<ImageRows> OpenExrRows(const std::filesystem::path& path) {
  const ExrParts parts(path);
  return parts.Open(parts.names()[0]);
}

}  // namespace lobefit

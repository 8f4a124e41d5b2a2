#include <string>
#include <vector>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include "lobefit/base/error.h"
#include "lobefit/base/printable.h"
#include "lobefit/maps/stack/image_rows.h"

namespace lobefit {
namespace {

constexpr int kMostExrEdge = 65536;

class ExrRows : public ImageRows {
 public:
  explicit ExrRows(const std::filesystem::path& path) : name_(PrintableName(path)), file_(Open(path)) {
    const Imath::Box2i window = file_->header().dataWindow();
    first_column_ = window.min.x, row_ = window.min.y;
    if (window.max.x - window.min.x >= kMostExrEdge || window.max.y - window.min.y >= kMostExrEdge) {
      throw InputError(name_ + ": more than 65536 pixels a side");
    }
    width_ = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    height_ = static_cast<std::size_t>(window.max.y - window.min.y + 1);
    bits_ = 32;
    const Imf::ChannelList& channels = file_->header().channels();
    if (channels.findChannel("R") != nullptr && channels.findChannel("G") != nullptr &&
        channels.findChannel("B") != nullptr) {
      names_ = {"R", "G", "B"};
    } else if (channels.findChannel("Y") != nullptr) {
      names_ = {"Y"};
    } else {
      throw InputError(name_ + ": has neither channels R, G, B nor Y; write the image with these names");
    }
    channels_ = names_.size();
  }

  void Next(float* values) override {
    try {
      Imf::FrameBuffer buffer;
      for (std::size_t c = 0; c < channels_; ++c) {
        // The library counts columns of the data window and, with a stride of 0, stays in this row.
        char* base = static_cast<char*>(static_cast<void*>(values + c));
        base -= static_cast<std::ptrdiff_t>(sizeof(float) * channels_) * first_column_;
        buffer.insert(names_[c], Imf::Slice(Imf::FLOAT, base, sizeof(float) * channels_, 0));
      }
      file_->setFrameBuffer(buffer);
      file_->readPixels(row_, row_);
      ++row_;
    } catch (const std::exception& error) {
      throw InputError(name_ + ": broken OpenEXR: " + Printable(error.what()) + "; write the file again");
    }
  }

 private:
  std::unique_ptr<Imf::InputFile> Open(const std::filesystem::path& path) const {
    try {
      return std::make_unique<Imf::InputFile>(path.c_str(), 0);
    } catch (const std::exception& error) {
      throw InputError(name_ + ": not readable as OpenEXR: " + Printable(error.what()));
    }
  }

  std::string name_;
  std::unique_ptr<Imf::InputFile> file_;
  std::vector<std::string> names_;
  int first_column_ = 0, row_ = 0;
};

}  // namespace

std::unique_ptr<ImageRows> OpenExrRows(const std::filesystem::path& path) { return std::make_unique<ExrRows>(path); }

}  // namespace lobefit

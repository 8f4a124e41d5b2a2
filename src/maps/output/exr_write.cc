#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <system_error>

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/pending_file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/output/exr.h"

namespace lobefit {
namespace {

constexpr int kTile = 64;
constexpr MapPart kParts[] = {MapPart::kParameters, MapPart::kErrors, MapPart::kQuality};

// OpenEXR writes to a file that has no name yet.
class PendingStream : public Imf::OStream {
 public:
  PendingStream(int descriptor, const char* name) : Imf::OStream(name), descriptor_(descriptor) {}
  void write(const char bytes[], int count) override {
    while (count > 0) {
      const ssize_t written = pwrite(descriptor_, bytes, static_cast<std::size_t>(count), static_cast<off_t>(at_));
      if (written < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category());
      if (written < 0) continue;
      bytes += written, count -= static_cast<int>(written), at_ += static_cast<std::uint64_t>(written);
    }
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

 private:
  int descriptor_;
  std::uint64_t at_ = 0;
};

Imf::PixelType PixelTypeOf(MapType type) {
  return type == MapType::kFloat ? Imf::FLOAT : type == MapType::kHalf ? Imf::HALF : Imf::UINT;
}

std::vector<Imf::Header> Headers(const std::vector<MapPlane>& planes, int width, int height) {
  std::vector<Imf::Header> headers;
  for (const MapPart part : kParts) {
    Imf::Header header(width, height, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    header.setName(PartName(part));
    header.setType(Imf::TILEDIMAGE);
    header.setTileDescription(Imf::TileDescription(kTile, kTile, Imf::ONE_LEVEL));
    for (const MapPlane& plane : planes) {
      if (plane.part == part) header.channels().insert(plane.name, Imf::Channel(PixelTypeOf(plane.type)));
    }
    headers.push_back(header);
  }
  return headers;
}

// A plane's rows as their type in the file; errors too large for a half become infinite, which a half has.
std::vector<char> Converted(const std::vector<float>& values, MapType type) {
  std::vector<char> bytes(values.size() * (type == MapType::kHalf ? 2 : 4));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (type == MapType::kHalf) {
      const half h(values[i]);
      std::memcpy(&bytes[2 * i], &h, 2);
    } else if (type == MapType::kFloat) {
      std::memcpy(&bytes[4 * i], &values[i], 4);
    } else {
      const auto count = static_cast<std::uint32_t>(values[i]);
      std::memcpy(&bytes[4 * i], &count, 4);
    }
  }
  return bytes;
}

void WriteTiles(const std::vector<MapPlane>& planes, int width, int height, const MapSource& source,
                Imf::MultiPartOutputFile* file) {
  for (int row = 0; row * kTile < height; ++row) {
    const int first = row * kTile, end = std::min(height, first + kTile);
    const MapRows rows = source(static_cast<std::size_t>(first), static_cast<std::size_t>(end));
    for (int p = 0; p < 3; ++p) {
      Imf::TiledOutputPart part(*file, p);
      Imf::FrameBuffer buffer;
      std::vector<std::vector<char>> kept;
      for (std::size_t k = 0; k < planes.size(); ++k) {
        if (planes[k].part != kParts[p]) continue;
        kept.push_back(Converted(rows.values[k], planes[k].type));
        const std::size_t size = planes[k].type == MapType::kHalf ? 2 : 4;
        const std::size_t stride = size * static_cast<std::size_t>(width);
        // The library counts rows of the picture.
        char* base = kept.back().data() - static_cast<std::ptrdiff_t>(stride) * first;
        buffer.insert(planes[k].name, Imf::Slice(PixelTypeOf(planes[k].type), base, size, stride));
      }
      part.setFrameBuffer(buffer);
      part.writeTiles(0, part.numXTiles() - 1, row, row);
    }
  }
}

}  // namespace

void WriteMapsExr(const std::vector<MapPlane>& planes, std::size_t width, std::size_t height, const MapSource& source,
                  const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  try {
    PendingFile pending(folder);
    {
      PendingStream stream(pending.descriptor(), path.c_str());
      const std::vector<Imf::Header> headers = Headers(planes, static_cast<int>(width), static_cast<int>(height));
      Imf::MultiPartOutputFile file(stream, headers.data(), static_cast<int>(headers.size()), false, 0);
      WriteTiles(planes, static_cast<int>(width), static_cast<int>(height), source, &file);
    }
    pending.TakePlaceOf(path.filename().string());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(PrintableName(path) + ": cannot be written as EXR: " + Printable(error.what()) +
                      "; is the disk full? What is fitted stays in the journal");
  }
}

}  // namespace lobefit

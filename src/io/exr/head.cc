#include "lobefit/io/exr/head.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

constexpr std::size_t kFirstAttribute = 8;  // behind magic and version
constexpr std::uint32_t kMultiPart = 0x1000;

std::uint32_t LoadU32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

// The zero-terminated word at *at; moves *at behind it. Nothing where the file ends before.
std::optional<std::string_view> Word(std::string_view bytes, std::size_t* at) {
  const std::size_t end = bytes.find('\0', *at);
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view word = bytes.substr(*at, end - *at);
  *at = end + 1;
  return word;
}

// OpenEXR reads these types by their own size, whatever the attribute states: where the two differ it goes on in the
// wrong place.
std::optional<std::size_t> SizeOfType(std::string_view type) {
  struct Fixed {
    std::string_view type;
    std::size_t bytes;
  };
  static constexpr std::array<Fixed, 24> kFixed = {{{"box2f", 16},
                                                    {"box2i", 16},
                                                    {"chromaticities", 32},
                                                    {"compression", 1},
                                                    {"deepImageState", 1},
                                                    {"double", 8},
                                                    {"envmap", 1},
                                                    {"float", 4},
                                                    {"int", 4},
                                                    {"keycode", 28},
                                                    {"lineOrder", 1},
                                                    {"m33d", 72},
                                                    {"m33f", 36},
                                                    {"m44d", 128},
                                                    {"m44f", 64},
                                                    {"rational", 8},
                                                    {"tiledesc", 9},
                                                    {"timecode", 8},
                                                    {"v2d", 16},
                                                    {"v2f", 8},
                                                    {"v2i", 8},
                                                    {"v3d", 24},
                                                    {"v3f", 12},
                                                    {"v3i", 12}}};
  for (const Fixed& fixed : kFixed) {
    if (fixed.type == type) return fixed.bytes;
  }
  return std::nullopt;
}

// Whether a list of strings, each behind its length, fills [at, end).
bool AreStrings(std::string_view bytes, std::size_t at, std::size_t end) {
  while (end - at >= 4) {
    const std::size_t length = LoadU32(bytes, at);
    if (length > end - at - 4) return false;
    at += 4 + length;
  }
  return at == end;
}

// Whether names with 16 bytes each and an empty name at the end fill [at, end).
bool AreChannels(std::string_view bytes, std::size_t at, std::size_t end) {
  constexpr std::size_t kChannelBytes = 16;
  while (at < end) {
    const std::optional<std::string_view> name = Word(bytes, &at);
    if (!name) return false;
    if (name->empty()) return at == end;
    at += kChannelBytes;
  }
  return false;
}

bool FitsItsType(std::string_view bytes, std::string_view type, std::size_t at, std::size_t size) {
  if (const std::optional<std::size_t> fixed = SizeOfType(type)) return size == *fixed;
  if (type == "stringvector") return AreStrings(bytes, at, at + size);
  if (type == "chlist") return AreChannels(bytes, at, at + size);
  if (type == "floatvector") return size % 4 == 0;
  if (type == "idmanifest") return size >= 4;
  if (type != "preview") return true;
  const std::uint64_t pixels = size < 8 ? 0 : std::uint64_t{LoadU32(bytes, at)} * LoadU32(bytes, at + 4);
  return size >= 8 && pixels <= size && size == 8 + 4 * pixels;
}

struct Part {
  std::optional<std::array<std::int64_t, 2>> extent, tile;  // width and height
  std::size_t tiles_at = 0;
};

// Every tile has eight bytes in a table of the file.
void CheckTiles(const InputFile& file, std::size_t file_bytes, const Part& part) {
  if (!part.extent || !part.tile) return;
  std::size_t tiles = 1;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::int64_t extent = (*part.extent)[k], tile = (*part.tile)[k];
    if (extent < 1 || tile < 1) return;
    tiles *= static_cast<std::size_t>((extent - 1) / tile + 1);
    if (tiles <= file_bytes / 8) continue;
    FailAtByte(file, part.tiles_at,
               "tiles of " + std::to_string((*part.tile)[0]) + " x " + std::to_string((*part.tile)[1]) +
                   " pixels for an image of " + std::to_string((*part.extent)[0]) + " x " +
                   std::to_string((*part.extent)[1]) + " need a table of more bytes than the file has (" +
                   std::to_string(file_bytes) + "); fetch the file again");
  }
}

// The attributes of one part from *at on; false where there is none.
bool CheckPart(const InputFile& file, std::size_t file_bytes, std::size_t* at) {
  Part part;
  bool any = false;
  while (const std::optional<std::string_view> name = Word(file.bytes, at)) {
    if (name->empty()) break;
    any = true;
    const std::optional<std::string_view> type = Word(file.bytes, at);
    if (!type || file.bytes.size() - *at < 4) break;
    const std::size_t size = LoadU32(file.bytes, *at), data = *at + 4;
    if (size > file_bytes - data) {
      FailAtByte(file, *at,
                 "attribute '" + Excerpt(*name) + "' claims " + std::to_string(size) +
                     " bytes, but the file has only " + std::to_string(file_bytes - data) +
                     " more; fetch the file again");
    }
    if (size > file.bytes.size() - data) FailAtByte(file, *at, "its head is longer than 16 MB");
    if (!FitsItsType(file.bytes, *type, data, size)) {
      FailAtByte(file, *at,
                 "attribute '" + Excerpt(*name) + "' of type " + Excerpt(*type) + " states " + std::to_string(size) +
                     " bytes, which its content does not fill; fetch the file again");
    }
    const auto number = [&](std::size_t k) {
      return std::int64_t{static_cast<std::int32_t>(LoadU32(file.bytes, data + 4 * k))};
    };
    if (*name == "dataWindow" && size == 16) part.extent = {number(2) - number(0) + 1, number(3) - number(1) + 1};
    if (*name == "tiles" && size == 9) {
      part.tile = {number(0), number(1)};
      part.tiles_at = data;
    }
    *at = data + size;
  }
  CheckTiles(file, file_bytes, part);
  return any;
}

}  // namespace

void CheckExrHead(const InputFile& file, std::size_t file_bytes) {
  if (file.bytes.size() < kFirstAttribute) return;
  const bool several = (LoadU32(file.bytes, 4) & kMultiPart) != 0;
  std::size_t at = kFirstAttribute;
  while (CheckPart(file, file_bytes, &at) && several) {
  }
}

}  // namespace lobefit

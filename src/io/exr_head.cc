#include "lobefit/io/exr_head.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "lobefit/base/text.h"
#include "lobefit/io/place.h"

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

// A list of strings, each behind its length.
void CheckStrings(const InputFile& file, std::size_t at, std::size_t end) {
  while (end - at >= 4) {
    const std::size_t length = LoadU32(file.bytes, at);
    if (length > end - at - 4) {
      FailAtByte(file, at,
                 "a string of a list claims " + std::to_string(length) + " bytes, but the list has only " +
                     std::to_string(end - at - 4) + " more; fetch the file again");
    }
    at += 4 + length;
  }
}

struct Part {
  std::optional<std::array<std::int64_t, 2>> extent, tile;  // width and height
  std::size_t tiles_at = 0;
};

// Every tile has eight bytes in a table of the file.
void CheckTiles(const InputFile& file, const Part& part) {
  if (!part.extent || !part.tile) return;
  std::size_t tiles = 1;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::int64_t extent = (*part.extent)[k], tile = (*part.tile)[k];
    if (extent < 1 || tile < 1) return;
    tiles *= static_cast<std::size_t>((extent - 1) / tile + 1);
    if (tiles <= file.bytes.size() / 8) continue;
    FailAtByte(file, part.tiles_at,
               "tiles of " + std::to_string((*part.tile)[0]) + " x " + std::to_string((*part.tile)[1]) +
                   " pixels for an image of " + std::to_string((*part.extent)[0]) + " x " +
                   std::to_string((*part.extent)[1]) + " need a table of more bytes than the file has (" +
                   std::to_string(file.bytes.size()) + "); fetch the file again");
  }
}

// The attributes of one part from *at on; false where there is none.
bool CheckPart(const InputFile& file, std::size_t* at) {
  Part part;
  bool any = false;
  while (const std::optional<std::string_view> name = Word(file.bytes, at)) {
    if (name->empty()) break;
    any = true;
    const std::optional<std::string_view> type = Word(file.bytes, at);
    if (!type || file.bytes.size() - *at < 4) break;
    const std::size_t size = LoadU32(file.bytes, *at), data = *at + 4;
    if (size > file.bytes.size() - data) {
      FailAtByte(file, *at,
                 "attribute '" + Excerpt(*name) + "' claims " + std::to_string(size) +
                     " bytes, but the file has only " + std::to_string(file.bytes.size() - data) +
                     " more; fetch the file again");
    }
    if (*type == "stringvector") CheckStrings(file, data, data + size);
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
  CheckTiles(file, part);
  return any;
}

}  // namespace

void CheckExrHead(const InputFile& file) {
  if (file.bytes.size() < kFirstAttribute) return;
  const bool several = (LoadU32(file.bytes, 4) & kMultiPart) != 0;
  std::size_t at = kFirstAttribute;
  while (CheckPart(file, &at) && several) {
  }
}

}  // namespace lobefit

#include "lobefit/io/text/decoded_file.h"

#include <algorithm>
#include <memory>

#include <zlib.h>

#include "lobefit/base/error.h"
#include "lobefit/io/text/encodings.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostUnpacked = std::size_t{2} << 30;
constexpr std::size_t kHead = std::size_t{64} << 10;

bool IsTextByte(unsigned char byte) {
  return byte >= 0x20 || byte == '\t' || byte == '\n' || byte == '\r' || byte == '\f';
}

bool IsText(std::string_view head) {
  return std::all_of(head.begin(), head.end(), [](char c) { return IsTextByte(static_cast<unsigned char>(c)); });
}

// Every other byte of the beginning is zero, and the others are ASCII text: "le", "be" or nothing.
const char* Utf16Without(std::string_view bytes) {
  const std::size_t size = std::min<std::size_t>(bytes.size() & ~std::size_t{1}, 128);
  if (size < 8) return nullptr;
  for (const int zero : {1, 0}) {
    bool holds = true;
    for (std::size_t i = 0; i < size && holds; ++i) {
      const auto byte = static_cast<unsigned char>(bytes[i]);
      holds = static_cast<int>(i % 2) == zero ? byte == 0 : byte < 0x80 && IsTextByte(byte);
    }
    if (holds) return zero == 1 ? "UTF-16LE" : "UTF-16BE";
  }
  return nullptr;
}

// Text in any letters behind a mark of UTF-16: no control characters, and an end of a line.
bool IsUtf16Text(std::string_view bytes, bool little) {
  const std::size_t size = std::min(bytes.size() & ~std::size_t{1}, kHead);
  bool ends_line = false;
  for (std::size_t i = 0; i < size; i += 2) {
    const auto low = static_cast<unsigned char>(bytes[little ? i : i + 1]),
               high = static_cast<unsigned char>(bytes[little ? i + 1 : i]);
    if (high != 0) continue;
    if (!IsTextByte(low)) return false;
    ends_line = ends_line || low == '\n' || low == '\r';
  }
  return ends_line;
}

// Well-formed, up to a sequence that the end of the head cuts.
bool IsUtf8(std::string_view head) {
  for (std::size_t i = 0; i < head.size();) {
    const auto lead = static_cast<unsigned char>(head[i]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xc2 && lead < 0xe0 ? 2
                               : lead >= 0xe0 && lead < 0xf0 ? 3
                               : lead >= 0xf0 && lead < 0xf5 ? 4
                                                             : 0;
    if (length == 0) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if (i + k >= head.size()) return true;
      if ((static_cast<unsigned char>(head[i + k]) & 0xc0U) != 0x80U) return false;
    }
    i += length;
  }
  return true;
}

}  // namespace

DecodedFile::DecodedFile(const std::filesystem::path& path) : file_(path), rest_(file_.bytes()) {
  if (rest_.starts_with("\x1f\x8b")) Unpack();
  DecodeText();
}

void DecodedFile::Unpack() {
  z_stream stream = {};
  constexpr int kGzip = 15 + 16;  // the largest window, with the header of gzip
  if (inflateInit2(&stream, kGzip) != Z_OK)
    throw InputError(file_.path().string() + ": is packed by gzip; there is no memory to unpack it");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  std::string unpacked;
  std::size_t used = 0;
  std::string_view in = rest_;
  int result = Z_OK;
  while (true) {
    // A file may be several of gzip's in a row.
    if (result == Z_STREAM_END) {
      in = in.substr(in.size() - stream.avail_in);
      if (!in.starts_with("\x1f\x8b")) break;
      inflateReset(&stream);
    }
    if (stream.avail_in == 0) {
      if (in.empty()) break;
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
      stream.avail_in = static_cast<uInt>(std::min<std::size_t>(in.size(), std::size_t{1} << 30));
    }
    if (unpacked.size() - used < kHead) unpacked.resize(std::max(2 * unpacked.size(), 4 * rest_.size() + kHead));
    if (used > kMostUnpacked)
      throw InputError(file_.path().string() +
                       ": unpacks to more than 2 GiB; unpack it by hand and name the part that is needed");
    const std::size_t room = std::min<std::size_t>(unpacked.size() - used, std::size_t{1} << 30);
    stream.next_out = reinterpret_cast<Bytef*>(unpacked.data() + used);
    stream.avail_out = static_cast<uInt>(room);
    const uInt before = stream.avail_in;
    result = inflate(&stream, Z_NO_FLUSH);
    in.remove_prefix(before - stream.avail_in);
    used += room - stream.avail_out;
    if (result == Z_STREAM_END) continue;
    if (result != Z_OK || (stream.avail_in == 0 && in.empty() && stream.avail_out > 0)) {
      throw InputError(file_.path().string() + ": is packed by gzip and damaged or cut off after " +
                       std::to_string(used) + " bytes; fetch it again");
    }
  }
  unpacked.resize(used);
  decoded_ = std::move(unpacked);
  rest_ = {};
  remarks_.emplace_back("unpacked from gzip");
}

void DecodedFile::DecodeText() {
  const std::string_view all = bytes();
  const auto replace = [&](std::string text) {
    decoded_ = std::move(text);
    rest_ = {};
  };
  std::size_t marks = 0;  // two where a program wrote its own before that of the text
  while (all.substr(marks).starts_with("\xef\xbb\xbf")) marks += 3;
  if (marks > 0) {
    if (decoded_.empty()) {
      rest_.remove_prefix(marks);
    } else {
      decoded_.erase(0, marks);
    }
  } else if (const char* encoding = all.starts_with("\xff\xfe") && IsUtf16Text(all.substr(2), true) ? "UTF-16LE"
                                    : all.starts_with("\xfe\xff") && IsUtf16Text(all.substr(2), false)
                                        ? "UTF-16BE"
                                        : Utf16Without(all)) {
    const bool mark = all[0] == '\xff' || all[0] == '\xfe';
    replace(ToUtf8(all.substr(mark ? 2 : 0), encoding, file_.path()));
    remarks_.emplace_back("converted from UTF-16");
  } else if (const std::string_view head = all.substr(0, kHead); !IsUtf8(head) && IsText(head)) {
    // Numbers say nothing of the encoding; words stand at the beginning.
    constexpr std::size_t kWords = 4096;
    const std::string found = FindEncoding(all.substr(0, kWords));
    const bool western = found == "WINDOWS-1252";
    replace(ToUtf8(all, western ? "WINDOWS-1252//IGNORE" : found.c_str(), file_.path()));
    if (!western) remarks_.push_back("the text is no UTF-8 and was read as " + found);
  }
  const std::string_view head = bytes().substr(0, kHead);
  if (head.find('\r') != std::string_view::npos && head.find('\n') == std::string_view::npos && IsText(head)) {
    std::string text(bytes());
    std::replace(text.begin(), text.end(), '\r', '\n');
    replace(std::move(text));
  }
  TrimEnd();
}

// What DOS ends a text with, and the zeros up to where an instrument made room for it.
void DecodedFile::TrimEnd() {
  const std::string_view all = bytes();
  constexpr std::string_view kFill("\x1a\0", 2);
  if (all.empty() || kFill.find(all.back()) == std::string_view::npos) return;
  const std::size_t last = all.find_last_not_of(kFill);
  const std::size_t size = last == std::string_view::npos ? 0 : last + 1;
  if (!IsText(all.substr(0, std::min(size, kHead)))) return;
  if (decoded_.empty()) {
    rest_ = rest_.substr(0, size);
  } else {
    decoded_.resize(size);
  }
}

}  // namespace lobefit

#include "lobefit/maps/output/journal.h"

#include <algorithm>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::size_t kKeyDigits = 16;  // of the key in a band's name

// Bytes after the numbers: their digest, which a copy that broke off does not have.
constexpr std::size_t kDigestBytes = 32;

}  // namespace

MapJournal::MapJournal(std::filesystem::path folder, std::string key, std::size_t width, std::size_t height,
                       std::size_t planes)
    : folder_(std::move(folder)), key_(key.substr(0, kKeyDigits)), width_(width), height_(height), planes_(planes) {
  MakeFolder(folder_);
  Refresh();
}

void MapJournal::Refresh() {
  bands_.clear();
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    // KEY_FIRST_END.band
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".band" || name.rfind(key_ + "_", 0) != 0) continue;
    const std::string numbers = entry.path().stem().string().substr(kKeyDigits + 1);
    const std::vector<std::string_view> parts = Split(numbers, '_');
    if (parts.size() != 2) continue;
    const std::optional<long long> first = ParseInteger(parts[0]), end = ParseInteger(parts[1]);
    if (!first || !end || *first < 0 || *end <= *first || static_cast<std::size_t>(*end) > height_) continue;
    const Band band = {static_cast<std::size_t>(*first), static_cast<std::size_t>(*end), entry.path()};
    const std::uintmax_t bytes = std::filesystem::file_size(entry.path(), error);
    if (error || bytes != (band.end - band.first) * width_ * planes_ * sizeof(float) + kDigestBytes) continue;
    bands_.push_back(band);
  }
  std::sort(bands_.begin(), bands_.end(),
            [](const Band& a, const Band& b) { return a.first != b.first ? a.first < b.first : a.end > b.end; });
}

void MapJournal::Write(const MapRows& band) const {
  std::string bytes;
  bytes.reserve(planes_ * width_ * band.rows * sizeof(float) + kDigestBytes);
  for (const std::vector<float>& plane : band.values) {
    bytes.append(static_cast<const char*>(static_cast<const void*>(plane.data())), plane.size() * sizeof(float));
  }
  bytes += Sha256(bytes);
  WriteFileAtomically(folder_ / fmt::format("{}_{:06}_{:06}.band", key_, band.first_row, band.first_row + band.rows),
                      bytes);
}

std::vector<std::pair<std::size_t, std::size_t>> MapJournal::Missing() const {
  std::vector<std::pair<std::size_t, std::size_t>> gaps;
  std::size_t reached = 0;
  for (const Band& band : bands_) {
    if (band.first > reached) gaps.emplace_back(reached, band.first);
    reached = std::max(reached, band.end);
  }
  if (reached < height_) gaps.emplace_back(reached, height_);
  return gaps;
}

MapRows MapJournal::Read(std::size_t first, std::size_t end) const {
  MapRows rows = {first, end - first, width_, {}};
  rows.values.assign(planes_, std::vector<float>((end - first) * width_));
  for (const Band& band : bands_) {
    const std::size_t from = std::max(first, band.first), to = std::min(end, band.end);
    if (from >= to) continue;
    const FileBytes file(band.path);
    const std::string_view bytes = file.bytes();
    const std::size_t size = (band.end - band.first) * width_ * planes_ * sizeof(float);
    if (bytes.size() != size + kDigestBytes || Sha256(bytes.substr(0, size)) != bytes.substr(size)) {
      throw InputError(PrintableName(band.path) + ": is not whole; remove it and run the same command again");
    }
    for (std::size_t plane = 0; plane < planes_; ++plane) {
      const std::size_t offset = (plane * (band.end - band.first) + (from - band.first)) * width_ * sizeof(float);
      std::memcpy(rows.values[plane].data() + (from - first) * width_, bytes.data() + offset,
                  (to - from) * width_ * sizeof(float));
    }
  }
  return rows;
}

void MapJournal::Remove() const {
  std::error_code ignored;
  for (const Band& band : bands_) std::filesystem::remove(band.path, ignored);
  std::filesystem::remove(folder_, ignored);
}

}  // namespace lobefit

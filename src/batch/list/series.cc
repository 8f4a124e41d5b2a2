#include "lobefit/batch/list/series.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <glob.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/read.h"
#include "lobefit/io/series.h"

namespace lobefit {
namespace {

using Path = std::filesystem::path;
constexpr std::string_view kPattern = "*?[";
// PATH_MAX of Linux: no file has a longer name, and a pattern of half a million folders takes gigabytes.
constexpr std::size_t kLongestName = 4096;

// The name without what a pattern leaves open, and without keys.
std::string_view Fixed(std::string_view name) {
  name = name.substr(0, name.find_first_of(kPattern));
  const std::size_t equals = name.find('=');
  return equals == std::string_view::npos ? name : name.substr(0, name.rfind(':', equals));
}

std::vector<Path> Measurements(const Path& folder, bool any_rows) {
  std::vector<Path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const bool hidden = entry.path().filename().string().starts_with('.');
    if (!hidden && entry.is_regular_file() && HoldsMeasurement(entry.path(), any_rows)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Path> Matches(const std::string& pattern, const Path& folder) {
  // The folder's own name is no pattern.
  std::string whole;
  if (!Path(pattern).is_absolute()) {
    for (const char c : (folder / "").string()) {
      if (kPattern.find(c) != std::string_view::npos || c == '\\') whole += '\\';
      whole += c;
    }
  }
  whole += pattern;
  glob_t found = {};
  std::vector<Path> files;
  if (glob(whole.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) {
      if (std::filesystem::is_regular_file(found.gl_pathv[i])) files.emplace_back(found.gl_pathv[i]);
    }
  }
  globfree(&found);
  std::sort(files.begin(), files.end());
  return files;
}

// As listed: relative where it was.
std::string Listed(const Path& file, const Path& folder, bool relative) {
  return relative ? file.lexically_relative(folder).string() : file.string();
}

}  // namespace

std::vector<std::string> ListSeries(const std::string& cell, const Path& folder, bool any_rows) {
  std::error_code error;
  std::vector<std::string> parts;
  if (cell.size() <= kLongestName && std::filesystem::exists(folder / cell, error)) {
    parts = {cell};
  } else {
    for (const std::string_view part : Split(cell, ';')) {
      if (!Trim(part).empty()) parts.emplace_back(Trim(part));
    }
  }
  std::vector<std::string> members;
  for (const std::string& part : parts) {
    if (part.size() > kLongestName) {
      throw InputError(fmt::format("'{}' has {} bytes; the name of a file has at most {}", Excerpt(part, 80),
                                   part.size(), kLongestName));
    }
    const FileSpec spec = ParseFileSpec((folder / part).string());
    const bool relative = Path(part).is_relative(), there = std::filesystem::exists(spec.path, error),
               is_folder = std::filesystem::is_directory(spec.path, error);
    if (!is_folder && (there || part.find_first_of(kPattern) == std::string::npos)) {
      members.push_back(part);
      continue;
    }
    const std::vector<Path> files = is_folder ? Measurements(spec.path, any_rows) : Matches(part, folder);
    if (files.empty()) {
      throw InputError(
          fmt::format("'{}' {}; a row names a file, or a folder, pattern or list of files that are one "
                      "measurement",
                      Excerpt(part, 200), is_folder ? "is a folder without measurement files" : "matches no file"));
    }
    const std::string keys = spec.keys.empty() ? "" : ":" + Join(spec.keys, ",");
    for (const Path& file : files) members.push_back(Listed(file, folder, relative) + keys);
  }
  std::set<Path> seen;
  for (const std::string& member : members) {
    const Path path = ParseFileSpec((folder / member).string()).path;
    if (!seen.insert(path.lexically_normal()).second)
      throw InputError(fmt::format("'{}' is named twice; name each file of a series once", Excerpt(member, 200)));
  }
  return members;
}

std::string SeriesId(const std::string& cell) {
  const std::vector<std::string_view> parts = Split(cell, ';');
  std::string_view common = Fixed(Trim(parts.front()));
  for (const std::string_view part : parts) {
    const std::string_view fixed = Fixed(Trim(part));
    if (fixed.empty()) continue;
    const auto differ = std::mismatch(common.begin(), common.end(), fixed.begin(), fixed.end());
    common = common.substr(0, static_cast<std::size_t>(differ.first - common.begin()));
  }
  const std::size_t last = common.find_last_not_of("_-. /");
  return std::string(common.substr(0, last == std::string_view::npos ? 0 : last + 1));
}

}  // namespace lobefit

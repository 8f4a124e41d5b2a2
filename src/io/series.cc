#include "lobefit/io/series.h"

#include <algorithm>
#include <set>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/read.h"
#include "lobefit/measurement/prepare/pool.h"

namespace lobefit {
namespace {

struct Folder {
  std::set<std::filesystem::path> measurements;
  std::vector<std::string> others;
};

// "2 files that hold no measurement (README.txt, notes.pdf)"
std::string Words(const std::vector<std::string>& others) {
  constexpr std::size_t kNamed = 5;
  std::vector<std::string> some(others.begin(),
                                others.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, others.size())));
  return std::to_string(others.size()) + (others.size() == 1 ? " file that holds" : " files that hold") +
         " no measurement (" + Join(some) + (others.size() > kNamed ? ", ...)" : ")");
}

// Hidden files and results of this program are no part of a series; what else holds no measurement is named.
Folder ListFolder(const std::filesystem::path& path, bool any_rows) {
  Folder folder;
  std::set<std::string> others;
  bool folders = false;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(path)) {
    const std::string name = entry.path().filename().string();
    const bool result = name.ends_with(".report.png") || name.ends_with(".report.html");
    folders = folders || entry.is_directory();
    if (!entry.is_regular_file() || name.starts_with('.') || result) continue;
    if (HoldsMeasurement(entry.path(), any_rows)) {
      folder.measurements.insert(entry.path());
    } else if (!name.ends_with(".json")) {
      others.insert(Excerpt(name));
    }
  }
  folder.others.assign(others.begin(), others.end());
  if (folder.measurements.empty()) {
    throw InputError(path.string() + ": is a folder without measurement files" +
                     (others.empty() ? "" : "; it holds " + Words(folder.others)) +
                     (folders ? "; the folders in it are not looked into" : "") +
                     "; name a file, or a folder that holds a series");
  }
  return folder;
}

}  // namespace

FileSpec ParseFileSpec(const std::string& text) {
  std::error_code ignored;
  if (std::filesystem::exists(text, ignored)) return {text, {}};
  std::size_t colon = text.find(':');
  while (colon != std::string::npos) {
    const std::size_t equals = text.find('=', colon);
    if (equals == std::string::npos) break;
    const std::string path = text.substr(0, colon);
    if (std::filesystem::exists(path, ignored)) {
      FileSpec spec = {path, {}};
      for (const std::string_view key : Split(std::string_view(text).substr(colon + 1), ','))
        spec.keys.emplace_back(Trim(key));
      return spec;
    }
    colon = text.find(':', colon + 1);
  }
  return {text, {}};
}

Measurement ReadSeries(const std::vector<std::string>& specs, const ReadOptions& options) {
  std::vector<FileSpec> files;
  std::vector<std::string> remarks;
  for (const std::string& text : specs) {
    const FileSpec spec = ParseFileSpec(text);
    if (!std::filesystem::is_directory(spec.path)) {
      files.push_back(spec);
      continue;
    }
    const Folder folder = ListFolder(spec.path, !options.columns.empty());
    for (const std::filesystem::path& path : folder.measurements) files.push_back({path, spec.keys});
    if (!folder.others.empty()) remarks.push_back(spec.path.string() + " holds " + Words(folder.others) + " too");
  }
  std::set<std::string> seen;
  for (const FileSpec& file : files) {
    // A pipe has no name to resolve: that of `<(...)` is a link to nothing.
    const std::filesystem::path place = IsStream(file.path) ? file.path : std::filesystem::weakly_canonical(file.path);
    if (!seen.insert(place.string()).second)
      throw UsageError(file.path.string() + ": is named twice; name each file of a series once");
  }
  const auto with_remarks = [&](Measurement measurement) {
    measurement.remarks.insert(measurement.remarks.end(), remarks.begin(), remarks.end());
    return measurement;
  };
  if (files.size() == 1) return with_remarks(ReadMeasurement(files[0].path, WithKeys(options, files[0].keys)));
  std::vector<Measurement> parts;
  for (const FileSpec& file : files) parts.push_back(ReadPart(file.path, WithKeys(options, file.keys)));
  const bool merge = options.repeated.value_or(RepeatedRows::kMean) == RepeatedRows::kMean;
  return with_remarks(FinishReading(Pool(std::move(parts), merge), options));
}

std::vector<std::filesystem::path> InputPaths(const std::vector<std::string>& files) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& file : files) {
    const std::filesystem::path path = ParseFileSpec(file).path;
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
      paths.push_back(path);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) paths.push_back(entry.path());
  }
  return paths;
}

}  // namespace lobefit

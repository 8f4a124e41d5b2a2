#include "lobefit/io/series.h"

#include <algorithm>
#include <set>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/io/read.h"
#include "lobefit/measurement/pool.h"

namespace lobefit {

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
  for (const std::string& text : specs) {
    const FileSpec spec = ParseFileSpec(text);
    if (!std::filesystem::is_directory(spec.path)) {
      files.push_back(spec);
      continue;
    }
    std::set<std::filesystem::path> inside;
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(spec.path)) {
      const std::string name = entry.path().filename().string();
      // Hidden files and results of this program are no part of a series.
      if (entry.is_regular_file() && !name.starts_with('.') && !name.ends_with(".json") &&
          !name.ends_with(".report.png") && !name.ends_with(".report.html"))
        inside.insert(entry.path());
    }
    if (inside.empty())
      throw InputError(spec.path.string() +
                       ": is a folder without measurement files; name a file, or a folder that holds a series");
    for (const std::filesystem::path& path : inside) files.push_back({path, spec.keys});
  }
  std::set<std::string> seen;
  for (const FileSpec& file : files) {
    // A pipe has no name to resolve: that of `<(...)` is a link to nothing.
    const std::filesystem::path place = IsStream(file.path) ? file.path : std::filesystem::weakly_canonical(file.path);
    if (!seen.insert(place.string()).second)
      throw UsageError(file.path.string() + ": is named twice; name each file of a series once");
  }
  if (files.size() == 1) return ReadMeasurement(files[0].path, WithKeys(options, files[0].keys));
  std::vector<Measurement> parts;
  for (const FileSpec& file : files) parts.push_back(ReadPart(file.path, WithKeys(options, file.keys)));
  return FinishReading(Pool(std::move(parts), options.repeated.value_or(RepeatedRows::kMean) == RepeatedRows::kMean),
                       options);
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

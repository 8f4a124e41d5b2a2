#include "lobefit/batch/list/inputs.h"

#include <algorithm>
#include <array>
#include <deque>
#include <fstream>
#include <iostream>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/list/series.h"
#include "lobefit/io/csv/reader.h"
#include "lobefit/io/read.h"
#include "lobefit/io/series.h"
#include "lobefit/io/text/decoded_file.h"

namespace lobefit {
namespace {

using Path = std::filesystem::path;

std::uint64_t SizeOf(const Path& path) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  return error ? 0 : bytes;
}

// Of a large table the beginning tells that it is no text: a zero, and no byte order mark of UTF-16.
bool IsBinary(const Path& path) {
  std::array<char, 512> head = {};
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), head.size());
  const std::string_view bytes(head.data(), static_cast<std::size_t>(file.gcount()));
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) return false;
  return bytes.find('\0') != std::string_view::npos;
}

class Gatherer {
 public:
  Gatherer(const OptionWords& common, const ManifestNames& names, const Path& out, const WorkList& known,
           bool only_input)
      : common_(common), names_(names), out_(std::filesystem::weakly_canonical(out)), only_input_(only_input) {
    for (const Task& task : known.tasks) known_[task.path.string()] = task.bytes;
  }

  void Add(const std::string& input) {
    std::error_code error;
    if (input == "-") return AddStandardInput();
    if (std::filesystem::is_directory(input, error)) return AddFolder(input);
    if (!std::filesystem::exists(input, error)) {
      throw InputError(
          fmt::format("{}: is not there; name a file, a folder, a manifest, or - for names on standard "
                      "input",
                      Excerpt(input, 200)));
    }
    if (!std::filesystem::is_regular_file(input, error)) {
      throw InputError(
          fmt::format("{}: is a pipe or device; a batch goes on after an interruption, so that it needs files",
                      Excerpt(input, 200)));
    }
    if (IsManifest(input)) return AddManifest(input);
    AddFile(input, fmt::format("argument '{}'", Excerpt(input, 200)));
  }

  Inputs Finish() {
    if (gathered_.list.tasks.empty()) {
      throw InputError(fmt::format("there is nothing to fit: no file of a known format was found{}",
                                   gathered_.skipped > 0 ? fmt::format(" among {}", gathered_.skipped) : ""));
    }
    Check();
    // Columns that only some manifests have are empty for the others.
    for (Task& task : gathered_.list.tasks) task.extra.resize(gathered_.list.extra_columns.size());
    SortBySize(&gathered_.list);
    return std::move(gathered_);
  }

 private:
  // What cannot be read is a measurement that fails, while the others go on.
  bool IsManifest(const std::string& input) const {
    if (IsBinary(input)) return false;
    try {
      const DecodedFile file(input);
      // Alone it can only have been meant as a list; among others it is a measurement that fails.
      if (file.bytes().empty() && only_input_) return true;
      if (LooksLikeManifest(file.bytes(), names_)) return true;
      // Said of a list, not done to a measurement that has such a column.
      return ListsFilesBetweenOthers(file.bytes()) && !NamesDirections({input, file.bytes()});
    } catch (const InputError&) {
      return false;
    }
  }

  void Append(Task task) {
    for (const auto& [name, words] : common_) task.options.emplace(name, words);
    for (const std::string& file : FilesToFit(task)) task.bytes += SizeOf(ParseFileSpec(file).path);
    gathered_.list.tasks.push_back(std::move(task));
  }

  void AddFile(const std::string& file, const std::string& place) {
    Append({IdOf(file), file, std::filesystem::absolute(file).lexically_normal(), 0, {}, "", {}, place});
  }

  // A folder is a series here, as in a manifest: each name of a list is one task.
  void AddListed(const std::string& file, const std::string& place) {
    if (file.find('\0') != std::string::npos)
      throw InputError(place + ": holds a zero byte; give one name a line, as `find -type f` without -print0 does");
    std::error_code error;
    if (!std::filesystem::is_directory(file, error)) return AddFile(file, place);
    const Path folder = std::filesystem::current_path();
    try {
      Append({IdOf(file), file, folder, 0, {}, "", {}, place, ListSeries(file, folder, common_.contains("columns"))});
    } catch (const InputError& reason) {
      throw InputError(place + ": " + reason.what());
    }
  }

  void AddStandardInput() {
    std::string line;
    for (std::size_t number = 1; std::getline(std::cin, line); ++number) {
      const std::string name(Trim(line));
      if (!name.empty()) AddListed(name, fmt::format("standard input, line {}", number));
    }
  }

  void AddManifest(const std::string& input) {
    const DecodedFile file(input);
    const WorkList rows = ParseManifest(file.bytes(), input, names_);
    std::vector<std::size_t> to;
    std::vector<std::string>& columns = gathered_.list.extra_columns;
    for (const std::string& name : rows.extra_columns) {
      to.push_back(static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin()));
      if (to.back() == columns.size()) columns.push_back(name);
    }
    for (Task task : rows.tasks) {
      std::vector<std::string> extra(columns.size());
      for (std::size_t i = 0; i < to.size(); ++i) extra[to[i]] = task.extra[i];
      task.extra = extra;
      Append(std::move(task));
    }
  }

  bool IsMeasurement(const Path& path) const {
    const auto known = known_.find(std::filesystem::absolute(path).lexically_normal().string());
    if (known != known_.end() && known->second == SizeOf(path)) return true;
    return HoldsMeasurement(path, common_.contains("columns"));
  }

  void Skip(const Path& path) {
    constexpr std::size_t kNamed = 5;
    if (gathered_.skipped++ < kNamed) gathered_.some_skipped.push_back(path.string());
  }

  void AddFolder(const Path& folder) {
    std::vector<Path> files;
    try {
      std::filesystem::recursive_directory_iterator walk(folder);
      for (; walk != std::filesystem::recursive_directory_iterator(); ++walk) {
        std::error_code error;
        const bool hidden = walk->path().filename().string().starts_with(".");
        const bool ours = walk->is_directory(error) && std::filesystem::weakly_canonical(walk->path()) == out_;
        if (hidden || ours) walk.disable_recursion_pending();
        if (hidden) continue;
        if (walk->is_regular_file(error)) {
          files.push_back(walk->path());
        } else if (walk->is_symlink(error) && !walk->exists(error)) {
          Skip(walk->path());  // a link that leads nowhere, or to itself
        }
      }
    } catch (const std::filesystem::filesystem_error& error) {
      throw InputError(fmt::format("{}: cannot be searched: {}; check the permissions, or name the files",
                                   Excerpt(error.path1().empty() ? folder.string() : error.path1().string(), 200),
                                   error.code().message()));
    }
    std::sort(files.begin(), files.end());
    for (const Path& path : files) {
      const std::string file = path.lexically_relative(folder).generic_string();
      if (!IsMeasurement(path)) {
        Skip(path);
        continue;
      }
      Append({IdOf(file), file, std::filesystem::absolute(path).lexically_normal(), 0, {}, "", {}, path.string()});
    }
  }

  static void CheckId(const Task& task) {
    constexpr std::size_t kMost = 200;  // of a component; the endings of results and temporary names come to it
    const Path id(task.id);
    bool fine = !task.id.empty() && id.is_relative() && id.lexically_normal().string() == task.id &&
                id.has_filename() &&
                std::none_of(task.id.begin(), task.id.end(), [](char c) { return c >= 0 && c < ' '; });
    for (const Path& part : id) fine = fine && part != ".." && part != "." && part.string().size() <= kMost;
    if (!fine) {
      throw InputError(
          fmt::format("{}: id '{}' is no relative path with components of at most {} bytes; results are "
                      "named by it",
                      task.place, Excerpt(task.id, 80), kMost));
    }
  }

  // Lists and records are JSON, which holds no other bytes: the name could not be found again.
  static void CheckUtf8(const Task& task) {
    const auto is_fine = [](std::string_view text) {
      while (!text.empty()) {
        const std::size_t length = Utf8Length(text);
        if (length == 0) return false;
        text.remove_prefix(length);
      }
      return true;
    };
    bool fine = is_fine(task.id) && is_fine(task.file) && is_fine(task.path.native());
    for (const std::string& member : task.members) fine = fine && is_fine(member);
    if (fine) return;
    throw InputError(
        fmt::format("{}: the name '{}' is not UTF-8, in which lists and results are written; rename the file or folder",
                    task.place, Excerpt(task.members.empty() ? task.path.native() : task.file, 200)));
  }

  // Whether the id needs a folder where the results of another one lie.
  static void CheckFolders(const Task& task, const std::unordered_map<std::string_view, const Task*>& ids) {
    for (Path folder = Path(task.id).parent_path(); !folder.empty(); folder = folder.parent_path()) {
      for (const std::string ending : {".material.json", ".report.png", ".report.html"}) {
        const std::string_view name = folder.native();
        const auto other = name.ends_with(ending) ? ids.find(name.substr(0, name.size() - ending.size())) : ids.end();
        if (other == ids.end()) continue;
        throw InputError(
            fmt::format("{}: the id '{}' needs a folder that is named as a result of '{}' ({}); give one of "
                        "them another id",
                        task.place, Excerpt(task.id, 80), Excerpt(other->second->id, 80), other->second->place));
      }
    }
  }

  void Check() const {
    // Of the tasks' own texts, which a hundred thousand need not have twice; those of series are made here.
    std::unordered_map<std::string_view, const Task*> ids, files;
    std::deque<std::string> of_series;
    for (const Task& task : gathered_.list.tasks) {
      CheckUtf8(task);
      CheckId(task);
      if (!task.members.empty()) of_series.push_back(Join(FilesToFit(task), "\n"));
      const std::string_view key =
          task.members.empty() ? std::string_view(task.path.native()) : std::string_view(of_series.back());
      const auto [same_file, new_file] = files.emplace(key, &task);
      if (!new_file && same_file->second->options == task.options) {
        throw InputError(
            fmt::format("{}: '{}' is listed already ({}); remove one, or give them different options and "
                        "ids",
                        task.place, Excerpt(task.file, 200), same_file->second->place));
      }
      const auto [same_id, new_id] = ids.emplace(task.id, &task);
      if (!new_id) {
        throw InputError(
            fmt::format("{}: the id '{}' of '{}' is that of '{}' too ({}); give each an id of its own in a "
                        "manifest",
                        task.place, Excerpt(task.id, 80), Excerpt(task.file, 200), Excerpt(same_id->second->file, 200),
                        same_id->second->place));
      }
    }
    for (const Task& task : gathered_.list.tasks) CheckFolders(task, ids);
  }

  const OptionWords& common_;
  const ManifestNames& names_;
  const Path out_;
  const bool only_input_;
  std::unordered_map<std::string, std::uint64_t> known_;  // sizes by path
  Inputs gathered_;
};

}  // namespace

Inputs GatherInputs(const std::vector<std::string>& inputs, const OptionWords& common, const ManifestNames& names,
                    const Path& out, const WorkList& known) {
  Gatherer gatherer(common, names, out, known, inputs.size() == 1);
  for (const std::string& input : inputs) gatherer.Add(input);
  return gatherer.Finish();
}

void SetSettings(const std::function<std::string(const OptionWords&)>& settings_of, WorkList* list) {
  std::map<OptionWords, std::string> known;
  for (Task& task : list->tasks) {
    auto found = known.find(task.options);
    if (found == known.end()) {
      try {
        found = known.emplace(task.options, settings_of(task.options)).first;
      } catch (const Error& error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", task.place, error.what()));
      }
    }
    std::string keys;
    for (const std::string& file : FilesToFit(task)) keys += Join(ParseFileSpec(file).keys, ",") + "\n";
    const bool stated = keys.find_first_not_of('\n') != std::string::npos;
    task.settings = stated ? Sha256Hex(found->second + "\n" + keys) : found->second;
  }
}

}  // namespace lobefit

#include "lobefit/batch/list/work_list.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/base/version.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* kFormat = "lobefit work list";

std::filesystem::path PathOf(const std::filesystem::path& out) { return out / "worklist.jsonl"; }

std::string Line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::string ToText(const WorkList& list) {
  std::string text = Line({{"format", kFormat}, {"version", Version()}, {"extra_columns", list.extra_columns}});
  for (const Task& task : list.tasks) {
    Json json = {{"id", task.id},       {"file", task.file},       {"path", task.path.string()},
                 {"bytes", task.bytes}, {"options", task.options}, {"settings", task.settings},
                 {"extra", task.extra}};
    if (!task.members.empty()) json["members"] = task.members;
    text += Line(json);
  }
  return text;
}

std::string OptionText(const OptionWords& options) {
  std::string text;
  for (const auto& [name, words] : options) text += (text.empty() ? "--" : " --") + name + " " + words;
  return text.empty() ? "no options" : text;
}

// The tasks of `list` by id.
std::unordered_map<std::string_view, const Task*> ById(const WorkList& list) {
  std::unordered_map<std::string_view, const Task*> tasks;
  for (const Task& task : list.tasks) tasks.emplace(task.id, &task);
  return tasks;
}

void CheckContains(const WorkList& list, const WorkList& stored, const std::filesystem::path& out) {
  const std::unordered_map<std::string_view, const Task*> now = ById(list);
  for (const Task& task : stored.tasks) {
    const auto found = now.find(task.id);
    if (found == now.end()) {
      throw UsageError(fmt::format(
          "{}: holds the batch of another list: its task '{}' ({}) is not in this one; choose another --out, list that "
          "file too, or go on with the stored list: lobefit batch --out {}",
          out.string(), Excerpt(task.id, 200), Excerpt(task.file, 200), out.string()));
    }
    if (found->second->settings != task.settings) {
      throw UsageError(fmt::format(
          "{}: '{}' is listed with {}, but {} holds it with {}{}; choose another --out, or the same options",
          found->second->place, Excerpt(task.id, 200), OptionText(found->second->options), out.string(),
          OptionText(task.options),
          found->second->options == task.options ? ", where its recipe's text or keys of its files were others"
                                                 : std::string()));
    }
  }
}

}  // namespace

void SortBySize(WorkList* list) {
  std::sort(list->tasks.begin(), list->tasks.end(),
            [](const Task& a, const Task& b) { return a.bytes != b.bytes ? a.bytes > b.bytes : a.id < b.id; });
}

std::vector<std::string> FilesToFit(const Task& task) {
  if (task.members.empty()) return {task.path.string()};
  std::vector<std::string> files;
  for (const std::string& member : task.members) files.push_back((task.path / member).string());
  return files;
}

std::string TaskKey(const std::string& content_sha256, const std::string& settings) {
  return Sha256Hex(content_sha256 + "\n" + settings + "\n");
}

WorkList ReadWorkList(const std::filesystem::path& out) {
  const std::filesystem::path path = PathOf(out);
  std::error_code error;
  WorkList list;
  if (!std::filesystem::exists(path, error)) return list;
  const FileBytes file(path);
  LineReader lines(file.bytes());
  std::string_view line;
  try {
    while (lines.Next(&line)) {
      const Json json = Json::parse(line);
      if (lines.line_number() > 1) {
        list.tasks.push_back({json.at("id").get<std::string>(), json.at("file").get<std::string>(),
                              json.at("path").get<std::string>(), json.at("bytes").get<std::uint64_t>(),
                              json.at("options").get<OptionWords>(), json.at("settings").get<std::string>(),
                              json.at("extra").get<std::vector<std::string>>(),
                              fmt::format("{}, line {}", path.string(), lines.line_number())});
        if (json.contains("members")) json.at("members").get_to(list.tasks.back().members);
        continue;
      }
      if (json.at("format") != kFormat) throw InputError(path.string() + ": is not a work list; choose another --out");
      if (const std::string version = json.at("version").get<std::string>(); version != Version()) {
        throw InputError(
            fmt::format("{}: is of version {}, this is {}; results of two versions are not mixed: choose "
                        "another --out",
                        path.string(), version, Version()));
      }
      list.extra_columns = json.at("extra_columns").get<std::vector<std::string>>();
    }
  } catch (const Json::exception&) {
    throw InputError(fmt::format("{}, line {}: is not a line of a work list; choose another --out", path.string(),
                                 lines.line_number()));
  }
  return list;
}

void StoreWorkList(const WorkList& list, const std::filesystem::path& out) {
  const WorkList stored = ReadWorkList(out);
  CheckContains(list, stored, out);
  MakeFolder(out);
  const std::string text = ToText(list);
  if (stored.tasks.size() == list.tasks.size() && ToText(stored) == text) return;
  WriteFileAtomically(PathOf(out), text);
}

std::filesystem::path ResultPath(const std::filesystem::path& out, const std::string& id, const std::string& ending) {
  return out / "documents" / (id + ending);
}

}  // namespace lobefit

#include "lobefit/batch/list/manifest.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/list/csv_text.h"
#include "lobefit/batch/list/series.h"
#include "lobefit/io/series.h"

namespace lobefit {
namespace {

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// What each column is for.
struct Header {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t file = kNone, id = kNone;
  std::map<std::size_t, std::string> options, extra;
};

Header ReadHeader(const std::vector<std::string>& fields, const std::string& name, const ManifestNames& names) {
  Header header;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string& field = fields[i];
    if (field.empty())
      throw InputError(fmt::format("{}, line 1: column {} has no name; name or remove it", name, i + 1));
    if (!seen.insert(field).second)
      throw InputError(fmt::format("{}, line 1: column '{}' is there twice; remove one", name, Excerpt(field)));
    if (field == "file") {
      header.file = i;
    } else if (field == "id") {
      header.id = i;
    } else if (Contains(names.options, field)) {
      header.options[i] = field;
    } else if (Contains(names.refused, field)) {
      throw InputError(
          fmt::format("{}, line 1: '{}' is no option of a single file; give --{} on the command line, or "
                      "remove the column",
                      name, field, field));
    } else if (Contains(names.reserved, field)) {
      throw InputError(
          fmt::format("{}, line 1: column '{}' is one of the results' own; rename it", name, Excerpt(field)));
    } else {
      header.extra[i] = field;
    }
  }
  if (header.file == Header::kNone) {
    const bool other = ListsFilesBetweenOthers(Join(fields, ","));
    throw InputError(fmt::format("{}, line 1: a manifest needs the column 'file'; its columns are {}{}", name,
                                 Excerpt(Join(fields), 200), other ? "; write commas between the columns" : ""));
  }
  return header;
}

// The word, or the file that it names, whatever folder the fit runs in.
std::string WithFolder(const std::string& word, const std::string& option, const std::filesystem::path& folder,
                       const ManifestNames& names) {
  std::error_code error;
  const std::filesystem::path path = (folder / word).lexically_normal();
  return Contains(names.of_files, option) && std::filesystem::is_regular_file(path, error) ? path.string() : word;
}

// One file stays as it was listed, whether it is there or not.
void TakeFiles(const std::filesystem::path& folder, Task* task) {
  try {
    const std::vector<std::string> files = ListSeries(task->file, folder, task->options.contains("columns"));
    if (files.size() == 1 && files[0] == task->file) {
      const FileSpec spec = ParseFileSpec((folder / task->file).string());
      task->path = spec.path.lexically_normal();
      if (spec.keys.empty()) return;
    }
    task->path = folder.lexically_normal();
    task->members = files;
  } catch (const InputError& error) {
    throw InputError(task->place + ": " + error.what());
  }
}

}  // namespace

bool LooksLikeManifest(std::string_view text, const ManifestNames& names) {
  std::vector<std::string> fields;
  try {
    CsvRecords records(text.substr(0, std::min(text.find('\n'), std::size_t{65536})), "");
    if (!records.Next(&fields)) return false;
  } catch (const InputError&) {
    return false;
  }
  return std::any_of(fields.begin(), fields.end(), [&](const std::string& field) {
    return field == "file" || field == "id" || Contains(names.options, field);
  });
}

bool ListsFilesBetweenOthers(std::string_view text) {
  const std::string_view head = text.substr(0, std::min(text.find('\n'), std::size_t{65536}));
  for (const char separator : {';', '\t'}) {
    const std::vector<std::string_view> fields = Split(head, separator);
    if (std::any_of(fields.begin(), fields.end(), [](std::string_view field) { return Trim(field) == "file"; }))
      return fields.size() > 1;
  }
  return false;
}

std::string IdOf(const std::string& file) {
  const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
  std::filesystem::path id;
  for (const std::filesystem::path& part : path.relative_path()) {
    if (part != ".." && part != ".") id /= part;
  }
  return id.generic_string();
}

WorkList ParseManifest(std::string_view text, const std::filesystem::path& path, const ManifestNames& names) {
  const std::string name = path.string();
  CsvRecords records(text, name);
  std::vector<std::string> fields;
  if (!records.Next(&fields))
    throw InputError(name + ": is empty; a manifest has a header with the column 'file' and a row for each file");
  const Header header = ReadHeader(fields, name, names);
  WorkList list;
  for (const auto& [column, extra] : header.extra) list.extra_columns.push_back(extra);
  const std::size_t columns = fields.size();
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  while (records.Next(&fields)) {
    const std::string place = fmt::format("{}, line {}", name, records.line_number());
    if (fields.size() != columns)
      throw InputError(fmt::format("{}: has {} fields, the header has {}", place, fields.size(), columns));
    Task task;
    task.file = fields[header.file];
    if (task.file.empty()) throw InputError(place + ": names no file");
    for (const auto& [column, option] : header.options) {
      if (!fields[column].empty()) task.options[option] = WithFolder(fields[column], option, folder, names);
    }
    for (const auto& [column, extra] : header.extra) task.extra.push_back(fields[column]);
    task.place = place;
    TakeFiles(folder, &task);
    const bool has_id = header.id != Header::kNone && !fields[header.id].empty();
    task.id = has_id ? fields[header.id] : IdOf(task.members.empty() ? task.file : SeriesId(task.file));
    if (task.id.empty()) {
      throw InputError(fmt::format("{}: '{}' holds no beginning that the results can be named by; give the row an id",
                                   place, Excerpt(task.file, 80)));
    }
    list.tasks.push_back(task);
  }
  if (list.tasks.empty()) throw InputError(name + ": lists no file; a manifest has a row for each file");
  return list;
}

}  // namespace lobefit

// The work of a batch: which files are fitted, with which options. It is stored in the results' folder, so that every
// process of it, now or later, here or on another machine, means the same work.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lobefit {

// Options of `lobefit fit` by long name without dashes, and their words.
using OptionWords = std::map<std::string, std::string>;

struct Task {
  std::string id;              // names the results; a relative path without ".."
  std::string file;            // as listed
  std::filesystem::path path;  // of the file, or the folder to which those of a series are relative; absolute
  std::uint64_t bytes = 0;     // of the files when they were listed
  OptionWords options;
  // SHA-256 of what decides the result beside the files: the options with their recipe, keys stated for files, and the
  // version.
  std::string settings;
  std::vector<std::string> extra;  // of the columns that are passed through
  std::string place;               // where the task was listed, for messages: "work.csv, line 3"; not stored
  // Of a series, whose files are one measurement: their names, perhaps with keys: "scan_10.csv:theta_i=10". Empty:
  // `path` is the only file.
  std::vector<std::string> members = {};
};

// The task's files as `lobefit fit` takes them, absolute.
std::vector<std::string> FilesToFit(const Task& task);

struct WorkList {
  std::vector<std::string> extra_columns;
  std::vector<Task> tasks;  // biggest first, then by id
};

// Biggest first, so that what takes long does not begin last; the order does not depend on how the list was given.
void SortBySize(WorkList* list);

// SHA-256 of file content and settings: what is fitted already under this key need not be fitted again.
std::string TaskKey(const std::string& content_sha256, const std::string& settings);

// The list that `out` holds; an empty one where it holds none. Throws InputError for one that cannot be read, or is of
// another version.
WorkList ReadWorkList(const std::filesystem::path& out);

// Makes `out` and stores the list there. Where it holds one already, that one must be contained in it: a batch may
// grow, but a task that vanished or has other settings makes it another batch, which throws UsageError with both
// places and a cure. Throws OutputError.
void StoreWorkList(const WorkList& list, const std::filesystem::path& out);

// Where the results of a task lie: OUT/documents/ID.material.json and its like.
std::filesystem::path ResultPath(const std::filesystem::path& out, const std::string& id, const std::string& ending);

}  // namespace lobefit

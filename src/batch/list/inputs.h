// What the user names on the command line, as a list of work.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lobefit/batch/list/manifest.h"
#include "lobefit/batch/list/work_list.h"

namespace lobefit {

struct Inputs {
  WorkList list;
  std::size_t skipped = 0;                // files of folders that hold no measurement
  std::vector<std::string> some_skipped;  // the first few of them
};

// Each of `inputs` is a file, a folder (searched for measurements, recursively, by content, of text with separators
// what names a direction; hidden files, links to folders and what lies in `out` are passed over), a manifest, or "-"
// for names on standard input, one on a line, of files and of folders that each are one series. Options of `common`
// hold where a manifest says nothing. Throws InputError and UsageError, with both places, for equal ids, a file that is
// listed twice, an id that is no relative path; InputError for a name that is not there and where no file is left.
// Files that `known`, the stored list, has with the same size are not looked into again. A file that a list names but
// that is not there is a task, which will fail.
Inputs GatherInputs(const std::vector<std::string>& inputs, const OptionWords& common, const ManifestNames& names,
                    const std::filesystem::path& out, const WorkList& known);

// Sets Task::settings of each by `settings_of` and keys stated for its files. The function throws UsageError and
// InputError for options that are not valid; their message gets the task's place. Called once for equal options.
void SetSettings(const std::function<std::string(const OptionWords&)>& settings_of, WorkList* list);

}  // namespace lobefit

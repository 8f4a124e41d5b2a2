// A manifest: CSV with a column `file`, which may bring ids, options of `lobefit fit`, and columns of the user's own.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/batch/list/work_list.h"

namespace lobefit {

// What a manifest's columns may mean beside `file` and `id`.
struct ManifestNames {
  std::vector<std::string> options;   // of `fit`, for one file each
  std::vector<std::string> of_files;  // those of them that may name a file, relative to the manifest's folder
  std::vector<std::string> refused;   // of `fit` too, but of the whole batch
  std::vector<std::string> reserved;  // columns of the results
};

// Whether the text begins as a manifest does: its header has one of the columns `file`, `id` or an option's name.
bool LooksLikeManifest(std::string_view text, const ManifestNames& names);
// Whether a column `file` stands between semicolons or tabs, as some spreadsheets write a list: ParseManifest says so.
bool ListsFilesBetweenOthers(std::string_view text);

// Files are relative to the manifest's folder, and a row may name several that are one measurement (list/series.h); an
// id that is not given is the file as listed, or SeriesId, without its leading "../" or "/". Words of options stand in
// Task::options, an empty field gives none; columns of other names in Task::extra. Neither single files nor the options
// are looked at. Throws InputError, with the line, for a manifest without rows or without the column `file`, a column
// that is there twice or has a name of the results', a row of another length, an empty file, a series without files or
// name.
WorkList ParseManifest(std::string_view text, const std::filesystem::path& path, const ManifestNames& names);

// The id of a file that was listed by this name.
std::string IdOf(const std::string& file);

}  // namespace lobefit

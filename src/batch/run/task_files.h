// The files of a task: whether they are still those that were read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/batch/list/work_list.h"
#include "lobefit/batch/run/records.h"

namespace lobefit {

// All zero where there is no such file.
FileStamp StampOf(const std::filesystem::path& path);
// Of each file, in order.
std::vector<FileStamp> StampsOf(const Task& task);

// SHA-256 as the measurement has it: of the file, or of those of a series' files. Empty where one cannot be read.
std::string ContentSha256(const Task& task);

}  // namespace lobefit

#include "lobefit/batch/run/task_files.h"

#include <sys/stat.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/io/series.h"

namespace lobefit {

FileStamp StampOf(const std::filesystem::path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0) return {};
  constexpr std::int64_t kBillion = 1000000000;
  return {static_cast<std::uint64_t>(status.st_size), status.st_mtim.tv_sec * kBillion + status.st_mtim.tv_nsec,
          status.st_ctim.tv_sec * kBillion + status.st_ctim.tv_nsec};
}

std::vector<FileStamp> StampsOf(const Task& task) {
  std::vector<FileStamp> stamps;
  for (const std::string& file : FilesToFit(task)) stamps.push_back(StampOf(ParseFileSpec(file).path));
  return stamps;
}

std::string ContentSha256(const Task& task) {
  const std::vector<std::string> files = FilesToFit(task);
  try {
    std::string digests;
    for (const std::string& file : files) digests += Sha256Hex(FileBytes(ParseFileSpec(file).path).bytes());
    return files.size() == 1 ? digests : Sha256Hex(digests);
  } catch (const Error&) {
    return "";
  }
}

}  // namespace lobefit

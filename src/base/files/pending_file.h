// A file that has no name yet, for outputs that must be whole or not there at all.
#pragma once

#include <filesystem>
#include <string>

namespace lobefit {

// Made in the folder where it will be named. On file systems that know files without a name nothing is left of it even
// when the process is killed; elsewhere it is called ".lobefit-" and 32 random digits, and removed by the destructor,
// or by the signals of RemoveTemporariesOnSignal.
class PendingFile {
 public:
  // Permissions of a new file under the process' umask. Throws std::system_error.
  explicit PendingFile(const std::filesystem::path& folder);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  int descriptor() const { return descriptor_; }
  // Brings the data to the disk and puts the file in the place of `name` in its folder. Throws std::system_error.
  void TakePlaceOf(const std::string& name);
  // The steps of it, each for many files before the next: the data are sent; waited for; the file is named, in one
  // step for every other process; its folder is brought to the disk. The second and third throw std::system_error.
  void BeginToDisk();
  void BringToDisk();
  void TakeName(const std::string& name);
  void BringFolderToDisk();

 private:
  void RememberName();
  void ForgetName();

  int folder_ = -1, descriptor_ = -1;
  int slot_ = -1;  // of the list that the signal handler reads; -1: the file has no name of ours
  std::string name_;
};

}  // namespace lobefit

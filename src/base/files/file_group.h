// Files that are brought to the disk together.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "lobefit/base/files/pending_file.h"

namespace lobefit {

// Each file is whole or not there at any moment, as with WriteFileAtomically, but all of them wait for the disk once:
// a file costs a fraction of a millisecond in place of several. Until Commit none has its name; what was not committed
// is gone with the object, or with the process. Each holds two descriptors.
class FileGroup {
 public:
  // Throws OutputError; `path` is no pipe or device.
  void Add(const std::filesystem::path& path, std::string_view bytes);
  void Take(FileGroup&& other);
  bool IsEmpty() const { return entries_.empty(); }
  // Brings the data to the disk, then gives the names, in the order of Add. Throws OutputError, with the names given
  // that came before.
  void Commit();

 private:
  struct Entry {
    std::filesystem::path path, target;  // as given; what it stands for
    std::unique_ptr<PendingFile> file;
  };
  std::vector<Entry> entries_;
};

}  // namespace lobefit

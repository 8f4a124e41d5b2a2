// The photographs in one OpenEXR file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "lobefit/maps/stack/image_rows.h"

namespace lobefit {

// Any number of its parts are read side by side through one open file. Memory: for each open part the lines that are
// compressed together, or a row of tiles.
class ExrParts {
 public:
  // Claims of the head are checked before OpenEXR takes memory for them. Throws InputError.
  explicit ExrParts(const std::filesystem::path& path);
  // Of each part; empty for the only one of a file without parts.
  const std::vector<std::string>& names() const { return names_; }
  // Throws InputError where there is no such part, or it is no image of at most 65536 pixels a side with channels R, G,
  // B or Y.
  std::unique_ptr<ImageRows> Open(const std::string& part) const;

 private:
  struct File;
  std::shared_ptr<File> file_;
  std::vector<std::string> names_;
};

// By its first bytes.
bool IsExrImage(const std::filesystem::path& path);

}  // namespace lobefit

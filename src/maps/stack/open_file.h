// A file that C libraries read, closed with its owner.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"

namespace lobefit {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

// Throws InputError.
inline OpenFile OpenToRead(const std::filesystem::path& path) {
  OpenFile file(std::fopen(path.c_str(), "rb"));
  if (file == nullptr) throw InputError(PrintableName(path) + ": cannot be opened: " + std::strerror(errno));
  return file;
}

}  // namespace lobefit

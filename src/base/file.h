// Files: read-only mapping, digest, and writing that never leaves half a file.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>

namespace lobefit {

// A regular file mapped for reading. The bytes stay valid as long as the object lives.
class MappedFile {
 public:
  // Throws InputError for a missing file, a folder, a device or a file that may not be read; an empty file is fine.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::string_view bytes() const { return {static_cast<const char*>(data_), size_}; }

 private:
  std::filesystem::path path_;
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

// SHA-256 as 64 lower-case hexadecimal digits.
std::string Sha256Hex(std::string_view bytes);

// Makes a folder for results, with those above it; no more than that where it is there. Throws OutputError.
void MakeFolder(const std::filesystem::path& folder);

// Writes `path` by way of a temporary name in the same folder, which is renamed when `write` has returned and the data
// are on disk; the temporary file is removed if anything throws. Throws OutputError.
void WriteFileAtomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// The same for libraries that open the file themselves: `write` receives the temporary name.
void WriteFileThroughTemporary(const std::filesystem::path& path,
                               const std::function<void(const std::filesystem::path&)>& write);

}  // namespace lobefit

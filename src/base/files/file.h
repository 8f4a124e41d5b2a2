// Files: reading into memory, digest, and writing that never leaves half a file.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// The bytes of a file, a pipe, a character device or, as "-", standard input. They are read when the object is made and
// stay as they are, whatever becomes of the file meanwhile.
class FileBytes {
 public:
  // At most so many bytes are read of what does not state its size, and of anything.
  static constexpr std::size_t kMostStreamed = std::size_t{1} << 29, kMost = std::size_t{1} << 32;

  // Throws InputError for a missing file, a folder, a block device or socket, a file that may not be read, one that
  // becomes shorter while it is read, and more bytes than allowed. An empty file is fine.
  explicit FileBytes(const std::filesystem::path& path);

  // As given.
  const std::filesystem::path& path() const { return path_; }
  // What results and messages call the file: its name without folders, "stdin" for "-".
  std::string name() const;
  std::string_view bytes() const { return {memory_.get(), size_}; }

 private:
  struct Free {
    void operator()(char* memory) const;
  };
  void Reserve(std::size_t bytes);
  void Read(int descriptor);

  std::filesystem::path path_;
  std::unique_ptr<char[], Free> memory_;
  std::size_t size_ = 0, capacity_ = 0;
};

// SHA-256: 32 bytes, and as 64 lower-case hexadecimal digits.
std::string Sha256(std::string_view bytes);
std::string Sha256Hex(std::string_view bytes);

// Makes a folder for results, with those above it; no more than that where it is there. Throws OutputError.
void MakeFolder(const std::filesystem::path& folder);

// Whether `path` stands for the program's standard output: "-", or a name of the pipe or device that it is.
bool IsStandardOutput(const std::filesystem::path& path);
// Whether `path` is a pipe or device, or "-": written through, never replaced, and not to be read back.
bool IsStream(const std::filesystem::path& path);

// For use before the work starts. Throws UsageError where `output` is one of `inputs` (by whatever name or link),
// OutputError where it cannot be written: a folder, a block device, write-protected, in a folder that is not there or
// does not allow it. A path in a folder that MakeFolder is still to make is checked as far as it is there.
void CheckOutput(const std::filesystem::path& output, const std::vector<std::filesystem::path>& inputs);

// Writes `path` so that at any moment, also after a crash, it holds the old content or the whole new one: the data go
// to a file of the same folder that has no name (or, where the file system cannot do that, one nobody can guess), are
// brought to the disk, and only then take the name. A symbolic link stays and its target is replaced; mode and owner of
// an existing file stay, as far as this user may set them, and are narrowed rather than widened; other hard links to it
// keep the old content. Pipes, character devices and "-" are written through. Throws OutputError; what `write` throws
// passes through. Both leave nothing behind.
void WriteFileAtomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);
void WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// Has this signal remove the temporary files that have names, then end the program as it would have. For the main
// program: a library leaves signals to its host.
void RemoveTemporariesOnSignal(int signal);

}  // namespace lobefit

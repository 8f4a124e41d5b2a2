#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <streambuf>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/pending_file.h"
#include "lobefit/base/printable.h"

namespace lobefit {
namespace {

using Path = std::filesystem::path;

[[noreturn]] void FailToWrite(const Path& path, const std::string& reason) {
  throw OutputError(PrintableName(path) + ": cannot be written: " + reason + "; choose another place with --out");
}

// What is at the end of the path's links; nothing where nothing is there yet.
std::optional<struct stat> StatusOf(const Path& path) {
  struct stat status = {};
  if (stat(path.c_str(), &status) == 0) return status;
  if (errno == ENOENT) return std::nullopt;
  FailToWrite(path, std::strerror(errno));
}

Path FolderOf(const Path& path) { return path.has_parent_path() ? path.parent_path() : Path("."); }

bool IsThrough(const struct stat& status) { return S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode); }

// Links in a folder that everybody may write to are followed only where they belong to this user or the folder's owner:
// otherwise another user chooses which of this user's files is replaced.
void CheckLinkOwner(const Path& given, const Path& link) {
  struct stat folder = {}, status = {};
  if (stat(FolderOf(link).c_str(), &folder) != 0 || lstat(link.c_str(), &status) != 0) return;
  const bool shared = (folder.st_mode & S_ISVTX) != 0 && (folder.st_mode & S_IWOTH) != 0;
  if (shared && status.st_uid != geteuid() && status.st_uid != folder.st_uid)
    FailToWrite(given, "it is a link that another user made in a shared folder");
}

// The place that the path's last component stands for.
Path Resolved(const Path& given) {
  Path path = given;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(path, error); ++links) {
    if (links == 40) FailToWrite(given, "too many symbolic links");
    CheckLinkOwner(given, path);
    const Path target = std::filesystem::read_symlink(path, error);
    if (error) FailToWrite(given, error.message());
    path = target.is_absolute() ? target : FolderOf(path) / target;
  }
  return path;
}

void RefuseKind(const Path& path, const struct stat& status) {
  if (S_ISDIR(status.st_mode)) FailToWrite(path, "it is a folder");
  if (!S_ISREG(status.st_mode) && !IsThrough(status)) FailToWrite(path, "it is a block device or socket");
  if (access(path.c_str(), W_OK) != 0) FailToWrite(path, std::strerror(errno));
}

// Bytes to a descriptor that this class does not own.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) { setp(buffer_.data(), buffer_.data() + kSize); }
  // Why writing failed; 0 where it did not.
  int reason() const { return reason_; }

 protected:
  int_type overflow(int_type c) override {
    if (!Send(buffer_.data(), pptr())) return traits_type::eof();
    setp(buffer_.data(), buffer_.data() + kSize);
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    if (count < epptr() - pptr()) return std::streambuf::xsputn(bytes, count);
    if (sync() != 0 || !Send(bytes, bytes + count)) return 0;
    return count;
  }
  int sync() override { return traits_type::eq_int_type(overflow(traits_type::eof()), traits_type::eof()) ? -1 : 0; }

 private:
  static constexpr std::size_t kSize = 1 << 16;

  bool Send(const char* begin, const char* end) {
    while (begin != end && reason_ == 0) {
      const ssize_t count = write(descriptor_, begin, static_cast<std::size_t>(end - begin));
      if (count >= 0) begin += count;
      if (count < 0 && errno != EINTR) reason_ = errno;
    }
    return reason_ == 0;
  }

  int descriptor_, reason_ = 0;
  std::array<char, kSize> buffer_;
};

void Fill(int descriptor, const Path& path, const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor);
  std::ostream out(&buffer);
  write(out);
  out.flush();
  if (!out) {
    throw OutputError(PrintableName(path) + ": writing failed: " + std::strerror(buffer.reason()) +
                      (buffer.reason() == ENOSPC || buffer.reason() == EDQUOT ? "; is the disk full?" : ""));
  }
}

void WriteThrough(const Path& path, const std::function<void(std::ostream&)>& write) {
  if (IsStandardOutput(path)) {
    // What was printed before comes before.
    std::fflush(stdout);
    return Fill(STDOUT_FILENO, path, write);
  }
  const int descriptor = open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) FailToWrite(path, std::strerror(errno));
  try {
    Fill(descriptor, path, write);
  } catch (...) {
    close(descriptor);
    throw;
  }
  if (close(descriptor) != 0) FailToWrite(path, std::strerror(errno));
}

// Mode and owner of the file that is replaced. Who may read it does not grow: where the group cannot be kept, the new
// one has no right.
void KeepRights(int descriptor, const struct stat& old) {
  mode_t mode = old.st_mode & 0777;
  if (fchown(descriptor, old.st_uid, old.st_gid) != 0 && fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) != 0)
    mode &= ~static_cast<mode_t>(S_IRWXG);
  if (fchmod(descriptor, mode) != 0) throw std::system_error(errno, std::generic_category());
}

}  // namespace

void MakeFolder(const Path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw OutputError(PrintableName(folder) + ": cannot be made: " + error.message() +
                      "; choose another folder with --out");
}

bool IsStandardOutput(const Path& path) {
  if (path == "-") return true;
  struct stat status = {}, standard = {};
  return stat(path.c_str(), &status) == 0 && fstat(STDOUT_FILENO, &standard) == 0 && status.st_dev == standard.st_dev &&
         status.st_ino == standard.st_ino;
}

bool IsStream(const Path& path) {
  if (IsStandardOutput(path)) return true;
  struct stat status = {};
  return stat(path.c_str(), &status) == 0 && IsThrough(status);
}

void CheckOutput(const Path& output, const std::vector<Path>& inputs) {
  if (output == "-") return;
  if (const std::optional<struct stat> status = StatusOf(output)) {
    RefuseKind(output, *status);
    if (!S_ISREG(status->st_mode)) return;
    for (const Path& input : inputs) {
      std::error_code error;
      if (!std::filesystem::equivalent(output, input, error)) continue;
      throw UsageError(PrintableName(output) + ": is the input " + PrintableName(input) +
                       ", which would be overwritten; choose another name or folder for the result");
    }
  }
  Path folder = FolderOf(Resolved(output));
  std::error_code error;
  while (!std::filesystem::exists(folder, error) && !error && folder != FolderOf(folder)) folder = FolderOf(folder);
  if (!std::filesystem::is_directory(folder, error)) FailToWrite(output, "its folder is not there");
  if (access(folder.c_str(), W_OK | X_OK) != 0) FailToWrite(output, std::strerror(errno));
}

void WriteFileAtomically(const Path& path, const std::function<void(std::ostream&)>& write) {
  if (IsStandardOutput(path)) return WriteThrough(path, write);
  const std::optional<struct stat> old = StatusOf(path);
  if (old) RefuseKind(path, *old);
  if (old && IsThrough(*old)) return WriteThrough(path, write);
  const Path target = Resolved(path);
  try {
    PendingFile file(FolderOf(target));
    Fill(file.descriptor(), path, write);
    if (old) KeepRights(file.descriptor(), *old);
    file.TakePlaceOf(target.filename().string());
  } catch (const std::system_error& error) {
    FailToWrite(path, error.code().message());
  }
}

void WriteFileAtomically(const Path& path, std::string_view bytes) {
  WriteFileAtomically(path,
                      [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

}  // namespace lobefit

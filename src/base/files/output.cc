#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/descriptor_stream.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/files/file_group.h"
#include "lobefit/base/files/pending_file.h"
#include "lobefit/base/text/printable.h"

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

// A file that is to stand where a regular one stands, or nothing.
struct Replacement {
  std::optional<struct stat> old;
  Path target;
  std::unique_ptr<PendingFile> file;
};

// `write` fills it. Throws OutputError and std::system_error.
Replacement Prepare(const Path& path, const std::function<void(std::ostream&)>& write) {
  Replacement made;
  made.old = StatusOf(path);
  if (made.old) RefuseKind(path, *made.old);
  made.target = Resolved(path);
  made.file = std::make_unique<PendingFile>(FolderOf(made.target));
  Fill(made.file->descriptor(), path, write);
  if (made.old) KeepRights(made.file->descriptor(), *made.old);
  return made;
}

std::function<void(std::ostream&)> Writing(std::string_view bytes) {
  return [bytes](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); };
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
  if (IsStream(path)) return WriteThrough(path, write);
  try {
    const Replacement made = Prepare(path, write);
    made.file->TakePlaceOf(made.target.filename().string());
  } catch (const std::system_error& error) {
    FailToWrite(path, error.code().message());
  }
}

void WriteFileAtomically(const Path& path, std::string_view bytes) { WriteFileAtomically(path, Writing(bytes)); }

void FileGroup::Add(const Path& path, std::string_view bytes) {
  if (IsStream(path)) FailToWrite(path, "it is a pipe or device");
  try {
    Replacement made = Prepare(path, Writing(bytes));
    entries_.push_back({path, std::move(made.target), std::move(made.file)});
  } catch (const std::system_error& error) {
    FailToWrite(path, error.code().message());
  }
}

void FileGroup::Take(FileGroup&& other) {
  std::move(other.entries_.begin(), other.entries_.end(), std::back_inserter(entries_));
  other.entries_.clear();
}

void FileGroup::Commit() {
  const auto each = [&](const auto& action) {
    for (Entry& entry : entries_) {
      try {
        action(&entry);
      } catch (const std::system_error& error) {
        FailToWrite(entry.path, error.code().message());
      }
    }
  };
  // All are on their way before one is waited for, so that the disk takes them together.
  each([](Entry* entry) { entry->file->BeginToDisk(); });
  each([](Entry* entry) { entry->file->BringToDisk(); });
  each([](Entry* entry) { entry->file->TakeName(entry->target.filename().string()); });
  std::set<Path> folders;
  for (const Entry& entry : entries_) {
    if (folders.insert(FolderOf(entry.target)).second) entry.file->BringFolderToDisk();
  }
  entries_.clear();
}

}  // namespace lobefit

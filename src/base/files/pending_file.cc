#include "lobefit/base/files/pending_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <system_error>

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// Folder and name of temporary files that have one: all that a signal handler may use is memory that is always there.
struct Slot {
  std::atomic<bool> taken{false}, named{false};
  int folder = -1;
  std::array<char, 48> name = {};
};
constexpr std::size_t kSlots = 256;

std::array<Slot, kSlots>& Slots() {
  static std::array<Slot, kSlots> slots;
  return slots;
}

extern "C" void RemoveTemporaries(int signal) {
  for (Slot& slot : Slots()) {
    if (slot.named) unlinkat(slot.folder, slot.name.data(), 0);
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

[[noreturn]] void ThrowErrno() { throw std::system_error(errno, std::generic_category()); }

std::string RandomName() {
  std::string bytes(16, '\0');
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) ThrowErrno();
  return ".lobefit-" + Hex(bytes);
}

}  // namespace

void RemoveTemporariesOnSignal(int signal) {
  Slots();  // made here, not in the handler
  std::signal(signal, RemoveTemporaries);
}

PendingFile::PendingFile(const std::filesystem::path& folder) {
  folder_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) ThrowErrno();
  descriptor_ = openat(folder_, ".", O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  // Without /proc an unnamed file cannot be given a name.
  if (descriptor_ >= 0 && access("/proc/self/fd", X_OK) == 0) return;
  if (descriptor_ >= 0) close(descriptor_);
  RememberName();
  descriptor_ = openat(folder_, name_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ >= 0) return;
  const int reason = errno;
  ForgetName();
  close(folder_);
  errno = reason;
  ThrowErrno();
}

PendingFile::~PendingFile() {
  if (!name_.empty()) unlinkat(folder_, name_.c_str(), 0);
  ForgetName();
  close(descriptor_);
  close(folder_);
}

void PendingFile::TakePlaceOf(const std::string& name) {
  BringToDisk();
  TakeName(name);
  BringFolderToDisk();
}

// Where that is not possible the wait is longer, and says what failed.
void PendingFile::BeginToDisk() { sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE); }

void PendingFile::BringToDisk() {
  // EINVAL: a file system without anything to bring to a disk.
  if (fsync(descriptor_) != 0 && errno != EINVAL) ThrowErrno();
}

void PendingFile::TakeName(const std::string& name) {
  const bool unnamed = name_.empty();
  const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
  // A name that is not taken yet is given at once, so that no death can leave another one; a link replaces nothing.
  const bool is_new = unnamed && linkat(AT_FDCWD, self.c_str(), folder_, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  if (unnamed && !is_new) {
    if (errno != EEXIST) ThrowErrno();
    RememberName();
    if (linkat(AT_FDCWD, self.c_str(), folder_, name_.c_str(), AT_SYMLINK_FOLLOW) != 0) ThrowErrno();
  }
  if (!is_new && renameat(folder_, name_.c_str(), folder_, name.c_str()) != 0) ThrowErrno();
  ForgetName();
}

// The name is there already for every other process, so that a failure undoes nothing.
void PendingFile::BringFolderToDisk() { fsync(folder_); }

void PendingFile::RememberName() {
  name_ = RandomName();
  for (std::size_t i = 0; i < kSlots; ++i) {
    Slot& slot = Slots()[i];
    if (slot.taken.exchange(true)) continue;
    slot.folder = folder_;
    std::memcpy(slot.name.data(), name_.c_str(), name_.size() + 1);
    slot.named = true;
    slot_ = static_cast<int>(i);
    return;
  }
}

void PendingFile::ForgetName() {
  name_.clear();
  if (slot_ < 0) return;
  Slot& slot = Slots()[static_cast<std::size_t>(slot_)];
  slot.named = false;
  slot.taken = false;
  slot_ = -1;
}

}  // namespace lobefit

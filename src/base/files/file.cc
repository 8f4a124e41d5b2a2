#include "lobefit/base/files/file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/memory.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

std::string SystemReason() { return std::strerror(errno); }

// Closes what it opened; standard input is left open.
class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& path)
      : standard_(path == "-"), number_(standard_ ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~Descriptor() {
    if (number_ >= 0 && !standard_) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  bool standard_;
  int number_;
};

}  // namespace

void FileBytes::Free::operator()(char* memory) const { std::free(memory); }

FileBytes::FileBytes(const std::filesystem::path& path) : path_(path) {
  const Descriptor descriptor(path);
  if (descriptor.number() < 0) {
    throw InputError(PrintableName(path) + ": cannot be opened: " + SystemReason() +
                     "; check the name and the permissions");
  }
  Read(descriptor.number());
}

std::string FileBytes::name() const { return path_ == "-" ? "stdin" : path_.filename().string(); }

void FileBytes::Reserve(std::size_t bytes) {
  // Aligned, so that large pages fit; whole ones, since aligned_alloc asks for that. A small file takes what it needs:
  // an alignment of 64 kB made a mapping of its own of every one, which took half of the time of reading it.
  constexpr std::size_t kLargePage = std::size_t{1} << 21, kSmall = 64;
  const std::size_t unit = bytes > kLargePage ? kLargePage : kSmall;
  const std::size_t capacity = std::max(unit, (bytes + unit - 1) / unit * unit);
  // What grows is moved by its pages, so that a long pipe is not in memory twice; the kernel moves only what has no
  // advice.
  const bool grows = size_ > 0;
  char* const memory =
      static_cast<char*>(grows ? std::realloc(memory_.get(), capacity) : std::aligned_alloc(unit, capacity));
  if (memory == nullptr) throw std::bad_alloc();
  static_cast<void>(memory_.release());
  memory_.reset(memory);
  if (!grows) AdviseLargePages(memory, capacity);
  capacity_ = capacity;
}

void FileBytes::Read(int descriptor) {
  struct stat status = {};
  if (fstat(descriptor, &status) != 0) throw InputError(PrintableName(path_) + ": cannot be read: " + SystemReason());
  const bool regular = S_ISREG(status.st_mode);
  if (!regular && !S_ISFIFO(status.st_mode) && !S_ISCHR(status.st_mode)) {
    throw InputError(PrintableName(path_) + ": is " +
                     (S_ISDIR(status.st_mode) ? "a folder" : "a block device or socket") +
                     "; name a file, a pipe or - for standard input");
  }
  const std::size_t stated = regular ? static_cast<std::size_t>(status.st_size) : 0;
  const std::size_t most = regular ? kMost : kMostStreamed;
  const auto refuse_beyond = [&](std::size_t bytes) {
    if (bytes <= most) return;
    throw InputError(PrintableName(path_) + ": holds more than " + std::to_string(most >> 20) + " MB, the limit of a " +
                     (regular ? "file; give a part of it" : "pipe; write it to a file, or give a part of it"));
  };
  refuse_beyond(stated);
  constexpr std::size_t kOfUnknown = std::size_t{1} << 16;
  Reserve(stated > 0 ? stated + 1 : kOfUnknown);
  while (true) {
    const ssize_t count = read(descriptor, memory_.get() + size_, capacity_ - size_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(PrintableName(path_) + ": reading failed: " + SystemReason());
    if (count == 0) break;
    size_ += static_cast<std::size_t>(count);
    refuse_beyond(size_);
    if (size_ == capacity_) Reserve(std::min(2 * capacity_, most + 1));
  }
  // Standard input may stand in the middle of a file.
  if (path_ != "-" && size_ < stated) {
    throw InputError(PrintableName(path_) + ": became shorter while it was read: " + std::to_string(size_) + " of " +
                     std::to_string(stated) + " bytes; read it again when it is complete");
  }
}

std::string Sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest = {};
  unsigned int length = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr);
  return {digest.begin(), digest.begin() + length};
}

std::string Sha256Hex(std::string_view bytes) { return Hex(Sha256(bytes)); }

}  // namespace lobefit

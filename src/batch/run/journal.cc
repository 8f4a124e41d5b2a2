#include "lobefit/batch/run/journal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/version.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostHeld = 64;
constexpr std::chrono::milliseconds kGathering{100};

// Lines that may wait: each has some files, whose descriptors must not use up those of the process.
std::size_t MostHeld() {
  constexpr rlim_t kEach = 16;
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return 1;
  return static_cast<std::size_t>(std::clamp<rlim_t>(limit.rlim_cur / kEach, 1, kMostHeld));
}

std::string FirstLineOf(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string HostName() {
  std::array<char, 256> name = {};
  if (gethostname(name.data(), name.size() - 1) != 0) return "host";
  std::string host = name.data();
  for (char& c : host) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_';
    if (!plain) c = '_';
  }
  return host.empty() ? "host" : host.substr(0, 64);
}

// Field 22 of /proc/PID/stat; 0 where there is no such process, or one that is dead and only waits for its parent.
std::uint64_t StartTicks(long pid) {
  const std::string line = FirstLineOf(fmt::format("/proc/{}/stat", pid).c_str());
  // The name, in brackets, may hold blanks.
  const std::size_t after_name = line.rfind(')');
  if (after_name == std::string::npos) return 0;
  std::istringstream fields(line.substr(after_name + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) {
    fields >> field;
    if (i == 3 && (field == "Z" || field == "X")) return 0;
  }
  return std::strtoull(field.c_str(), nullptr, 10);
}

}  // namespace

Writer ThisProcess() {
  const long pid = getpid();
  std::error_code error;
  const std::string space = FirstLineOf("/proc/sys/kernel/random/boot_id") + " " +
                            std::filesystem::read_symlink("/proc/self/ns/pid", error).string();
  return {HostName(), pid, StartTicks(pid), space};
}

bool IsRunning(const Writer& writer) {
  const Writer here = ThisProcess();
  return writer.host == here.host && writer.space == here.space && StartTicks(writer.pid) == writer.start_ticks;
}

Journal::Journal(std::filesystem::path folder) : folder_(std::move(folder)), most_held_(MostHeld()) {
  // Processes of two containers may share host name and number.
  std::random_device random;
  const std::uint64_t number = (std::uint64_t{random()} << 32) | random();
  name_ = fmt::format("{}-{}-{:016x}", HostName(), getpid(), number);
}

Journal::~Journal() {
  try {
    Close();
  } catch (const std::exception&) {
    // What is lost is done again.
  }
  if (descriptor_ >= 0) close(descriptor_);
}

void Journal::Open() {
  MakeFolder(folder_);
  const std::filesystem::path path = folder_ / (name_ + ".jsonl");
  descriptor_ = open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0)
    throw OutputError(path.string() + ": cannot be made: " + std::strerror(errno) + "; choose another --out");
  const Writer writer = ThisProcess();
  const nlohmann::ordered_json json = {{"segment", 1},          {"host", writer.host},
                                       {"pid", writer.pid},     {"start_ticks", writer.start_ticks},
                                       {"space", writer.space}, {"version", Version()}};
  Write(json.dump() + "\n");
  // So that the file itself is found after a power cut.
  const int folder = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    fsync(folder);
    close(folder);
  }
}

void Journal::FailToWrite(int reason) const {
  throw OutputError(
      fmt::format("{}: writing failed: {}; make room and start the same command again: it goes on where it "
                  "was",
                  (folder_ / name_).string(), std::strerror(reason)));
}

void Journal::Write(std::string_view text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = write(descriptor_, text.data() + written, text.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int reason = errno;
      // What was written of the line is taken back; where that fails the reader passes over it, since the next line
      // then begins with a line end.
      if (written > 0 && ftruncate(descriptor_, size_) != 0) {
        const ssize_t ignored = write(descriptor_, "\n", 1);
        static_cast<void>(ignored);
      }
      FailToWrite(reason);
    }
    written += static_cast<std::size_t>(count);
  }
  size_ += static_cast<std::int64_t>(text.size());
}

void Journal::Reserve() {
  constexpr std::int64_t kStep = 1 << 16, kLeast = 1 << 13;
  const std::lock_guard<std::mutex> lock(write_mutex_);
  if (descriptor_ < 0) Open();
  if (reserved_ - size_ >= kLeast) return;
  reserved_ = size_ + kStep;
  if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, size_, kStep) == 0 || (errno != ENOSPC && errno != EDQUOT)) return;
  reserved_ = 0;
  FailToWrite(errno);
}

void Journal::Append(std::string_view line) {
  const std::lock_guard<std::mutex> lock(write_mutex_);
  if (descriptor_ < 0) Open();
  std::string text(line);
  Write(text += '\n');
}

void Journal::Commit(std::string line, FileGroup files) {
  line += '\n';
  if (files.IsEmpty()) {
    const std::lock_guard<std::mutex> lock(write_mutex_);
    if (descriptor_ < 0) Open();
    Write(std::exchange(line, ""));
  }
  std::unique_lock<std::mutex> lock(mutex_);
  if (!bringer_.joinable()) bringer_ = std::thread([this] { BringGroups(); });
  changed_.wait(lock, [&] { return held_ < most_held_ || error_; });
  if (error_) std::rethrow_exception(error_);
  waiting_.lines += line;
  waiting_.files.Take(std::move(files));
  ++waiting_.size;
  ++held_;
  changed_.notify_all();
}

void Journal::Close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  if (bringer_.joinable()) bringer_.join();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void Journal::Bring(Group group) {
  group.files.Commit();
  const std::lock_guard<std::mutex> lock(write_mutex_);
  if (descriptor_ < 0) Open();
  Write(group.lines);
  // EINVAL: a file system without anything to bring to a disk.
  if (fdatasync(descriptor_) != 0 && errno != EINVAL) FailToWrite(errno);
}

void Journal::BringGroups() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return waiting_.size > 0 || quit_; });
    changed_.wait_for(lock, kGathering, [&] { return waiting_.size >= most_held_ || quit_; });
    if (waiting_.size == 0) return;
    Group group = std::exchange(waiting_, {});
    const std::size_t size = group.size;
    lock.unlock();
    std::exception_ptr error;
    try {
      Bring(std::move(group));
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    held_ -= size;
    if (error) error_ = error;
    changed_.notify_all();
    // What failed once is left to another time, with all that came after it.
    if (error_) return;
  }
}

}  // namespace lobefit

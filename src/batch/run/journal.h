// A process' own file of lines, one JSON object each, in a folder that any number of processes share: nobody locks,
// nobody writes to a file of another, and a line that was cut short by a death or a full disk is passed over when the
// lines are read.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace lobefit {

// Who writes: enough to tell later whether the writer is still there.
struct Writer {
  std::string host;
  long pid = 0;
  std::uint64_t start_ticks = 0;  // when the process started, in the kernel's ticks since the boot
  std::string space;              // boot of that host and namespace in which `pid` counts
};
Writer ThisProcess();
// Whether the writer is known to run still; of other hosts nothing is known.
bool IsRunning(const Writer& writer);

class Journal {
 public:
  // The file is folder/HOST-PID-RANDOM.jsonl and made with the first line, which says who writes.
  explicit Journal(std::filesystem::path folder);
  // Brings all lines to the disk.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Makes sure that a few more short lines can be written even where the disk fills up, on file systems that can
  // promise that. Throws OutputError.
  void Reserve();
  // Appends `line`, which has no line end, with one call of the system. A line that `matters` is on the disk after a
  // second or 64 such lines, whichever comes first. From any thread. Throws OutputError, with nothing of the line left
  // in the file where that is possible.
  void Append(std::string_view line, bool matters);
  // The name of the file without folder and ending.
  const std::string& name() const { return name_; }

 private:
  void Open();
  [[noreturn]] void FailToWrite(int reason) const;
  void Write(std::string_view text);
  void Sync();
  void SyncEverySecond();

  const std::filesystem::path folder_;
  std::string name_;
  std::mutex mutex_;
  std::condition_variable wake_;
  int descriptor_ = -1;
  std::int64_t size_ = 0, reserved_ = 0;
  std::size_t unsynced_ = 0;
  bool quit_ = false;
  std::thread syncer_;
};

}  // namespace lobefit

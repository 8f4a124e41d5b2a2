// A process' own file of lines, one JSON object each, in a folder that any number of processes share: nobody locks,
// nobody writes to a file of another, and a line that was cut short by a death or a full disk is passed over when the
// lines are read.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "lobefit/base/files/file_group.h"

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
  // Brings to the disk what it can; a failure goes unsaid, see Close.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  // Makes sure that a few more short lines can be written even where the disk fills up, on file systems that can
  // promise that. Throws OutputError.
  void Reserve();
  // Appends `line`, which has no line end, with one call of the system; it outlives this process, but perhaps not a
  // power cut. From any thread. Throws OutputError, with nothing of the line left in the file where that is possible.
  void Append(std::string_view line);
  // Appends `line` once the files that it speaks of are in place; at once where there are none. That happens in groups,
  // of what came within a tenth of a second or while the group before was on its way, and of at most 64: files are
  // brought to the disk and named, lines written and brought to the disk. What a death takes is absent as a whole, line
  // and files. Waits while a whole group is waiting. From any thread. Throws OutputError, also for an earlier group.
  void Commit(std::string line, FileGroup files);
  // Brings all to the disk. Throws OutputError, also for an earlier group. Nothing may be committed after it.
  void Close();
  // The name of the file without folder and ending.
  const std::string& name() const { return name_; }

 private:
  struct Group {
    std::string lines;
    FileGroup files;
    std::size_t size = 0;
  };
  void Open();
  [[noreturn]] void FailToWrite(int reason) const;
  void Write(std::string_view text);
  void Bring(Group group);
  void BringGroups();

  const std::filesystem::path folder_;
  const std::size_t most_held_;
  std::string name_;
  std::mutex write_mutex_;  // of the descriptor and what was written to it
  int descriptor_ = -1;
  std::int64_t size_ = 0, reserved_ = 0;

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  Group waiting_;
  std::size_t held_ = 0;  // committed, but not on the disk
  std::exception_ptr error_;
  bool quit_ = false;
  std::thread bringer_;
};

}  // namespace lobefit

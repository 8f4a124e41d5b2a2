// What the segments of a batch say: which tasks are done, how, and which were begun by a process that died.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace lobefit {

enum class TaskStatus {
  kFitted,
  kDoubtful,  // there is a document, but it did not converge, is not determined or does not describe its data
  kFailed,    // there is none; the message says why
  kCrashed    // its process died twice
};
std::string NameOf(TaskStatus status);

// What a file looked like when it was read: where nothing of it changed, its content is taken to be the same.
struct FileStamp {
  std::uint64_t bytes = 0;
  std::int64_t modified_ns = 0, changed_ns = 0;

  bool operator==(const FileStamp&) const = default;
};
// A task that is done: one line of a segment.
struct DoneRecord {
  std::string id, key, settings, sha256;
  std::vector<FileStamp> stamps;  // of the task's files, in their order
  TaskStatus status = TaskStatus::kFailed;
  int exit_code = 0;  // of `lobefit fit`
  std::string message;
  std::uint64_t document_bytes = 0;  // 0: there is no document
  double at = 0, seconds = 0;        // end, since 1970; duration
  double peak_mb = 0;                // largest memory of the process so far
  int threads = 1;
  // The columns of the result as a JSON object; empty where there is no document. Of records that were read it stays in
  // the segment, and RowReader gives it.
  std::string row;
  // The spheres of the overview as PNG in base64, of which the same holds; empty where there are none.
  std::string picture;
  bool picture_is_measured = false;  // the measured sphere stands left of the fitted one
  std::size_t segment = 0;           // index into Records::segments
  std::uint64_t row_offset = 0, row_bytes = 0, picture_offset = 0, picture_bytes = 0;
};

// A task that was begun.
struct StartRecord {
  std::string id;
  double at = 0;
  std::size_t segment = 0;
};

struct Segment {
  std::string name, host;
  bool is_running = false;  // its process is known to
  std::filesystem::path path;
  std::size_t lines_lost = 0;  // cut short by a death or a full disk
};

struct Records {
  std::vector<Segment> segments;  // by name
  std::vector<DoneRecord> done;   // in the order of segments and lines
  // Begun but not done, by processes that are not known to run still.
  std::unordered_map<std::string, std::vector<StartRecord>> deaths;  // by id
};

// Reads every segment below out/segments, on `threads` threads. Lines that are not whole are counted and passed over.
Records ReadRecords(const std::filesystem::path& out, int threads);

// Rows of records: a hundred thousand need not be in memory at once. For one thread.
class RowReader {
 public:
  // The records must outlive the object.
  explicit RowReader(const Records& records) : records_(records) {}
  ~RowReader();
  RowReader(const RowReader&) = delete;
  RowReader& operator=(const RowReader&) = delete;

  // DoneRecord::row and picture; valid until the next call. Throw InputError where the segment does not hold it any
  // more.
  std::string_view Read(const DoneRecord& done);
  std::string_view ReadPicture(const DoneRecord& done);

 private:
  std::string_view ReadPlace(const DoneRecord& done, std::uint64_t offset, std::uint64_t bytes);

  const Records& records_;
  std::unordered_map<std::size_t, int> descriptors_;  // by segment
  std::string text_;
};

// The lines of a segment.
std::string ToLine(const StartRecord& start);
// Two lines where there is a picture, which comes first.
std::string ToLine(const DoneRecord& done);
// Of a task whose process outlived it: written at once, while what it gave is on its way to the disk or cannot be
// written.
std::string EndedLine(const std::string& id);
// The record of ToLine, with its row and picture. Throws an exception for one that is not whole.
DoneRecord DoneFromLine(std::string_view text);

// Seconds since 1970.
double Now();

// The record that counts of each task that is done with the settings wanted: of several with one key the best one, else
// the last one. `settings_of` gives a task's settings by id; ids that it does not know are left out. The ids of what is
// given are the records' own.
std::unordered_map<std::string_view, const DoneRecord*> LatestDone(
    const Records& records, const std::unordered_map<std::string_view, std::string_view>& settings_of);

}  // namespace lobefit

// Doing the work of a list: what is done is passed over, what runs is written down, what kills its process is set
// aside.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "lobefit/base/files/file_group.h"
#include "lobefit/batch/list/shard.h"
#include "lobefit/batch/list/work_list.h"
#include "lobefit/batch/run/records.h"
#include "lobefit/batch/run/schedule.h"

namespace lobefit {

// What came out of one task.
struct Outcome {
  TaskStatus status = TaskStatus::kFailed;
  int exit_code = 0;
  std::string message;
  std::string row;  // columns of the result as a JSON object; empty without a document
  std::uint64_t document_bytes = 0;
  std::string sha256;        // of the file as it was read; empty where it was not
  FileGroup files;           // its document
  std::string picture = {};  // DoneRecord::picture
  bool picture_is_measured = false;
};

// Fits one task on so many threads. A failure of the file is an outcome or an exception;
// OutputError means that results cannot be written and ends the batch. Called from several threads, and in a process of
// its own.
using Work = std::function<Outcome(const Task& task, int threads)>;

struct RunOptions {
  ScheduleLimits limits;
  Shard shard;
  bool retry_failed = false;
};

// Numbers of tasks of the shard.
struct Counts {
  std::size_t listed = 0, done_before = 0, changed = 0;  // changed: done before, but the file is another one now
  std::size_t to_do = 0;
};

// What remains to be done of a list.
struct Plan {
  std::vector<const Task*> usual;     // in the list's order
  std::vector<const Task*> suspects;  // whose process died once: last, and each in a process of its own
  std::vector<const Task*> crashed;   // whose process died twice: only written down
  Counts counts;
};
Plan MakePlan(const WorkList& list, const Records& records, const RunOptions& options,
              const std::filesystem::path& out);

// Called after each task, from any thread; the record's row is there for the time of the call.
using Done = std::function<void(const DoneRecord&)>;

// Runs the plan. When it returns all is on the disk. Ends early, with what runs finished and written down, once `stop`
// is set. Throws OutputError where results cannot be written.
void RunPlan(const Plan& plan, const RunOptions& options, const std::filesystem::path& out,
             const std::atomic<bool>& stop, const Work& work, const Done& done);

}  // namespace lobefit

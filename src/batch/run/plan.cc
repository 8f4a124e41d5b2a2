#include <algorithm>
#include <string_view>
#include <unordered_map>

#include "lobefit/batch/run/run.h"
#include "lobefit/batch/run/task_files.h"

namespace lobefit {
namespace {

// Whether the document of a task that is done is still there.
bool IsInPlace(const DoneRecord& done, const std::filesystem::path& out) {
  if (done.document_bytes == 0) return true;
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(ResultPath(out, done.id, ".material.json"), error);
  return !error && bytes == done.document_bytes;
}

// Whether the files are those that were read then. A file that was written within the clock's step before it was read
// could have been written again without another stamp, so that its content is compared.
bool AreSameFiles(const DoneRecord& done, const Task& task) {
  constexpr double kClockStep = 2, kNanosecond = 1e-9;
  const double begun = done.at - done.seconds;
  const std::vector<FileStamp> stamps = StampsOf(task);
  const bool settled = std::all_of(stamps.begin(), stamps.end(), [&](const FileStamp& stamp) {
    return static_cast<double>(std::max(stamp.modified_ns, stamp.changed_ns)) * kNanosecond + kClockStep < begun;
  });
  return (settled && stamps == done.stamps) || ContentSha256(task) == done.sha256;
}

}  // namespace

Plan MakePlan(const WorkList& list, const Records& records, const RunOptions& options,
              const std::filesystem::path& out) {
  std::unordered_map<std::string_view, std::string_view> settings;
  for (const Task& task : list.tasks) settings.emplace(task.id, task.settings);
  const std::unordered_map<std::string_view, const DoneRecord*> latest = LatestDone(records, settings);
  Plan plan;
  for (std::size_t i = 0; i < list.tasks.size(); ++i) {
    if (!options.shard.Holds(i)) continue;
    const Task& task = list.tasks[i];
    ++plan.counts.listed;
    const auto done = latest.find(task.id);
    double since = 0;  // deaths before this moment are settled
    if (done != latest.end()) {
      const DoneRecord& record = *done->second;
      const bool retry =
          options.retry_failed && (record.status == TaskStatus::kFailed || record.status == TaskStatus::kCrashed);
      const bool same = AreSameFiles(record, task);
      if (!retry && same && IsInPlace(record, out)) {
        ++plan.counts.done_before;
        continue;
      }
      if (!same) ++plan.counts.changed;
      since = record.at;
    }
    ++plan.counts.to_do;
    const auto deaths = records.deaths.find(task.id);
    const auto count = deaths == records.deaths.end()
                           ? 0
                           : std::count_if(deaths->second.begin(), deaths->second.end(),
                                           [&](const StartRecord& start) { return start.at > since; });
    (count == 0 ? plan.usual : count == 1 ? plan.suspects : plan.crashed).push_back(&task);
  }
  return plan;
}

}  // namespace lobefit

// The results of a batch, from its work list and what its processes wrote down.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lobefit/batch/list/work_list.h"
#include "lobefit/batch/run/records.h"

namespace lobefit {

// Exit code of a batch that has tasks which are still missing; beside those of ExitCode.
inline constexpr int kExitMissing = 5;

// A row is a task that is done. Every text is that of the table: nothing of it depends on the machine or the moment.
struct ResultTable {
  // id, file, the list's own columns, status, verdict, message, sha256, key, then those of FixedResultColumns and of
  // every parameter that occurs, in the order of first occurrence by id.
  std::vector<std::string> columns;
  struct Row {
    const Task* task;
    const DoneRecord* done;
    std::vector<std::pair<std::size_t, std::string>> cells;  // column and text; others are empty
  };
  std::vector<Row> rows;             // by id
  std::vector<const Task*> missing;  // by id
  std::map<TaskStatus, std::size_t> totals;

  // 0: all fitted; 4: all done, but some failed or do not describe their data; 5: some are missing.
  int ExitCode() const;
};

// Both must outlive the table.
ResultTable MakeTable(const WorkList& list, const Records& records, int threads);

// What is said of a task on one line: its id and the message, which often begins with the file's name already.
std::string Said(const std::string& id, const std::string& message);

// Names that a list's own columns may not have.
std::vector<std::string> ReservedColumns();

// results.csv and results.jsonl, the same bytes wherever and in whatever order the work was done.
std::string ToCsv(const ResultTable& table);
std::string ToJsonLines(const ResultTable& table);
// runs.csv: every fit that was recorded, also those that another one replaced and those that died, with host, start,
// duration, threads and the largest memory of its process so far.
std::string RunsToCsv(const WorkList& list, const Records& records);

}  // namespace lobefit

// The results of a batch, from its work list and what its processes wrote down.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "lobefit/batch/list/work_list.h"
#include "lobefit/batch/run/records.h"

namespace lobefit {

// Exit code of a batch that has tasks which are still missing; beside those of ExitCode.
inline constexpr int kExitMissing = 5;

// A row is a task that is done; what it holds is read when it is asked for. Every text is that of the table: nothing of
// it depends on the machine or the moment.
struct ResultTable {
  const WorkList* list;
  const Records* records;
  // The list's own columns; "listed.NAME" where a result has that name.
  std::vector<std::string> extra_columns;
  // id, file, extra_columns, status, verdict, message, sha256, key, then those of FixedResultColumns and of
  // every parameter that occurs, in the order of first occurrence by id.
  std::vector<std::string> columns;
  struct Row {
    const Task* task;
    const DoneRecord* done;
  };
  std::vector<Row> rows;             // by id
  std::vector<const Task*> missing;  // by id
  std::map<TaskStatus, std::size_t> totals;
  std::map<std::string, std::size_t> verdicts;

  // 0: all fitted; 4: all done, but some failed or do not describe their data; 5: some are missing.
  int ExitCode() const;
};

// Both must outlive the table. On `threads` threads, as what follows.
ResultTable MakeTable(const WorkList& list, const Records& records, int threads);

// The texts of rows, each by column; an empty one where there is nothing. For one thread.
class RowTexts {
 public:
  // The table must outlive the object.
  explicit RowTexts(const ResultTable& table);
  // Valid until the next call.
  const std::vector<std::string>& Of(const ResultTable::Row& row);

 private:
  const ResultTable& table_;
  RowReader reader_;
  std::unordered_map<std::string_view, std::size_t> places_;
  std::vector<std::string> texts_;
};

// What is said of a task on one line: its id and the message, which often begins with the file's name already.
std::string Said(const std::string& id, const std::string& message);

// Names that a list's own columns may not have.
std::vector<std::string> ReservedColumns();

// results.csv and results.jsonl, the same bytes wherever and in whatever order the work was done.
void WriteCsv(const ResultTable& table, int threads, std::ostream& out);
void WriteJsonLines(const ResultTable& table, int threads, std::ostream& out);
// runs.csv: every fit that was recorded, also those that another one replaced and those that died, with host, start,
// duration, threads and the largest memory of its process so far.
void WriteRuns(const ResultTable& table, std::ostream& out);

}  // namespace lobefit

#include "lobefit/batch/results/results.h"

#include <algorithm>
#include <ctime>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/list/csv_text.h"
#include "lobefit/batch/results/result_row.h"
#include "lobefit/batch/run/flat_members.h"

namespace lobefit {
namespace {

const std::vector<std::string> kFirst = {"id", "file"};
const std::vector<std::string> kOfTask = {"status", "verdict", "message", "sha256", "key"};

std::string UtcText(double seconds) {
  const auto whole = static_cast<std::time_t>(seconds);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(whole),
                     static_cast<int>((seconds - static_cast<double>(whole)) * 1000));
}

void AppendLine(const std::vector<std::string>& fields, std::string* text) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) *text += ',';
    AppendCsvField(fields[i], text);
  }
  *text += '\n';
}

constexpr std::size_t kBlock = 256;
std::size_t Blocks(const ResultTable& table) { return (table.rows.size() + kBlock - 1) / kBlock; }

// Calls work(row, ...) for the rows of a block.
template <typename Work>
void ForBlock(const ResultTable& table, std::size_t block, const Work& work) {
  const std::size_t end = std::min(table.rows.size(), (block + 1) * kBlock);
  for (std::size_t i = block * kBlock; i < end; ++i) work(table.rows[i]);
}

// Names in the order in which they came.
class OrderedNames {
 public:
  // Names mostly come in the order in which they came before: `hint` is where the last one stood.
  void Add(std::string_view name, std::size_t* hint) {
    if (*hint + 1 < names_.size() && names_[*hint + 1] == name) {
      ++*hint;
      return;
    }
    const auto [place, is_new] = places_.emplace(std::string(name), names_.size());
    if (is_new) names_.emplace_back(name);
    *hint = place->second;
  }
  std::vector<std::string>& names() { return names_; }

 private:
  std::unordered_map<std::string, std::size_t> places_;
  std::vector<std::string> names_;
};

// What the results of a block have.
struct BlockColumns {
  OrderedNames names;
  std::map<std::string, std::size_t> verdicts;
};

BlockColumns ColumnsOf(const ResultTable& table, std::size_t block) {
  BlockColumns columns;
  RowReader reader(*table.records);
  ForBlock(table, block, [&](const ResultTable::Row& row) {
    const std::string_view text = reader.Read(*row.done);
    if (text.empty()) return;
    std::size_t hint = 0;
    for (const FlatMember& member : FlatMembers(text)) {
      columns.names.Add(member.name, &hint);
      if (member.name == "verdict" && member.kind == FlatMember::Kind::kString)
        ++columns.verdicts[std::string(member.value)];
    }
  });
  return columns;
}

// The list's own columns under names that no result has: its "alpha_x", perhaps the truth, stays beside the fitted one.
std::vector<std::string> ApartFrom(const std::vector<std::string>& results, std::vector<std::string> extra) {
  std::unordered_set<std::string> taken(results.begin(), results.end());
  taken.insert(extra.begin(), extra.end());
  const std::unordered_set<std::string> of_results(results.begin(), results.end());
  for (std::string& name : extra) {
    if (!of_results.contains(name)) continue;
    while (taken.contains(name)) name.insert(0, "listed.");
    taken.insert(name);
  }
  return extra;
}

// What `text_of` gives for each block, in order; a few blocks are in memory at once.
template <typename TextOf>
void WriteBlocks(const ResultTable& table, int threads, std::ostream& out, const TextOf& text_of) {
  const std::size_t at_once = 4 * static_cast<std::size_t>(std::max(1, threads));
  std::vector<std::string> texts(at_once);
  for (std::size_t first = 0; first < Blocks(table); first += at_once) {
    const std::size_t count = std::min(at_once, Blocks(table) - first);
    ParallelFor(count, threads, [&](std::size_t i) { texts[i] = text_of(first + i); });
    for (std::size_t i = 0; i < count; ++i) out << texts[i];
  }
}

}  // namespace

int ResultTable::ExitCode() const {
  if (!missing.empty()) return kExitMissing;
  const auto fitted = totals.find(TaskStatus::kFitted);
  return fitted != totals.end() && fitted->second == rows.size() ? kExitDone : kExitFit;
}

ResultTable MakeTable(const WorkList& list, const Records& records, int threads) {
  std::unordered_map<std::string_view, std::string_view> settings;
  for (const Task& task : list.tasks) settings.emplace(task.id, task.settings);
  const std::unordered_map<std::string_view, const DoneRecord*> latest = LatestDone(records, settings);
  std::vector<const Task*> tasks;
  for (const Task& task : list.tasks) tasks.push_back(&task);
  std::sort(tasks.begin(), tasks.end(), [](const Task* a, const Task* b) { return a->id < b->id; });
  ResultTable table;
  table.list = &list;
  table.records = &records;
  for (const Task* task : tasks) {
    const auto done = latest.find(task->id);
    if (done == latest.end()) {
      table.missing.push_back(task);
      continue;
    }
    table.rows.push_back({task, done->second});
    ++table.totals[done->second->status];
  }
  std::vector<BlockColumns> blocks(Blocks(table));
  ParallelFor(blocks.size(), threads, [&](std::size_t block) { blocks[block] = ColumnsOf(table, block); });
  OrderedNames results;
  std::size_t hint = 0;
  const auto add = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names) results.Add(name, &hint);
  };
  add(kOfTask);
  add(FixedResultColumns());
  for (BlockColumns& block : blocks) {
    add(block.names.names());
    for (const auto& [verdict, count] : block.verdicts) table.verdicts[verdict] += count;
  }
  table.extra_columns = ApartFrom(results.names(), list.extra_columns);
  table.columns = kFirst;
  table.columns.insert(table.columns.end(), table.extra_columns.begin(), table.extra_columns.end());
  table.columns.insert(table.columns.end(), results.names().begin(), results.names().end());
  return table;
}

RowTexts::RowTexts(const ResultTable& table) : table_(table), reader_(*table.records), texts_(table.columns.size()) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) places_.emplace(table.columns[i], i);
}

const std::vector<std::string>& RowTexts::Of(const ResultTable::Row& row) {
  for (std::string& text : texts_) text.clear();
  std::size_t place = 0;
  const auto put = [&](std::string_view name, std::string_view text) {
    if (place + 1 >= table_.columns.size() || table_.columns[++place] != name) place = places_.at(name);
    texts_[place] = text;
  };
  put("id", row.task->id);
  put("file", row.task->file);
  for (std::size_t i = 0; i < table_.extra_columns.size(); ++i) put(table_.extra_columns[i], row.task->extra[i]);
  put("status", NameOf(row.done->status));
  put("message", row.done->message);
  put("sha256", row.done->sha256);
  put("key", row.done->key);
  const std::string_view result = reader_.Read(*row.done);
  if (result.empty()) return texts_;
  for (const FlatMember& member : FlatMembers(result))
    put(member.name, member.kind == FlatMember::Kind::kNull ? "" : member.value);
  return texts_;
}

std::string Said(const std::string& id, const std::string& message) {
  const std::string said = Excerpt(message, 400);
  if (message.starts_with(id + ":")) return said;
  return Excerpt(id, 200) + (message.empty() ? "" : ": ") + said;
}

std::vector<std::string> ReservedColumns() {
  std::vector<std::string> names = kFirst;
  names.insert(names.end(), kOfTask.begin(), kOfTask.end());
  names.insert(names.end(), FixedResultColumns().begin(), FixedResultColumns().end());
  names.emplace_back("result");  // the member of results.jsonl
  return names;
}

void WriteCsv(const ResultTable& table, int threads, std::ostream& out) {
  std::string head;
  AppendLine(table.columns, &head);
  out << head;
  WriteBlocks(table, threads, out, [&](std::size_t block) {
    std::string text;
    RowTexts texts(table);
    ForBlock(table, block, [&](const ResultTable::Row& row) { AppendLine(texts.Of(row), &text); });
    return text;
  });
}

void WriteJsonLines(const ResultTable& table, int threads, std::ostream& out) {
  WriteBlocks(table, threads, out, [&](std::size_t block) {
    std::string text;
    RowReader reader(*table.records);
    ForBlock(table, block, [&](const ResultTable::Row& row) {
      nlohmann::ordered_json json = {{"id", row.task->id}, {"file", row.task->file}};
      for (std::size_t i = 0; i < row.task->extra.size(); ++i) json[table.list->extra_columns[i]] = row.task->extra[i];
      json["status"] = NameOf(row.done->status);
      json["message"] = row.done->message;
      json["sha256"] = row.done->sha256;
      json["key"] = row.done->key;
      std::string line = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
      line.pop_back();
      const std::string_view result = reader.Read(*row.done);
      text += line;
      text += ",\"result\":";
      text += result.empty() ? "null" : result;
      text += "}\n";
    });
    return text;
  });
}

void WriteRuns(const ResultTable& table, std::ostream& out) {
  std::unordered_set<const DoneRecord*> counts;
  for (const ResultTable::Row& row : table.rows) counts.insert(row.done);
  struct Run {
    double begun;
    std::string_view id;
    const DoneRecord* done;  // null: of a death
    std::size_t segment;
  };
  std::vector<Run> runs;
  for (const DoneRecord& done : table.records->done)
    runs.push_back({done.at - done.seconds, done.id, &done, done.segment});
  for (const auto& [id, deaths] : table.records->deaths) {
    for (const StartRecord& start : deaths) runs.push_back({start.at, id, nullptr, start.segment});
  }
  // Of two that began at once in one segment the first line stays first.
  std::stable_sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) {
    return std::tie(a.begun, a.id, a.segment) < std::tie(b.begun, b.id, b.segment);
  });
  out << "id,status,counts,begun,seconds,threads,peak_mb,host,segment\n";
  std::string line;
  for (const Run& run : runs) {
    const Segment& segment = table.records->segments[run.segment];
    line.clear();
    if (run.done == nullptr) {
      AppendLine({std::string(run.id), "died", "no", UtcText(run.begun), "", "", "", segment.host, segment.name},
                 &line);
    } else {
      AppendLine({std::string(run.id), NameOf(run.done->status), counts.contains(run.done) ? "yes" : "no",
                  UtcText(run.begun), fmt::format("{:.6f}", run.done->seconds), std::to_string(run.done->threads),
                  fmt::format("{:.1f}", run.done->peak_mb), segment.host, segment.name},
                 &line);
    }
    out << line;
  }
}

}  // namespace lobefit

#include "lobefit/batch/results/results.h"

#include <algorithm>
#include <ctime>
#include <unordered_map>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/parallel.h"
#include "lobefit/base/text.h"
#include "lobefit/batch/list/csv_text.h"
#include "lobefit/batch/results/result_row.h"

namespace lobefit {
namespace {

const std::vector<std::string> kFirst = {"id", "file"};
const std::vector<std::string> kOfTask = {"status", "verdict", "message", "sha256", "key"};

// Places of columns by name; new names are appended.
class Columns {
 public:
  std::size_t PlaceOf(const std::string& name) {
    const auto [place, is_new] = places_.emplace(name, names_.size());
    if (is_new) names_.push_back(name);
    return place->second;
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::unordered_map<std::string, std::size_t> places_;
  std::vector<std::string> names_;
};

std::string UtcText(double seconds) {
  const auto whole = static_cast<std::time_t>(seconds);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(whole),
                     static_cast<int>((seconds - static_cast<double>(whole)) * 1000));
}

void AppendLine(const std::vector<std::string>& fields, std::string* text) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) *text += ',';
    *text += CsvField(fields[i]);
  }
  *text += '\n';
}

}  // namespace

int ResultTable::ExitCode() const {
  if (!missing.empty()) return kExitMissing;
  const auto fitted = totals.find(TaskStatus::kFitted);
  return fitted != totals.end() && fitted->second == rows.size() ? kExitDone : kExitFit;
}

ResultTable MakeTable(const WorkList& list, const Records& records, int threads) {
  std::unordered_map<std::string, std::string> settings;
  for (const Task& task : list.tasks) settings.emplace(task.id, task.settings);
  const std::unordered_map<std::string, const DoneRecord*> latest = LatestDone(records, settings);
  std::vector<const Task*> tasks;
  for (const Task& task : list.tasks) tasks.push_back(&task);
  std::sort(tasks.begin(), tasks.end(), [](const Task* a, const Task* b) { return a->id < b->id; });
  ResultTable table;
  for (const Task* task : tasks) {
    const auto done = latest.find(task->id);
    if (done == latest.end()) {
      table.missing.push_back(task);
      continue;
    }
    table.rows.push_back({task, done->second, {}});
    ++table.totals[done->second->status];
  }
  std::vector<std::vector<std::pair<std::string, std::string>>> parsed(table.rows.size());
  constexpr std::size_t kBlock = 256;
  ParallelFor((table.rows.size() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    for (std::size_t i = block * kBlock; i < std::min(table.rows.size(), (block + 1) * kBlock); ++i) {
      if (!table.rows[i].done->row.empty()) parsed[i] = CellsOf(table.rows[i].done->row);
    }
  });

  Columns columns;
  for (const std::string& name : kFirst) columns.PlaceOf(name);
  for (const std::string& name : list.extra_columns) columns.PlaceOf(name);
  for (const std::string& name : kOfTask) columns.PlaceOf(name);
  for (const std::string& name : FixedResultColumns()) columns.PlaceOf(name);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    ResultTable::Row& row = table.rows[r];
    const auto put = [&](const std::string& name, std::string text) {
      if (!text.empty()) row.cells.emplace_back(columns.PlaceOf(name), std::move(text));
    };
    row.cells.reserve(parsed[r].size() + kFirst.size() + kOfTask.size() + list.extra_columns.size());
    put("id", row.task->id);
    put("file", row.task->file);
    for (std::size_t i = 0; i < list.extra_columns.size(); ++i) put(list.extra_columns[i], row.task->extra[i]);
    put("status", NameOf(row.done->status));
    put("message", row.done->message);
    put("sha256", row.done->sha256);
    put("key", row.done->key);
    // A column is there even where every text of it is empty.
    for (auto& [name, text] : parsed[r]) columns.PlaceOf(name), put(name, std::move(text));
    parsed[r] = {};
  }
  table.columns = columns.names();
  return table;
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
  return names;
}

std::string ToCsv(const ResultTable& table) {
  std::string text;
  AppendLine(table.columns, &text);
  std::vector<std::string> fields;
  for (const ResultTable::Row& row : table.rows) {
    fields.assign(table.columns.size(), "");
    for (const auto& [column, cell] : row.cells) fields[column] = cell;
    AppendLine(fields, &text);
  }
  return text;
}

std::string ToJsonLines(const ResultTable& table) {
  std::string text;
  for (const ResultTable::Row& row : table.rows) {
    nlohmann::ordered_json json = {{"id", row.task->id}, {"file", row.task->file}};
    for (std::size_t i = 0; i < row.task->extra.size(); ++i)
      json[table.columns[kFirst.size() + i]] = row.task->extra[i];
    json["status"] = NameOf(row.done->status);
    json["message"] = row.done->message;
    json["sha256"] = row.done->sha256;
    json["key"] = row.done->key;
    std::string line = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    line.pop_back();
    text += line;
    text += ",\"result\":";
    text += row.done->row.empty() ? std::string_view("null") : row.done->row;
    text += "}\n";
  }
  return text;
}

std::string RunsToCsv(const WorkList& list, const Records& records) {
  std::unordered_map<std::string, std::string> settings;
  for (const Task& task : list.tasks) settings.emplace(task.id, task.settings);
  const std::unordered_map<std::string, const DoneRecord*> latest = LatestDone(records, settings);
  struct Run {
    double begun;
    std::vector<std::string> fields;
  };
  std::vector<Run> runs;
  for (const DoneRecord& done : records.done) {
    const auto counts = latest.find(done.id);
    const Segment& segment = records.segments[done.segment];
    const double begun = done.at - done.seconds;
    runs.push_back({begun,
                    {done.id, NameOf(done.status), counts != latest.end() && counts->second == &done ? "yes" : "no",
                     UtcText(begun), fmt::format("{:.6f}", done.seconds), std::to_string(done.threads),
                     fmt::format("{:.1f}", done.peak_mb), segment.host, segment.name}});
  }
  for (const auto& [id, deaths] : records.deaths) {
    for (const StartRecord& start : deaths) {
      const Segment& segment = records.segments[start.segment];
      runs.push_back({start.at, {id, "died", "no", UtcText(start.at), "", "", "", segment.host, segment.name}});
    }
  }
  std::sort(runs.begin(), runs.end(),
            [](const Run& a, const Run& b) { return a.begun != b.begun ? a.begun < b.begun : a.fields < b.fields; });
  std::string text = "id,status,counts,begun,seconds,threads,peak_mb,host,segment\n";
  for (const Run& run : runs) AppendLine(run.fields, &text);
  return text;
}

}  // namespace lobefit

#include "lobefit/batch/collect.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/base/version.h"
#include "lobefit/batch/index/index_page.h"

namespace lobefit {
namespace {

constexpr std::size_t kNamed = 10;
constexpr TaskStatus kStatuses[] = {TaskStatus::kFitted, TaskStatus::kDoubtful, TaskStatus::kFailed,
                                    TaskStatus::kCrashed};

std::size_t Total(const ResultTable& table, TaskStatus status) {
  const auto found = table.totals.find(status);
  return found == table.totals.end() ? 0 : found->second;
}

}  // namespace

void WriteResults(const ResultTable& table, int threads, const std::filesystem::path& out) {
  WriteFileAtomically(out / "results.csv", [&](std::ostream& file) { WriteCsv(table, threads, file); });
  WriteFileAtomically(out / "results.jsonl", [&](std::ostream& file) { WriteJsonLines(table, threads, file); });
  WriteFileAtomically(out / "runs.csv", [&](std::ostream& file) { WriteRuns(table, file); });
  IndexOptions options;
  options.title = std::filesystem::absolute(out).lexically_normal().filename().string();
  if (options.title.empty()) options.title = "batch";
  WriteFileAtomically(out / "index.html", IndexPage(table, out, options));
}

std::string StatusToText(const ResultTable& table) {
  std::string text = fmt::format("Tasks:   {} listed", table.rows.size() + table.missing.size());
  for (const TaskStatus status : kStatuses) {
    if (const std::size_t count = Total(table, status); count > 0)
      text += fmt::format(", {} {}", count, NameOf(status));
  }
  text += table.missing.empty() ? "\n" : fmt::format(", {} missing\n", table.missing.size());
  std::size_t failed = 0;
  for (const ResultTable::Row& row : table.rows) {
    if (row.done->document_bytes > 0) continue;
    if (failed++ < kNamed)
      text += fmt::format("{}: {}\n", NameOf(row.done->status), Said(row.task->id, row.done->message));
  }
  if (failed > kNamed) text += fmt::format("... and {} more that failed; all are in results.csv\n", failed - kNamed);
  for (std::size_t i = 0; i < table.missing.size() && i < kNamed; ++i)
    text += fmt::format("missing: {}\n", Excerpt(table.missing[i]->id, 200));
  if (table.missing.size() > kNamed)
    text += fmt::format("... and {} more that are missing\n", table.missing.size() - kNamed);
  return text;
}

std::string StatusToJson(const ResultTable& table) {
  nlohmann::ordered_json json = {
      {"format", "lobefit batch status"}, {"version", Version()}, {"listed", table.rows.size() + table.missing.size()}};
  for (const TaskStatus status : kStatuses) json[NameOf(status)] = Total(table, status);
  nlohmann::ordered_json failures = nlohmann::ordered_json::array(), missing = failures;
  for (const ResultTable::Row& row : table.rows) {
    if (row.done->document_bytes > 0) continue;
    failures.push_back({{"id", row.task->id},
                        {"status", NameOf(row.done->status)},
                        {"exit_code", row.done->exit_code},
                        {"message", row.done->message}});
  }
  for (const Task* task : table.missing) missing.push_back(task->id);
  json["failures"] = failures;
  json["missing"] = missing;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace lobefit

#include "lobefit/batch/index/index_page.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "lobefit/base/base64.h"
#include "lobefit/base/file.h"
#include "lobefit/base/printable.h"
#include "lobefit/base/text.h"
#include "lobefit/batch/index/assets.h"
#include "lobefit/batch/results/result_row.h"
#include "lobefit/math/student_t.h"
#include "lobefit/report/web/template.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostNamed = 50;  // missing tasks that are named

// Columns of the page: what is left out is for programs, and in results.csv.
bool IsShown(const std::string& column) {
  static const std::set<std::string> hidden = {"file", "sha256", "key", "cost", "metric", "format", "channels"};
  return !hidden.contains(column) && !column.ends_with(".stderr") && !column.ends_with(".stderr_clustered") &&
         !column.ends_with(".clustered_freedom");
}

// A number with the digits that a page shows, or the text.
Json Shown(const std::string& text) {
  if (text.empty()) return nullptr;
  const std::optional<double> value = ParseDouble(text);
  if (!value) return text;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", *value);
  return Json::parse(digits, nullptr, false);
}

// Half the 95 % interval of a parameter: by the clustered error where there is one.
Json HalfInterval(const std::string& error, const std::string& clustered, const std::string& freedom) {
  constexpr double kUpper = 0.975;
  constexpr double kNormal = 1.959964;
  const std::optional<double> of_clusters = ParseDouble(clustered), of_samples = ParseDouble(error),
                              degrees = ParseDouble(freedom);
  char digits[32];
  if (of_clusters && degrees && *degrees > 0) {
    std::snprintf(digits, sizeof digits, "%.6g", *of_clusters * StudentTQuantile(kUpper, *degrees));
  } else if (of_samples) {
    std::snprintf(digits, sizeof digits, "%.6g", *of_samples * kNormal);
  } else {
    return nullptr;
  }
  return Json::parse(digits, nullptr, false);
}

std::string TextOf(const ResultTable::Row& row, std::size_t column) {
  for (const auto& [at, text] : row.cells) {
    if (at == column) return text;
  }
  return "";
}

// The rows of the page: failures first, then by id, as many as it takes; by id again.
std::vector<const ResultTable::Row*> ChooseRows(const ResultTable& table, std::size_t most) {
  std::vector<const ResultTable::Row*> rows;
  for (const bool documents : {false, true}) {
    for (const ResultTable::Row& row : table.rows) {
      const bool has = row.done->document_bytes > 0;
      if (has == documents && rows.size() < most) rows.push_back(&row);
    }
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

Json Pictures(const std::vector<const ResultTable::Row*>& rows, const std::filesystem::path& out, std::size_t most) {
  Json pictures = Json::array();
  std::size_t taken = 0;
  for (const ResultTable::Row* row : rows) {
    pictures.push_back(nullptr);
    if (row->done->document_bytes == 0 || taken == most) continue;
    for (const bool measured : {true, false}) {
      const std::filesystem::path path = ResultPath(out, row->task->id, measured ? ".spheres.png" : ".sphere.png");
      std::error_code error;
      if (!std::filesystem::exists(path, error)) continue;
      pictures.back() = {{"measured", measured}, {"png", Base64(FileBytes(path).bytes())}};
      ++taken;
      break;
    }
  }
  return pictures;
}

Json DataOf(const ResultTable& table, const std::filesystem::path& out, const IndexOptions& options) {
  const std::vector<const ResultTable::Row*> rows = ChooseRows(table, options.most_rows);
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < table.columns.size(); ++i) place[table.columns[i]] = i;
  // Columns in which no row has anything say nothing.
  std::set<std::size_t> filled;
  for (const ResultTable::Row* row : rows) {
    for (const auto& [column, text] : row->cells) filled.insert(column);
  }
  std::vector<std::size_t> shown;
  for (const std::size_t i : filled) {
    if (IsShown(table.columns[i])) shown.push_back(i);
  }
  // Cells by column, and the half intervals of those that have errors.
  Json json_rows = Json::array(), columns = Json::array(), errors = Json::object(), reports = Json::array();
  std::vector<bool> is_text(shown.size(), false);
  for (const ResultTable::Row* row : rows) {
    Json cells = Json::array();
    for (std::size_t k = 0; k < shown.size(); ++k) {
      cells.push_back(Shown(TextOf(*row, shown[k])));
      is_text[k] = is_text[k] || cells.back().is_string();
    }
    std::error_code error;
    if (std::filesystem::exists(ResultPath(out, row->task->id, ".report.html"), error))
      reports.push_back(json_rows.size());
    json_rows.push_back(cells);
  }
  std::string scatter_y;
  std::size_t scatter_values = 0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const std::string& name = table.columns[shown[k]];
    const auto error = place.find(name + ".stderr");
    columns.push_back({{"name", name}, {"text", static_cast<bool>(is_text[k])}});
    if (error == place.end()) continue;
    // The reflectance that most rows have, which with the width says most of a material.
    const auto values = static_cast<std::size_t>(
        std::count_if(json_rows.begin(), json_rows.end(), [&](const Json& cells) { return cells[k].is_number(); }));
    if (values > scatter_values && (name.starts_with("f0") || name.starts_with("scale"))) {
      scatter_y = name;
      scatter_values = values;
    }
    Json column = Json::array();
    for (const ResultTable::Row* row : rows) {
      const auto text = [&](const char* ending) {
        const auto at = place.find(name + ending);
        return at == place.end() ? std::string() : TextOf(*row, at->second);
      };
      column.push_back(HalfInterval(text(".stderr"), text(".stderr_clustered"), text(".clustered_freedom")));
    }
    errors[std::to_string(k)] = column;
  }
  Json totals = {{"listed", table.rows.size() + table.missing.size()}};
  for (const TaskStatus status :
       {TaskStatus::kFitted, TaskStatus::kDoubtful, TaskStatus::kFailed, TaskStatus::kCrashed})
    totals[NameOf(status)] = table.totals.contains(status) ? table.totals.at(status) : 0;
  totals["missing"] = table.missing.size();
  Json verdicts = Json::object(), missing = Json::array();
  for (const ResultTable::Row& row : table.rows) {
    const std::string verdict = TextOf(row, place.at("verdict"));
    if (!verdict.empty()) verdicts[verdict] = verdicts.value(verdict, 0) + 1;
  }
  for (const Task* task : table.missing) {
    if (missing.size() < kMostNamed) missing.push_back(task->id);
  }
  return {{"totals", totals},
          {"verdicts", verdicts},
          {"missing", missing},
          {"columns", columns},
          {"rows", json_rows},
          {"errors", errors},
          {"reports", reports},
          {"scatter_y", scatter_y},
          {"most_pictures", options.most_pictures},
          {"pictures", Pictures(rows, out, options.most_pictures)}};
}

}  // namespace

std::string IndexPage(const ResultTable& table, const std::filesystem::path& out, const IndexOptions& options) {
  std::string data = DataOf(table, out, options).dump(-1, ' ', false, Json::error_handler_t::replace);
  // Within a script element nothing of the data may look like its end.
  for (std::size_t at = data.find('<'); at != std::string::npos; at = data.find('<', at + 6))
    data.replace(at, 1, "\\u003c");
  // Only the page's own script and style, and no connection to anywhere.
  const std::string policy = Join({"default-src 'none'; img-src data:; style-src '", PolicyHash(kIndexCss),
                                   "'; script-src '", PolicyHash(kIndexJs), "'"},
                                  "");
  return FillTemplate(kIndexHtml,
                      {{"policy", policy},
                       {"title", MarkupText(options.title)},
                       {"style", std::string(kIndexCss)},
                       {"script", std::string(kIndexJs)},
                       {"data", data}},
                      {});
}

}  // namespace lobefit

#include "lobefit/batch/index/index_page.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/batch/index/assets.h"
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

// Columns of names and words, also where one of them reads as a number: an id may be "550" or "nan".
bool HoldsText(const std::string& column) {
  static const std::set<std::string> texts = {"id", "status", "verdict", "message", "recipe", "model"};
  return texts.contains(column);
}

// With the digits that a page shows; JSON has no number that is not finite.
Json Shown(double value) {
  if (!std::isfinite(value)) return nullptr;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", value);
  return Json::parse(digits);
}

// A number with the digits that a page shows, or the text.
Json Shown(const std::string& text) {
  if (text.empty()) return nullptr;
  const std::optional<double> value = ParseDouble(text);
  return value && std::isfinite(*value) ? Shown(*value) : Json(text);
}

// Half the 95 % interval of a parameter: by the clustered error where there is one.
Json HalfInterval(const std::string& error, const std::string& clustered, const std::string& freedom) {
  constexpr double kUpper = 0.975;
  constexpr double kNormal = 1.959964;
  const std::optional<double> of_clusters = ParseDouble(clustered), of_samples = ParseDouble(error),
                              degrees = ParseDouble(freedom);
  if (of_clusters && degrees && *degrees > 0) return Shown(*of_clusters * StudentTQuantile(kUpper, *degrees));
  return of_samples ? Shown(*of_samples * kNormal) : Json(nullptr);
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

Json Pictures(const ResultTable& table, const std::vector<const ResultTable::Row*>& rows, std::size_t most) {
  Json pictures = Json::array();
  RowReader reader(*table.records);
  std::size_t taken = 0;
  for (const ResultTable::Row* row : rows) {
    pictures.push_back(nullptr);
    const std::string_view picture = taken < most ? reader.ReadPicture(*row->done) : "";
    if (picture.empty()) continue;
    pictures.back() = {{"measured", row->done->picture_is_measured}, {"png", picture}};
    ++taken;
  }
  return pictures;
}

// The columns of the page with what their rows hold.
class PageColumns {
 public:
  PageColumns(const ResultTable& table, const std::vector<const ResultTable::Row*>& rows) : table_(table) {
    std::map<std::string_view, std::size_t> place;
    for (std::size_t i = 0; i < table.columns.size(); ++i) place[table.columns[i]] = i;
    const auto find = [&](const std::string& name) {
      const auto at = place.find(name);
      return at == place.end() ? kNone : at->second;
    };
    // Columns in which no row has anything say nothing.
    std::vector<bool> filled(table.columns.size(), false);
    RowTexts texts(table);
    for (const ResultTable::Row* row : rows) {
      const std::vector<std::string>& fields = texts.Of(*row);
      for (std::size_t i = 0; i < fields.size(); ++i) filled[i] = filled[i] || !fields[i].empty();
    }
    for (std::size_t i = 0; i < filled.size(); ++i) {
      const std::string& name = table.columns[i];
      if (filled[i] && IsShown(name))
        columns_.push_back({i, find(name + ".stderr"), find(name + ".stderr_clustered"),
                            find(name + ".clustered_freedom"), HoldsText(name), HoldsText(name), 0, Json::array()});
    }
    for (const ResultTable::Row* row : rows) Add(texts.Of(*row));
  }

  // Columns, rows by column, half intervals by place of the column, and what is drawn against the width at first: the
  // reflectance that most rows have, which with it says most of a material, or where fewer than half have one the
  // error, which all have.
  Json ToJson() && {
    Json columns = Json::array(), errors = Json::object();
    std::string scatter_y;
    std::size_t most = 0;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      Column& column = columns_[k];
      const std::string& name = table_.columns[column.place];
      columns.push_back({{"name", name}, {"text", column.is_text}});
      if (column.error == kNone) continue;
      errors[std::to_string(k)] = std::move(column.half_intervals);
      if (column.numbers > most && (name.starts_with("f0") || name.starts_with("scale"))) {
        scatter_y = name;
        most = column.numbers;
      }
    }
    const bool has_error = std::any_of(columns_.begin(), columns_.end(), [&](const Column& column) {
      return table_.columns[column.place] == "typical_error";
    });
    if (2 * most < rows_.size() && has_error) scatter_y = "typical_error";
    return {{"columns", columns}, {"rows", std::move(rows_)}, {"errors", errors}, {"scatter_y", scatter_y}};
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Column {
    std::size_t place, error, clustered, freedom;  // in the table
    const bool is_name;                            // a text whatever it looks like
    bool is_text;                                  // some of its fields
    std::size_t numbers;
    Json half_intervals;
  };

  void Add(const std::vector<std::string>& fields) {
    const auto text = [&](std::size_t place) { return place == kNone ? std::string() : fields[place]; };
    Json cells = Json::array();
    for (Column& column : columns_) {
      const std::string& field = fields[column.place];
      cells.push_back(column.is_name && !field.empty() ? Json(field) : Shown(field));
      column.is_text = column.is_text || cells.back().is_string();
      column.numbers += cells.back().is_number() ? 1 : 0;
      if (column.error == kNone) continue;
      column.half_intervals.push_back(HalfInterval(text(column.error), text(column.clustered), text(column.freedom)));
    }
    rows_.push_back(std::move(cells));
  }

  const ResultTable& table_;
  std::vector<Column> columns_;
  Json rows_ = Json::array();
};

Json DataOf(const ResultTable& table, const std::filesystem::path& out, const IndexOptions& options) {
  const std::vector<const ResultTable::Row*> rows = ChooseRows(table, options.most_rows);
  Json data = PageColumns(table, rows).ToJson();
  Json reports = Json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::error_code error;
    if (std::filesystem::exists(ResultPath(out, rows[i]->task->id, ".report.html"), error)) reports.push_back(i);
  }
  Json totals = {{"listed", table.rows.size() + table.missing.size()}};
  for (const TaskStatus status :
       {TaskStatus::kFitted, TaskStatus::kDoubtful, TaskStatus::kFailed, TaskStatus::kCrashed})
    totals[NameOf(status)] = table.totals.contains(status) ? table.totals.at(status) : 0;
  totals["missing"] = table.missing.size();
  Json missing = Json::array();
  for (const Task* task : table.missing) {
    if (missing.size() < kMostNamed) missing.push_back(task->id);
  }
  data["totals"] = totals;
  data["verdicts"] = table.verdicts;
  data["missing"] = missing;
  data["reports"] = reports;
  data["most_pictures"] = options.most_pictures;
  data["pictures"] = Pictures(table, rows, options.most_pictures);
  return data;
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

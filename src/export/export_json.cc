#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/files/file.h"
#include "lobefit/base/version.h"
#include "lobefit/export/export.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json LevelsJson(const ErrorLevels& levels) {
  const auto level = [&](double value) { return levels.compared == 0 ? Json() : Json(value); };
  return {{"median", level(levels.median)},
          {"percentile_90", level(levels.percentile_90)},
          {"maximum", level(levels.maximum)},
          {"compared", levels.compared}};
}

// The levels over all pairs of directions stand at the top.
Json ErrorJson(const ExportError& error) {
  Json json = {{"relative_to", "the fit's f_r"}, {"floor_per_sr", kErrorFloor}, {"theta_max_deg", 88}};
  json.update(LevelsJson(error.uniform));
  json["in_lobe"] = LevelsJson(error.lobe);
  json["off_lobe"] = LevelsJson(error.off);
  json["albedo"] = error.albedo;
  return json;
}

const char* Words(Carries how) {
  switch (how) {
    case Carries::kExactly:
      return "exactly";
    case Carries::kApproximately:
      return "approximately";
    case Carries::kNot:
      break;
  }
  return "not";
}

Json ResultJson(const ExportResult& result) {
  Json files = Json::array(), carries = Json::array();
  for (const std::filesystem::path& file : result.files) files.push_back(file.filename().string());
  for (const Carried& row : result.carries) {
    carries.push_back({{"feature", NameOf(row.feature)}, {"carried", Words(row.how)}, {"note", row.note}});
  }
  Json json = {{"target", result.target->name}, {"files", files},
               {"bytes", result.bytes},         {"seconds", result.seconds},
               {"numbers", result.numbers},     {"relative_error", ErrorJson(result.error)}};
  if (result.other) json["relative_error_of_the_other_numbers"] = ErrorJson(*result.other);
  if (!result.choice.empty()) json["choice"] = result.choice;
  json["carries"] = carries;
  json["notes"] = result.notes;
  json["load"] = result.load;
  return json;
}

// Rows of other targets that an earlier export of the same thing left.
Json EarlierRows(const std::filesystem::path& path, const ExportSource& source,
                 const std::vector<ExportResult>& results) {
  Json rows = Json::array();
  std::ifstream in(path);
  const Json earlier = Json::parse(in, nullptr, false);
  if (!earlier.is_object() || earlier.value(source.kind + "_sha256", "") != source.sha256 ||
      !earlier.contains("targets"))
    return rows;
  for (const Json& row : earlier["targets"]) {
    bool replaced = !row.is_object();
    for (const ExportResult& result : results) replaced = replaced || row.value("target", "") == result.target->name;
    if (!replaced) rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string ExportJson(const ExportSource& source, const ExportOptions& options, const ExportOutcome& outcome) {
  Json rows = EarlierRows(options.folder / (options.name + ".export.json"), source, outcome.results);
  for (const ExportResult& result : outcome.results) rows.push_back(ResultJson(result));
  Json refused = Json::array();
  for (const Refusal& refusal : outcome.refusals) {
    refused.push_back({{"target", refusal.target->name}, {"reason", refusal.reason}});
  }
  const Json json = {{source.kind, options.material_file},
                     {source.kind + "_sha256", source.sha256},
                     {"source", source.source},
                     {"version", Version()},
                     {"command", options.command},
                     {"remarks", outcome.remarks},
                     {"refused", refused},
                     {"targets", rows}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string ExportJson(const Material& material, const ExportOptions& options, const ExportOutcome& outcome) {
  return ExportJson({"material", Sha256Hex(ToJson(material)), material.source.file}, options, outcome);
}

}  // namespace lobefit

#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/file.h"
#include "lobefit/base/version.h"
#include "lobefit/export/export.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json ErrorJson(const ExportError& error) {
  return {{"median", error.median},
          {"percentile_90", error.percentile_90},
          {"maximum", error.maximum},
          {"albedo", error.albedo},
          {"compared", error.compared}};
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
    carries.push_back({{"feature", row.feature}, {"carried", Words(row.how)}, {"note", row.note}});
  }
  Json json = {{"target", result.target->name}, {"files", files},
               {"bytes", result.bytes},         {"seconds", result.seconds},
               {"numbers", result.numbers},     {"relative_error", ErrorJson(result.error)}};
  if (result.other) json["relative_error_of_the_other_numbers"] = ErrorJson(*result.other);
  json["carries"] = carries;
  json["notes"] = result.notes;
  json["load"] = result.target->load;
  return json;
}

// Rows of other targets that an earlier export of the same material left.
Json EarlierRows(const std::filesystem::path& path, const std::string& digest,
                 const std::vector<ExportResult>& results) {
  Json rows = Json::array();
  std::ifstream in(path);
  const Json earlier = Json::parse(in, nullptr, false);
  if (!earlier.is_object() || earlier.value("material_sha256", "") != digest || !earlier.contains("targets"))
    return rows;
  for (const Json& row : earlier["targets"]) {
    bool replaced = !row.is_object();
    for (const ExportResult& result : results) replaced = replaced || row.value("target", "") == result.target->name;
    if (!replaced) rows.push_back(row);
  }
  return rows;
}

}  // namespace

std::string ExportJson(const Material& material, const ExportOptions& options,
                       const std::vector<ExportResult>& results) {
  const std::string digest = Sha256Hex(ToJson(material));
  Json rows = EarlierRows(options.folder / (options.name + ".export.json"), digest, results);
  for (const ExportResult& result : results) rows.push_back(ResultJson(result));
  const Json json = {{"material", options.material_file}, {"material_sha256", digest},
                     {"source", material.source.file},    {"version", Version()},
                     {"command", options.command},        {"targets", rows}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lobefit

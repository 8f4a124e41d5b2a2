#include "lobefit/validate/truth_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kKey = "lobefit.truth: ";

Json Document(const TruthRecord& record) {
  return {{"format", "lobefit truth"},
          {"noise", ToText(record.noise)},
          {"seed", record.seed},
          {"command", record.command},
          {"material", Json::parse(ToJson(MaterialOf(record.truth)))}};
}

std::filesystem::path PathBeside(const std::filesystem::path& path) { return path.string() + ".truth.json"; }

TruthRecord Parse(std::string_view text, const std::string& file) {
  try {
    const Json json = Json::parse(text);
    TruthRecord record;
    record.truth = TruthOf(MaterialFromJson(json.at("material").dump(), file));
    record.noise = ParseNoise(json.at("noise").get<std::string>());
    record.seed = json.at("seed").get<std::uint64_t>();
    record.command = json.at("command").get<std::string>();
    return record;
  } catch (const Json::exception& error) {
    throw InputError(
        fmt::format("{}: its truth is damaged ({}); make the file again with `lobefit synth`", file, error.what()));
  } catch (const UsageError& error) {
    throw InputError(fmt::format("{}: its truth is damaged ({})", file, error.what()));
  }
}

}  // namespace

std::vector<std::string> TruthComments(const TruthRecord& record) {
  std::vector<std::string> comments = {"synthetic measurement, made by: " + record.command};
  for (const Entry& entry : Entries(record.truth.model, record.truth.channels)) {
    comments.push_back(fmt::format("truth, {} = {}", entry.name,
                                   FormatDouble(record.truth.values[entry.parameter][entry.channel] / entry.factor)));
  }
  comments.push_back(fmt::format("noise, {}; seed {}", ToText(record.noise), record.seed));
  comments.push_back(std::string(kKey) + Document(record).dump());
  return comments;
}

std::filesystem::path WriteTruthBeside(const TruthRecord& record, const std::filesystem::path& measurement_path) {
  const std::filesystem::path path = PathBeside(measurement_path);
  WriteFileAtomically(path, Document(record).dump(2) + "\n");
  return path;
}

std::optional<TruthRecord> FindTruth(const std::filesystem::path& measurement_path) {
  const FileBytes file(measurement_path);
  const std::string_view head = file.bytes().substr(0, 1U << 20U);
  const std::size_t key = head.find(kKey);
  if (key != std::string_view::npos) {
    const std::string_view rest = head.substr(key + kKey.size());
    return Parse(rest.substr(0, rest.find_first_of("\r\n")), measurement_path.string());
  }
  std::error_code error;
  const std::filesystem::path beside = PathBeside(measurement_path);
  if (!std::filesystem::exists(beside, error)) return std::nullopt;
  const FileBytes document(beside);
  return Parse(document.bytes(), beside.string());
}

}  // namespace lobefit

// A document as a material: the head, and what stands beside model and instrument.
#include <fstream>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/material/json.h"
#include "lobefit/material/json_reader.h"

namespace lobefit {
namespace {

// What the library says, without the name of its error in brackets.
std::string ReasonOf(const Json::exception& error) {
  const std::string_view reason = error.what();
  const std::size_t end = reason.find("] ");
  return std::string(end == std::string_view::npos ? reason : reason.substr(end + 2));
}

// Members in the order of the file are looked for one after the other: a megabyte of them in one object took 15 s. No
// object of a document has as many as this.
constexpr std::size_t kMostMembers = 1000;

bool HasCrowdedObject(std::string_view text) {
  std::vector<std::size_t> members = {0};  // of the objects that are open
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      quoted = c != '"';
      if (c == '\\') ++i;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      members.push_back(0);
    } else if ((c == '}' || c == ']') && members.size() > 1) {
      members.pop_back();
    } else if (c == ':' && ++members.back() > kMostMembers) {
      return true;
    }
  }
  return false;
}

void ReadRest(const JsonReader& reader, Material* material) {
  const Json& root = reader.root();
  for (const Json& lobe : reader.Member(root, "slope_space")) {
    material->slope_space.push_back({reader.Get<double>(lobe, "slope_x"), reader.Get<double>(lobe, "slope_y"),
                                     reader.Get<double>(lobe, "slope_alpha_x"),
                                     reader.Get<double>(lobe, "slope_alpha_y"), reader.Get<double>(lobe, "slope_r")});
  }
  const Json& covariance = reader.Member(root, "covariance");
  material->covariance_names = reader.Get<std::vector<std::string>>(covariance, "names");
  const std::size_t n = material->covariance_names.size();
  material->covariance = reader.GetMatrix(covariance, "matrix", n);
  if (covariance.contains("clustered")) material->covariance_clustered = reader.GetMatrix(covariance, "clustered", n);
  material->degenerate = reader.Get<std::vector<std::string>>(root, "degenerate");
  const Json& quality = reader.Member(root, "quality");
  material->samples_read = reader.GetCount<std::size_t>(quality, "samples_read");
  material->samples_used = reader.GetCount<std::size_t>(quality, "samples_used");
  const Json& set_aside = reader.Member(quality, "set_aside");
  for (const auto& [reason, count] : set_aside.items())
    material->set_aside[reason] = reader.GetCount<std::size_t>(set_aside, reason.c_str());
  material->cost = reader.GetNumber(quality, "cost");
  material->remarks = reader.Get<std::vector<std::string>>(quality, "remarks");
  if (quality.contains("verdict")) {
    material->verdict = {reader.GetChoice(quality, "verdict", VerdictChoices()),
                         reader.GetNumbers(quality, "typical_error", 0.01)[0],
                         reader.GetNumbers(quality, "noise", 0.01)[0], reader.GetNumbers(quality, "explained", 1)[0],
                         reader.Get<std::string>(quality, "advice")};
  }
  if (quality.contains("energy")) {
    const Json& energy = reader.Member(quality, "energy");
    material->energy = EnergyBalance{};
    material->energy->absolute = reader.Get<bool>(energy, "absolute");
    if (material->energy->absolute) {
      *material->energy = {true,
                           reader.GetNumbers(energy, "largest_albedo", 1)[0],
                           DegreesToRadians(reader.Get<double>(energy, "theta_i_deg")),
                           DegreesToRadians(reader.Get<double>(energy, "phi_i_deg")),
                           reader.Get<std::string>(energy, "channel"),
                           reader.GetCount<std::size_t>(energy, "above_one"),
                           reader.GetCount<std::size_t>(energy, "incidences")};
    }
  }
  if (quality.contains("tried")) {
    for (const Json& entry : reader.Member(quality, "tried")) {
      material->tried.push_back({reader.Get<std::string>(entry, "model"),
                                 reader.GetCount<std::size_t>(entry, "free_parameters"),
                                 reader.GetNumbers(entry, "held_out_error", 1)[0],
                                 reader.GetNumbers(entry, "ratio", 1)[0], reader.Get<bool>(entry, "chosen")});
    }
  }
  if (quality.contains("misfit")) {
    const Json& misfit = reader.Member(quality, "misfit");
    material->misfit = {reader.Get<bool>(misfit, "tested"), reader.Get<bool>(misfit, "flagged"),
                        reader.GetWithin(misfit, "probability", 0, 1), reader.Get<double>(misfit, "size"),
                        reader.Get<std::string>(misfit, "where")};
  }
  if (root.contains("instrument"))
    material->instrument = ReadInstrument(reader, reader.Member(root, "instrument"), material->channels.size());
  for (const auto& [metric, rms] : reader.Member(quality, "errors").items()) {
    material->errors.push_back(
        {metric, rms.is_number() ? rms.get<double>() : std::numeric_limits<double>::quiet_NaN()});
  }
  for (const Json& minimum : reader.Member(root, "minima")) {
    Minimum read;
    read.cost = reader.GetNumber(minimum, "cost");
    read.starts = reader.GetCount<std::size_t>(minimum, "starts");
    for (const auto& [name, value] : reader.Member(minimum, "parameters").items())
      read.parameters.emplace_back(name, value.get<double>());
    material->minima.push_back(read);
  }
  const Json& termination = reader.Member(root, "termination");
  material->termination = {reader.Get<bool>(termination, "converged"), reader.Get<bool>(termination, "determined"),
                           reader.Get<std::string>(termination, "message"),
                           reader.GetCount<int>(termination, "iterations")};
  const Json& timings = reader.Member(root, "timings_s");
  material->timings_s = {{"read", 0.0}, {"fit", 0.0}, {"report", 0.0}};  // where they are not said
  for (const auto& [step, seconds] : timings.items())
    material->timings_s[step] = reader.GetWithin(timings, step.c_str(), 0, std::numeric_limits<double>::max());
  const Json& source = reader.Member(root, "source");
  material->source = {reader.Get<std::string>(source, "file"), reader.Get<std::string>(source, "sha256"),
                      reader.Get<std::string>(source, "format"),
                      reader.Get<std::map<std::string, std::string>>(source, "conventions")};
  const std::string& hash = material->source.sha256;
  if (!hash.empty() && (hash.size() != 64 || hash.find_first_not_of("0123456789abcdef") != std::string::npos))
    reader.Fail("member 'sha256' must hold 64 digits of 0 to 9 and a to f, or none");
  const Json& recipe = reader.Member(root, "recipe");
  material->recipe_name = reader.Get<std::string>(recipe, "name");
  material->recipe_reason = reader.Get<std::string>(recipe, "reason");
  material->metric = reader.Get<std::string>(recipe, "metric");
  material->weighting = reader.Get<std::string>(recipe, "weighting");
  material->loss = reader.Get<std::string>(recipe, "loss");
  material->theta_max_deg = reader.Get<double>(recipe, "theta_max_deg");
  if (recipe.contains("text")) {
    constexpr std::size_t kMostStarts = 100000;
    constexpr int kMostSteps = 100000;
    material->used = {reader.Get<std::string>(recipe, "text"), reader.GetCount<std::size_t>(recipe, "starts"),
                      reader.GetCount<std::uint64_t>(recipe, "seed"), reader.GetCount<int>(recipe, "scouting_steps"),
                      reader.Get<std::map<std::string, std::string>>(recipe, "reading")};
    if (material->used->starts < 1 || material->used->starts > kMostStarts)
      reader.Fail(fmt::format("the recipe's 'starts' is {}; allowed are 1 to {}", material->used->starts, kMostStarts));
    if (material->used->scouting_steps > kMostSteps) {
      reader.Fail(fmt::format("the recipe's 'scouting_steps' is {}; allowed are 0 to {}",
                              material->used->scouting_steps, kMostSteps));
    }
  }
  material->command = reader.Get<std::string>(root, "command");
}

}  // namespace

Material MaterialFromJson(const std::string& text, const std::string& file_name) {
  if (HasCrowdedObject(text)) {
    throw InputError(
        fmt::format("{}: is not a material document of lobefit (one of its objects has more than {} members)",
                    file_name, kMostMembers));
  }
  // Behind blanks and a byte order mark.
  const std::size_t begin = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (begin != std::string::npos && text[begin] != '{') {
    throw InputError(file_name +
                     ": is not a material document of lobefit; if it is a measurement, `lobefit fit` makes one of it");
  }
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is not JSON: {}", file_name, ReasonOf(error)));
  }
  const JsonReader reader(json, file_name);
  if (!json.is_object() || json.value("format", Json()) != Json("lobefit material")) {
    throw InputError(file_name +
                     ": is not a material document of lobefit (its member 'format' must be \"lobefit material\")");
  }
  const std::string version = reader.Get<std::string>(json, "format_version");
  if (version.substr(0, 2) != "1.")
    reader.Fail(fmt::format("format_version {} is not readable here; this version reads 1.x", version));
  try {
    Material material;
    material.model = ReadModel(reader);
    material.channels = reader.Get<std::vector<std::string>>(json, "channels");
    material.wavelengths_nm = reader.Get<std::vector<double>>(json, "wavelengths_nm");
    if (material.channels.empty()) reader.Fail("has no channel");
    if (json.contains("sel")) material.sel = ReadSel(reader, material.channels.size());
    ReadParameters(reader, &material);
    ReadRest(reader, &material);
    return material;
  } catch (const Json::exception& error) {
    reader.Fail(fmt::format("does not follow the schema: {}", ReasonOf(error)));
  }
}

Material ReadMaterial(const std::filesystem::path& path) {
  const FileBytes file(path);
  return MaterialFromJson(std::string(file.bytes()), path.string());
}

Material ReadModelMaterial(const std::filesystem::path& path) {
  Material material = ReadMaterial(path);
  if (material.sel) {
    throw InputError(
        path.string() +
        ": holds a table of squared ellipsoidal lobes, which is no model of the surface; fit a recipe with "
        "[[lobe]] for that");
  }
  return material;
}

bool LooksLikeMaterial(const std::filesystem::path& path) {
  // What a stream holds can be read once only, and is a measurement's.
  if (IsStream(path)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string head(256, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.starts_with('{') && head.find("\"lobefit material\"") != std::string::npos;
}

}  // namespace lobefit

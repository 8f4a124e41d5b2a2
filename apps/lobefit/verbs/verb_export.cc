// lobefit export: the fitted material as files that renderers load, and what each of them cannot carry.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

#include "tasks/maps_export.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/export.h"
#include "lobefit/export/targets.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

struct ExportVerb {
  std::string material, targets, out = ".", name, map_path, normal_y = "up", mitsuba_version;
  double white = kNan;
  bool refit = false, copy = false, list = false;
};

std::string TargetTable() {
  std::string text;
  for (const Target& target : ExportTargets()) {
    text += fmt::format("{:<14} {}\n{:<14} load: {}\n", target.name, target.description, "", LoadText(target, "NAME"));
  }
  return text;
}

std::vector<const Target*> ParseTargets(const std::string& text) {
  std::vector<const Target*> targets;
  for (const std::string_view name : Split(text, ',')) {
    const Target* target = &FindTarget(Trim(name));
    if (std::find(targets.begin(), targets.end(), target) == targets.end()) targets.push_back(target);
  }
  return targets;
}

// True for 3.0 to 3.7.0.
bool IsOldMitsuba(const std::string& version) {
  if (version.empty()) return false;
  std::vector<long long> parts;
  for (const std::string_view part : Split(version, '.')) parts.push_back(ParseInteger(part).value_or(-1));
  const bool valid = parts.size() <= 3 && parts[0] == 3 &&
                     std::all_of(parts.begin(), parts.end(), [](long long part) { return part >= 0; });
  if (!valid)
    throw UsageError(
        fmt::format("--mitsuba-version {}: a version of Mitsuba 3 is allowed, as in 3.7.0", Excerpt(version)));
  parts.resize(3, 0);
  return parts < std::vector<long long>{3, 7, 1};
}

// An option that none of the targets looks at is a mistake of whoever gave it.
void RequireUse(const std::vector<const Target*>& targets, const char* option, bool given,
                const std::function<bool(const Target&)>& uses) {
  const auto is_used = [&](const Target* target) { return uses(*target); };
  if (!given || std::any_of(targets.begin(), targets.end(), is_used)) return;
  std::vector<std::string> names;
  for (const Target& target : ExportTargets()) {
    if (uses(target)) names.emplace_back(target.name);
  }
  throw UsageError(
      fmt::format("{} is an option of {}, and none of these is a target; leave it out", option, Join(names)));
}

int RunExport(const ExportVerb& verb, const CommonOptions& common) {
  if (verb.list) {
    fmt::print("{}", TargetTable());
    return kExitDone;
  }
  if (verb.material.empty() || verb.targets.empty()) {
    throw UsageError(
        "a material and --to TARGET[,TARGET] are needed; the targets are listed by `lobefit export --list`");
  }
  ExportOptions options;
  options.targets = ParseTargets(verb.targets);
  const auto is_mitsuba = [](const Target& target) { return target.name == std::string_view("mitsuba"); };
  RequireUse(options.targets, "--map-path", !verb.map_path.empty(),
             [&](const Target& target) { return is_mitsuba(target) || target.name == std::string_view("pbrt"); });
  RequireUse(options.targets, "--mitsuba-version", !verb.mitsuba_version.empty(), is_mitsuba);
  RequireUse(options.targets, verb.refit ? "--refit" : "--copy", verb.refit || verb.copy,
             [](const Target& target) { return target.own_model != nullptr; });
  options.old_mitsuba = IsOldMitsuba(verb.mitsuba_version);
  options.folder = verb.out;
  std::string own = std::filesystem::path(verb.material).filename().string();
  for (const std::string_view ending : {".json", ".material", ".exr", ".maps"}) {
    if (own.size() > ending.size() && own.ends_with(ending)) own.resize(own.size() - ending.size());
  }
  options.name = ResultName(verb.name, own);
  options.material_file = std::filesystem::path(verb.material).filename().string();
  options.command = common.command;
  options.numbers = verb.refit ? Numbers::kRefitted : verb.copy ? Numbers::kCopied : Numbers::kBetter;
  options.map_path = verb.map_path;
  if (!options.map_path.empty() && !options.map_path.ends_with('/')) options.map_path += '/';
  options.threads = common.Threads();
  if (verb.material.ends_with(".maps.exr")) {
    if (verb.refit || verb.copy) throw UsageError("--refit and --copy are for one material; maps are copied");
    const MapsExportOptions more = {verb.normal_y == "up" ? NormalY::kUp : NormalY::kDown, verb.white};
    return ExportMapsFile(verb.material, options, more, common.json);
  }
  if (!std::isnan(verb.white) || verb.normal_y != "up") throw UsageError("--white and --normal-y are for maps");
  const Material material = ReadMaterial(verb.material);
  const ExportOutcome outcome = ExportMaterial(material, options);
  if (common.json) {
    fmt::print("{}", ExportJson(material, options, outcome));
  } else {
    Print(ExportSummary(outcome));
  }
  if (outcome.refusals.empty()) return kExitDone;
  Print(fmt::format("lobefit: {}: {}; the other targets are written\n", options.material_file,
                    RefusalText(outcome.refusals)),
        stderr);
  return kExitInput;
}

}  // namespace

std::function<int()> SetUpExport(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<ExportVerb>();
  app->add_option("MATERIAL", verb->material,
                  "a *.material.json, or NAME.maps.exr of `lobefit maps` with NAME.maps.json beside it");
  app->add_option("--to", verb->targets, "targets with commas between; --list shows them");
  app->add_option("--out", verb->out, "folder of the files (default: this one)");
  app->add_option("--name", verb->name, "name of the material and its files (default: that of MATERIAL)");
  app->add_option("--map-path", verb->map_path,
                  "folder that pbrt and Mitsuba are to look for pictures in, from the main scene (default: beside it)");
  app->add_option("--normal-y", verb->normal_y,
                  "of maps: up (default, as all targets have it), or down: another picture of the normals for DirectX")
      ->check(CLI::IsMember({"up", "down"}));
  app->add_option("--white", verb->white,
                  "of maps whose stack is not calibrated: the albedo in their unit that becomes 1 (default: the 99.5th "
                  "percentile of diffuse + F0)")
      ->check(CLI::PositiveNumber);
  app->add_option("--mitsuba-version", verb->mitsuba_version,
                  "write the XML of a tilted material for this version of Mitsuba 3; 3.0 to 3.7.0 refuse a property "
                  "that newer ones need (default: 3.7.1 and newer)");
  CLI::Option* refit = app->add_flag("--refit", verb->refit,
                                     "fit the target's own model to the fit instead of copying its numbers (default: "
                                     "whichever is nearer)");
  app->add_flag("--copy", verb->copy, "copy the numbers of the fit")->excludes(refit);
  app->add_flag("--list", verb->list, "list the targets");
  return [=] { return RunExport(*verb, *common); };
}

}  // namespace lobefit

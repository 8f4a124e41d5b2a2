// lobefit maps: one fit a texel of an image stack.
#include <algorithm>
#include <memory>

#include "options/recipe_options.h"
#include "options/stack_options.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/batch/results/results.h"
#include "lobefit/maps/run.h"
#include "lobefit/maps/stack/normal_map.h"

namespace lobefit {
namespace {

struct MapsVerb {
  std::string stack, recipe = "ggx-maps", rows, out = ".", name, left_out, normal_y = "up";
  StackOptions options;
  bool merge = false;
};

MapRecipe LoadMapRecipe(const std::string& name_or_path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(name_or_path, error)) return ReadMapRecipe(name_or_path);
  const std::filesystem::path folder = RecipeFolder() / "maps";
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  if (std::find(names.begin(), names.end(), name_or_path) != names.end())
    return ReadMapRecipe(folder / (name_or_path + ".toml"));
  throw InputError(fmt::format("recipe '{}' is neither a file nor a recipe of {}{}; allowed: {}", Excerpt(name_or_path),
                               folder.string(), DidYouMean(name_or_path, names), Join(names)));
}

std::pair<std::size_t, std::size_t> ParseRows(const std::string& text, std::size_t height) {
  const std::vector<std::string_view> parts = Split(text, ':');
  const std::optional<long long> first = parts.size() == 2 ? ParseInteger(parts[0]) : std::nullopt;
  const std::optional<long long> end = parts.size() == 2 ? ParseInteger(parts[1]) : std::nullopt;
  if (!first || !end || *first < 0 || *end <= *first || static_cast<std::size_t>(*end) > height) {
    throw UsageError(fmt::format("--rows '{}': A:B with 0 <= A < B <= {} is expected, rows A to B-1 from the top",
                                 Excerpt(text), height));
  }
  return {static_cast<std::size_t>(*first), static_cast<std::size_t>(*end)};
}

std::string RowList(const std::vector<std::pair<std::size_t, std::size_t>>& ranges) {
  std::vector<std::string> words;
  for (const auto& [a, b] : ranges) words.push_back(fmt::format("{}:{}", a, b));
  return JoinSome(words);
}

double Percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

// What texels share, of one group of them.
std::string SharedLine(const SharedNumbers& shared, std::size_t group, MapLobe lobe) {
  const SharedNumbers::Group& g = shared.groups[group];
  const HeldNumbers& held = g.held;
  std::vector<std::string> words;
  if (held.normal) {
    const Vec3& n = held.point.normal;
    words.push_back(fmt::format("normal ({:.4f}, {:.4f}, {:.4f})", n.x, n.y, n.z));
  }
  if (held.slope) words.push_back(fmt::format("mean slope ({:.4f}, {:.4f})", held.point.slope[0], held.point.slope[1]));
  if (held.width && lobe == MapLobe::kGgx) {
    words.push_back(fmt::format("alpha {:.4f}, +- {:.2g} of its logarithm", std::exp(held.point.width[0]), g.error[2]));
  } else if (held.width) {
    words.emplace_back("both alphas and their direction");
  }
  if (held.diffuse) words.emplace_back("diffuse");
  if (held.f0) words.emplace_back("f0");
  const std::string of = shared.clusters.centers.empty() ? "the image" : fmt::format("cluster {}", group + 1);
  return fmt::format("  shared       {}: {} ({} texels asked)\n", of,
                     words.empty() ? "nothing is determined" : Join(words), g.texels);
}

std::string Summary(const MapsResult& result, const MapsOptions& options) {
  const MapsSummary& s = result.summary;
  std::string text = fmt::format("  texels       {}", s.texels);
  if (result.fitted_texels > 0 && result.fit_seconds > 0) {
    text += fmt::format(", {:.0f} a second fitted", static_cast<double>(result.fitted_texels) / result.fit_seconds);
  }
  text += fmt::format("\n  normal       determined in {:.1f} %\n", Percent(s.normal, s.texels));
  if (options.recipe.rules.lobe != MapLobe::kNone) {
    text += fmt::format("  lobe         in {:.1f} %", Percent(s.lobe, s.texels));
    text += fmt::format("; alpha determined in {:.1f} %\n", Percent(s.alpha, s.texels));
  }
  for (std::size_t g = 0; g < result.shared.groups.size(); ++g) {
    text += SharedLine(result.shared, g, options.recipe.rules.lobe);
  }
  if (s.too_few + s.not_converged + s.at_bound > 0) {
    text += fmt::format("  doubtful     {} with too few values, {} not converged, {} at a bound\n", s.too_few,
                        s.not_converged, s.at_bound);
  }
  text += fmt::format("  residual     {:.3f} of the texel's 90th percentile (mean), {:.1f} lights used (mean)\n",
                      s.mean_rms, s.mean_used);
  return text;
}

// Files that a result must not replace.
std::vector<std::filesystem::path> Inputs(const Stack& stack) {
  std::vector<std::filesystem::path> inputs = stack.images;
  inputs.insert(inputs.end(), stack.white.begin(), stack.white.end());
  for (const std::filesystem::path& file : {stack.dark, stack.normal_map}) {
    if (!file.empty()) inputs.push_back(file);
  }
  return inputs;
}

int RunMapsVerb(const MapsVerb& verb, const CommonOptions& common) {
  MapsOptions options;
  options.recipe = LoadMapRecipe(verb.recipe);
  Stack stack = OpenStack(verb.stack, verb.options);
  if (!options.recipe.normal_map.empty()) SetNormalMap(options.recipe.normal_map, verb.normal_y == "down", &stack);
  options.recipe.rules.schlick = stack.calibrated;
  options.folder = verb.out;
  options.name = ResultName(verb.name, StackName(verb.stack));
  options.threads = common.Threads();
  options.merge = verb.merge;
  options.normal_y = verb.normal_y == "up" ? NormalY::kUp : NormalY::kDown;
  options.left_out = ParseLights(verb.left_out, "--leave-out", stack.lights.size());
  if (stack.lights.size() - options.left_out.size() < 4) throw UsageError("--leave-out: fewer than 4 lights remain");
  if (!verb.rows.empty()) options.rows = ParseRows(verb.rows, stack.height);
  if (options.merge && options.rows) throw UsageError("--merge joins all rows; leave --rows out");
  MakeFolder(options.folder);
  for (const char* ending :
       {".maps.exr", ".maps.json", ".normal.png", ".diffuse.png", ".f0.png", ".alpha.png", ".normal_error.png"}) {
    CheckOutput(options.folder / (options.name + ending), Inputs(stack));
  }
  const MapsResult result = RunMaps(stack, options, common.command);
  if (!result.complete && options.merge) {
    Print(fmt::format("{}: rows {} are missing; `lobefit maps {} --rows {}` with the same options fits them\n",
                      PrintableName(JournalFolder(options)), RowList(result.missing), ShellWord(verb.stack),
                      RowList({result.missing[0]})),
          stderr);
    return kExitMissing;
  }
  if (common.json) {
    nlohmann::ordered_json json = {
        {"complete", result.complete}, {"texels_fitted", result.fitted_texels}, {"seconds", result.fit_seconds}};
    if (!result.written.empty()) {
      const FileBytes document(result.written[1]);
      json["document"] = nlohmann::ordered_json::parse(document.bytes());
    }
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return kExitDone;
  }
  Print(fmt::format("{}: {}, {} lights, {} x {}\n", PrintableName(verb.stack), stack.layout, stack.lights.size(),
                    stack.width, stack.height));
  for (const std::string& remark : stack.remarks) Print("  note         " + remark + "\n");
  if (result.written.empty()) {
    Print(fmt::format("  rows {} are done; `--merge` joins them", verb.rows));
    Print(result.missing.empty() ? "\n" : fmt::format(" when {} are done too\n", RowList(result.missing)));
    return kExitDone;
  }
  Print(Summary(result, options));
  for (const std::filesystem::path& path : result.written) Print("Wrote " + PrintableName(path) + "\n");
  return kExitDone;
}

}  // namespace

std::function<int()> SetUpMaps(CLI::App* app, CommonOptions* common) {
  auto verb = std::make_shared<MapsVerb>();
  app->add_option(
         "STACK", verb->stack,
         "a folder of DiLiGenT's layout, an RTI light file (.lp) or a RelightLab dome (.dome) beside its images, a "
         "folder of images named by angles (tl045 pl090 tv000 pv000.png), a MaterialGAN capture (.json), or a "
         "stack.toml (or its folder); images are PNG, JPEG, TIFF or OpenEXR")
      ->required();
  app->add_option("--recipe", verb->recipe, "what to fit: a recipe of fits/maps by name, or a file (default ggx-maps)");
  app->add_option("--out", verb->out, "folder of the results (default: here)");
  app->add_option("--name", verb->name, "NAME of the results (default: the stack's)");
  app->add_option("--encoding", verb->options.encoding, "how pixels are stored: linear, srgb, gamma:G");
  app->add_option("--leave-out", verb->left_out,
                  "lights that are not fitted, as 3,17 (the first is 1): for `report` to judge by");
  app->add_option("--rows", verb->rows,
                  "only rows A:B (A to B-1, from 0 at the top), into NAME.maps.part; --merge joins");
  app->add_flag("--merge", verb->merge,
                "join the rows that runs with --rows have fitted; says which are missing (exit 5)");
  app->add_option("--normal-y", verb->normal_y,
                  "y of NAME.normal.png, and of a recipe's normal = \"map:FILE\": up (OpenGL, glTF) or down (DirectX)")
      ->check(CLI::IsMember({"up", "down"}));
  return [=] { return RunMapsVerb(*verb, *common); };
}

}  // namespace lobefit

// What is chosen without a recipe on measurements of known models: for each kind of truth the share of trials whose
// choice is its own rung of the ladder or a richer one, that of simpler choices which predict as well, and that of
// simpler ones which predict worse. A table in Markdown.
//   bench_rungs TRIALS [KIND...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/automatic.h"
#include "lobefit/fit/ladder.h"
#include "lobefit/synthesis/random.h"
#include "lobefit/synthesis/synthesis.h"
#include "lobefit/validate/truth.h"

namespace lobefit {
namespace {

constexpr double kNoise = 0.02;
// Held-out errors differ by less where nothing is gained.
constexpr double kAsWell = 1.02;

struct Kind {
  const char* name;
  Model model;
};

std::vector<Kind> Kinds() {
  const Lobe round = {Ndf::kGgx};
  Lobe curve = round, retro = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kNone}, profile = {Ndf::kProfile};
  curve.fresnel = Fresnel::kCurve;
  retro.direction = LobeDirection::kRetro;
  profile.grid = GridWithKnots({0, 1, 2, 4});
  const Lobe coat = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered};
  return {{"ggx", {{round}, Diffuse::kLambert}},
          {"ggx-anisotropic", {{{Ndf::kGgxAnisotropic}}, Diffuse::kLambert}},
          {"ellipsoid", {{{Ndf::kEllipsoid}}, Diffuse::kLambert}},
          {"student", {{{Ndf::kStudent}}, Diffuse::kLambert}},
          {"profile", {{profile}, Diffuse::kLambert}},
          {"ggx+ggx", {{round, round}, Diffuse::kLambert}},
          {"ggx+curve", {{curve}, Diffuse::kLambert}},
          {"ggx+interfaced", {{round}, Diffuse::kInterfaced}},
          {"ggx+retro", {{round, retro}, Diffuse::kLambert}},
          {"ggx+coat", {{round, coat}, Diffuse::kLambert}}};
}

// A truth of the kind, with values to draw from.
Truth LikeOf(const Model& model) {
  Truth like = {model, {}, {"R"}};
  for (const Parameter& parameter : Parameters(model)) {
    const bool alpha = parameter.name.ends_with("alpha_x") || parameter.name.ends_with("alpha_y");
    like.values.push_back({alpha ? 0.2 : parameter.start});
  }
  return like;
}

std::size_t FreeParameters(const Model& model) {
  const std::vector<Parameter> parameters = Parameters(model);
  return static_cast<std::size_t>(
      std::count_if(parameters.begin(), parameters.end(), [](const Parameter& p) { return p.free; }));
}

GoniometerLayout Directions() {
  GoniometerLayout layout;
  for (const double degrees : {5., 20., 35., 50., 60., 70.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : {0., 70.}) layout.azimuths.push_back(DegreesToRadians(degrees));
  layout.detector_step = DegreesToRadians(12);
  return layout;
}

struct Outcome {
  std::string name;
  bool richer = false, as_well = false;
};

Outcome RunTrial(const Kind& kind, std::uint64_t seed) {
  RandomNumbers random(StreamSeed(seed, 1));
  MaterialRange range;
  range.alpha_low = 0.08;
  range.alpha_high = 0.5;
  const Truth truth = DrawMaterial(range, LikeOf(kind.model), &random);
  Measurement measurement =
      Synthesise(Goniometer(Directions()), {truth.channels, {}}, BrdfOf(truth), {kNoise, 0}, StreamSeed(seed, 2));
  FitOptions options;
  options.threads = 1;
  const LadderChoice choice = ClimbLadder(AutomaticRecipe(TraitsOf(measurement)), options, &measurement);
  Outcome outcome;
  double least = HUGE_VAL, chosen = HUGE_VAL;
  for (const TriedModel& model : choice.tried) {
    least = std::min(least, model.held_out);
    if (!model.chosen) continue;
    chosen = model.held_out;
    outcome.name = model.name;
    outcome.richer = model.free_parameters >= FreeParameters(kind.model);
  }
  outcome.as_well = chosen <= kAsWell * least;
  return outcome;
}

int Run(int argc, char** argv) {
  const std::vector<std::string> wanted(argv + 2, argv + argc);
  const auto trials = static_cast<std::size_t>(std::atoi(argv[1]));
  fmt::print(
      "| truth | trials | own rung or richer, % | simpler, as good, % | simpler, worse, % | chosen most often |\n");
  fmt::print("|---|---|---|---|---|---|\n");
  for (const Kind& kind : Kinds()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), kind.name) == wanted.end()) continue;
    std::vector<Outcome> outcomes(trials);
    ParallelFor(trials, 2, [&](std::size_t k) { outcomes[k] = RunTrial(kind, k); });
    std::map<std::string, int> names;
    double richer = 0, as_well = 0;
    for (const Outcome& outcome : outcomes) {
      ++names[outcome.name];
      richer += outcome.richer;
      as_well += !outcome.richer && outcome.as_well;
    }
    std::vector<std::pair<int, std::string>> most;
    for (const auto& [name, count] : names) most.emplace_back(-count, name);
    std::sort(most.begin(), most.end());
    std::string text;
    for (std::size_t k = 0; k < std::min<std::size_t>(3, most.size()); ++k)
      text += fmt::format("{}{} {}", k > 0 ? ", " : "", most[k].second, -most[k].first);
    const double percent = 100.0 / static_cast<double>(trials);
    fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.1f} | {} |\n", kind.name, trials, percent * richer, percent * as_well,
               percent * (static_cast<double>(trials) - richer - as_well), text);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  if (argc < 2 || std::atoi(argv[1]) < 1) {
    std::fputs("usage: bench_rungs TRIALS [KIND...]\n", stderr);
    return 2;
  }
  return lobefit::Run(argc, argv);
}

// Fits of each MERL table: the error under every metric, and whether the default fit finds the best minimum, its cost
// against the best of many random starts, in one table in Markdown.
//   bench_starts RECIPE.toml METRIC WEIGHTING RANDOM_STARTS FILE.binary...
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/fit/search/starts.h"
#include "lobefit/io/read.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {
namespace {

// Random starts descend on a subsample twice that of the fit; the best distinct ends go on on ten times as many, and
// the best of those on all samples.
constexpr std::size_t kSubsample = 4000, kMiddle = 40000, kToMiddle = 8, kFinished = 3;

// The best `most`, each of another cost.
std::vector<Solution> Distinct(std::vector<Solution> ends, std::size_t most) {
  std::sort(ends.begin(), ends.end(), [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
  std::vector<Solution> distinct;
  for (const Solution& end : ends) {
    if (distinct.size() < most && (distinct.empty() || end.cost - distinct.back().cost > 1e-5 * end.cost))
      distinct.push_back(end);
  }
  return distinct;
}

// Best cost on all samples from random shapes, f0 and albedos.
double BestOfRandom(const Recipe& recipe, const Measurement& measurement, int count, ThreadPool* pool) {
  const Layout layout(recipe, measurement.channels.names);
  const Samples subsample = measurement.samples.Subset(StratifiedSubsample(measurement.samples.size(), kSubsample, 7));
  const Problem small(subsample, recipe), all(measurement.samples, recipe);
  std::vector<Solution> ends(static_cast<std::size_t>(count));
  pool->Run(ends.size(), [&](std::size_t k) {
    std::mt19937_64 random(1000 + k);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Ellipsoid> shapes;
    for (std::size_t l = 0; l < recipe.model.lobes.size(); ++l) {
      const double alpha = 0.004 * std::pow(200, unit(random));
      shapes.push_back({alpha, alpha, 0, 0, 0});
    }
    std::vector<double> u = layout.FromShapes(shapes);
    for (std::size_t i = layout.shape_size(); i < u.size(); ++i) u[i] = std::pow(unit(random), 2);
    ThreadPool alone(1);
    ends[k] = Solve(small, layout, u, {}, &alone);
  });
  const Samples middle = measurement.samples.Subset(StratifiedSubsample(measurement.samples.size(), kMiddle, 8));
  const Problem medium(middle, recipe);
  ends = Distinct(ends, kToMiddle);
  pool->Run(ends.size(), [&](std::size_t k) {
    ThreadPool alone(1);
    ends[k] = Solve(medium, layout, ends[k].u, {}, &alone);
  });
  double best = HUGE_VAL;
  for (const Solution& end : Distinct(ends, kFinished)) best = std::min(best, Solve(all, layout, end.u, {}, pool).cost);
  return best;
}

void Run(const Recipe& recipe, int count, const std::vector<std::string>& files) {
  ThreadPool pool(HardwareThreads());
  int reached = 0;
  std::string metrics, rule;
  for (const Choice<Metric>& metric : MetricChoices()) {
    metrics += fmt::format(" `{}` |", metric.name);
    rule += "---|";
  }
  fmt::print("| material |{} seconds | cost / best of {} random starts |\n|---|{}---|---|\n", metrics, count, rule);
  for (const std::string& file : files) {
    Measurement measurement = ReadMeasurement(file, {});
    FitOptions options;
    options.threads = HardwareThreads();
    const auto start = std::chrono::steady_clock::now();
    const Material material = Fit(recipe, options, &measurement);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double best = BestOfRandom(recipe, measurement, count, &pool), ratio = material.cost / best;
    reached += ratio <= 1.001 ? 1 : 0;
    std::string errors;
    for (const MetricError& error : material.errors) errors += fmt::format(" {:.3g} |", error.rms);
    fmt::print("| {} |{} {:.2f} | {:.5f} |\n", std::filesystem::path(file).stem().string(), errors, seconds, ratio);
    std::fflush(stdout);
  }
  fmt::print("\n{} of {} within 0.1 %\n", reached, files.size());
}

int Main(int argc, char** argv) {
  const Choice<Metric>* metric = argc > 5 ? Find(MetricChoices(), argv[2]) : nullptr;
  const Choice<Weighting>* weighting = argc > 5 ? Find(WeightingChoices(), argv[3]) : nullptr;
  if (metric == nullptr || weighting == nullptr) {
    std::fprintf(stderr, "usage: bench_starts RECIPE.toml METRIC WEIGHTING RANDOM_STARTS FILE.binary...\n");
    return 2;
  }
  Recipe recipe = ReadRecipe(argv[1]);
  recipe.metric = metric->value;
  recipe.weighting = weighting->value;
  Run(recipe, std::atoi(argv[4]), {argv + 5, argv + argc});
  return 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) { return lobefit::Main(argc, argv); }

#include "lobefit/fit/search/search.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lobefit/fit/search/starts.h"

namespace lobefit {
namespace {

constexpr std::size_t kScoutsKept = 3;
// Samples of the second level. Its minima lie so close to those of a full table that few steps are left to do there.
constexpr std::size_t kMiddle = 40000;
// With more coordinates dense steps take longer than passes.
constexpr std::size_t kMostDense = 200;
// Passes by a stand-in, and steps.
constexpr int kMostPasses = 20, kMostSteps = 100;
// Minima that go on to the next level: at most so many, and no worse than the best by this factor in cost.
constexpr std::size_t kToMiddle = 6, kToAll = 2;
constexpr double kWorse = 1.5, kWorseMiddle = 1.05;
// Relative decrease of the cost at which a descent ends. With 3 million residuals 1e-8 is a hundredth of the variance
// of one. Lobes that may tilt have a kink at every sample where masking begins; beyond this they creep: 100 steps for
// another 1e-8 on a full table of an acrylic.
constexpr double kMiddleTolerance = 1e-7, kTolerance = 1e-8;
// The best scouts' steps on a subsample before more samples tell them apart.
constexpr int kStepsOfKept = 100;
// Of a model that is only compared with others (FitOptions::trial), on each level.
constexpr SolveOptions kTrial = {.max_iterations = 100, .function_tolerance = 1e-6};
// Descents of a model with several lobes, for each one of a model with one: two lobes have 36 pairs of start widths.
constexpr std::size_t kDescentsOfSeveral = 5;

// Descends from the best-ranked starts, to their minima if these are the `last` samples.
std::vector<DistinctMinimum> Descend(const Problem& problem, const Layout& layout, const Samples& samples,
                                     const FitOptions& options, bool last, ThreadPool* pool) {
  const std::size_t descents = options.starts * (layout.recipe().model.lobes.size() > 1 ? kDescentsOfSeveral : 1);
  std::vector<Start> starts = RankedStarts(problem, layout, samples, descents, pool);
  if (starts.size() > descents) starts.resize(descents);
  std::vector<DistinctMinimum> minima(starts.size());
  const auto descend = [&](std::size_t k, const std::vector<double>& u, const SolveOptions& solve) {
    ThreadPool alone(1);
    minima[k] = {Solve(problem, layout, u, solve, &alone), 1, problem.size()};
  };
  SolveOptions finish;
  if (options.trial) finish = kTrial;
  SolveOptions scouting = finish;
  scouting.max_iterations = options.scouting_steps;
  // What is gone on with on more samples need not be at its minimum on these.
  const bool scout = options.scouting_steps > 0 && (!last || starts.size() > kScoutsKept);
  pool->Run(starts.size(), [&](std::size_t k) { descend(k, starts[k].u, scout ? scouting : finish); });
  if (scout && starts.size() > 1) {
    JoinFoundAgain(problem, layout, pool, &minima);
    if (minima.size() > kScoutsKept) minima.resize(kScoutsKept);
    if (!last) finish.max_iterations = std::min(finish.max_iterations, kStepsOfKept);
    pool->Run(minima.size(), [&](std::size_t k) { descend(k, minima[k].solution.u, finish); });
  }
  JoinFoundAgain(problem, layout, pool, &minima);
  // Lobes that may tilt have kinks, where descents creep without an end: the white paper's of 79 coordinates did.
  if (last && !options.trial && layout.size() < kMostDense && !minima.empty() && !minima[0].solution.converged) {
    SolveOptions along = {.use_ceres = false, .arrow_from = kMostDense, .along_kinks = true};
    Solution solution = Solve(problem, layout, minima[0].solution.u, along, pool);
    solution.iterations += minima[0].solution.iterations;
    minima[0].solution = std::move(solution);
  }
  return minima;
}

// A level of more samples.
struct Level {
  std::size_t most;               // minima that go on
  double worse;                   // and how much worse than the best they may be, as a factor of the cost
  double tolerance;               // SolveOptions::function_tolerance, unless this is a trial
  const Problem* part = nullptr;  // the level before, where it can stand in for this one
};

// Goes on with the best minima on the samples of `problem`, in place; the costs of the others are scaled to it.
void Refine(const Problem& problem, const Layout& layout, const Level& level, bool trial, ThreadPool* pool,
            std::vector<DistinctMinimum>* minima) {
  if (minima->empty()) return;
  SolveOptions finish;
  finish.function_tolerance = trial ? kTrial.function_tolerance : level.tolerance;
  const double limit = level.worse * minima->front().solution.cost;
  std::size_t refined = 0;
  for (DistinctMinimum& minimum : *minima) {
    if (refined < level.most && (refined == 0 || minimum.solution.cost <= limit)) {
      // Bounds hold some coordinates: plain steps are minima within the box, where those of Ceres end at it and are
      // tried again. Where many are needed after all and passes are dear, the secants of Ceres take a half to a third
      // of them: 24 for 71 and 48 for 81 of models with 59 and 70 coordinates.
      finish.arrow_from = kMostDense;
      const auto go_on = [&](bool use_ceres, int most_steps) {
        finish.use_ceres = use_ceres;
        finish.max_iterations = most_steps;
        const int so_far = minimum.solution.iterations;
        minimum.solution = Solve(problem, layout, minimum.solution.u, finish, pool);
        minimum.solution.iterations += so_far;
      };
      if (level.part != nullptr && layout.size() < kMostDense) {
        finish.max_iterations = kMostPasses;
        const int so_far = minimum.solution.iterations;
        minimum.solution = SolveByStandIn(problem, *level.part, layout, minimum.solution.u, finish, pool);
        minimum.solution.iterations += so_far;
      } else {
        go_on(false, trial ? kTrial.max_iterations : kMostSteps);
      }
      if (!minimum.solution.converged && !trial) go_on(true, kMostSteps);
      if (!minimum.solution.converged && level.part != nullptr) go_on(false, kMostSteps);
      minimum.samples = problem.size();
      minimum.on_all_samples = true;
      ++refined;
    } else {
      minimum.solution.cost *= static_cast<double>(problem.size()) / static_cast<double>(minimum.samples);
      minimum.samples = problem.size();
      minimum.on_all_samples = false;
    }
  }
  // Costs of different subsamples compare roughly only: those that were refined come first.
  std::vector<DistinctMinimum> first(minima->begin(), minima->begin() + static_cast<std::ptrdiff_t>(refined)),
      rest(minima->begin() + static_cast<std::ptrdiff_t>(refined), minima->end());
  JoinFoundAgain(problem, layout, pool, &first);
  first.insert(first.end(), rest.begin(), rest.end());
  *minima = first;
}

}  // namespace

std::vector<DistinctMinimum> FindMinima(const Problem& problem, const Layout& layout, const Samples& samples,
                                        const FitOptions& options, ThreadPool* pool) {
  if (samples.size() <= 3 * options.subsample) return Descend(problem, layout, samples, options, true, pool);
  const Recipe& recipe = layout.recipe();
  const Samples small = samples.Subset(StratifiedSubsample(samples.size(), options.subsample, options.seed));
  std::vector<DistinctMinimum> minima = Descend(Problem(small, recipe), layout, small, options, false, pool);
  Samples middle;  // outlives its problem
  std::optional<Problem> part;
  if (samples.size() > 3 * kMiddle) {
    middle = samples.Subset(StratifiedSubsample(samples.size(), kMiddle, options.seed + 1));
    part.emplace(middle, recipe);
    Refine(*part, layout, {kToMiddle, kWorse, kMiddleTolerance}, options.trial, pool, &minima);
  }
  Refine(problem, layout, {kToAll, kWorseMiddle, kTolerance, part ? &*part : nullptr}, options.trial, pool, &minima);
  return minima;
}

void DescendReweighted(const Layout& layout, ThreadPool* pool, Problem* problem, std::vector<DistinctMinimum>* minima) {
  if (!problem->depends_on_model() || minima->empty()) return;
  constexpr int kMostRounds = 20;
  SolveOptions options;
  options.function_tolerance = kTolerance;
  const auto descend = [&](Solution* solution) {
    const int before = solution->iterations;
    const double cost = problem->Sum(layout.ToKernel(solution->u.data()), false, pool).sum_rho / 2;
    *solution = Solve(*problem, layout, solution->u, options, pool);
    solution->iterations += before;
    return cost - solution->cost > kTolerance * cost;
  };
  for (int round = 0; round < kMostRounds; ++round) {
    problem->Reweigh(layout.ToKernel(minima->front().solution.u.data()), pool);
    if (!descend(&minima->front().solution)) break;
  }
  std::vector<DistinctMinimum> refined, rest;
  for (std::size_t k = 0; k < minima->size(); ++k) {
    DistinctMinimum& minimum = (*minima)[k];
    if (k > 0 && minimum.on_all_samples) descend(&minimum.solution);
    (minimum.on_all_samples ? refined : rest).push_back(minimum);
  }
  JoinFoundAgain(*problem, layout, pool, &refined);
  refined.insert(refined.end(), rest.begin(), rest.end());
  *minima = refined;
}

}  // namespace lobefit

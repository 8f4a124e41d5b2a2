#include "lobefit/fit/search/search.h"

#include <algorithm>
#include <cmath>

#include "lobefit/fit/search/starts.h"

namespace lobefit {
namespace {

constexpr std::size_t kScoutsKept = 3;
// Samples of the second level. Its minima lie so close to those of a full table that few steps are left to do there.
constexpr std::size_t kMiddle = 40000;
// Samples from which on a pass takes longer than the steps' own arithmetic, up to so many coordinates.
constexpr std::size_t kDear = 3 * kMiddle, kMostDense = 200;
constexpr int kFewSteps = 8, kMostSteps = 100;
// Minima that go on to the next level: at most so many, and no worse than the best by this factor in cost.
constexpr std::size_t kToMiddle = 6, kToAll = 2;
constexpr double kWorse = 1.5, kWorseMiddle = 1.05;
// Relative decrease of the cost at which a descent ends. With 3 million residuals 1e-8 is a hundredth of the variance
// of one. Lobes that may tilt have a kink at every sample where masking begins; beyond this they creep: 100 steps for
// another 1e-8 on a full table of an acrylic.
constexpr double kMiddleTolerance = 1e-7, kTolerance = 1e-8;
// Descents of a model with several lobes, for each one of a model with one: two lobes have 36 pairs of start widths.
constexpr std::size_t kDescentsOfSeveral = 5;

// Descends from the best-ranked starts.
std::vector<DistinctMinimum> Descend(const Problem& problem, const Layout& layout, const Samples& samples,
                                     const FitOptions& options, ThreadPool* pool) {
  std::vector<Start> starts = RankedStarts(problem, layout, samples, pool);
  const std::size_t descents = options.starts * (layout.recipe().model.lobes.size() > 1 ? kDescentsOfSeveral : 1);
  if (starts.size() > descents) starts.resize(descents);
  std::vector<DistinctMinimum> minima(starts.size());
  const auto descend = [&](std::size_t k, const std::vector<double>& u, const SolveOptions& solve) {
    ThreadPool alone(1);
    minima[k] = {Solve(problem, layout, u, solve, &alone), 1, problem.size()};
  };
  SolveOptions scouting;
  scouting.max_iterations = options.scouting_steps;
  const bool scout = options.scouting_steps > 0 && starts.size() > kScoutsKept;
  pool->Run(starts.size(), [&](std::size_t k) { descend(k, starts[k].u, scout ? scouting : SolveOptions()); });
  if (scout) {
    JoinFoundAgain(problem, layout, pool, &minima);
    if (minima.size() > kScoutsKept) minima.resize(kScoutsKept);
    pool->Run(minima.size(), [&](std::size_t k) { descend(k, minima[k].solution.u, {}); });
  }
  JoinFoundAgain(problem, layout, pool, &minima);
  return minima;
}

// Goes on with the best minima on the samples of `problem`, in place; the costs of the others are scaled to it.
void Refine(const Problem& problem, const Layout& layout, std::size_t most, double worse, double tolerance,
            ThreadPool* pool, std::vector<DistinctMinimum>* minima) {
  if (minima->empty()) return;
  SolveOptions finish;
  finish.function_tolerance = tolerance;
  const double limit = worse * minima->front().solution.cost;
  std::size_t refined = 0;
  for (DistinctMinimum& minimum : *minima) {
    if (refined < most && (refined == 0 || minimum.solution.cost <= limit)) {
      // Few steps are left, and bounds hold some coordinates: plain steps are minima within the box, where those of
      // Ceres end at it and are tried again. Where many are needed after all and passes are dear, the secants of Ceres
      // take a half to a third of them: 24 for 71 and 48 for 81 of models with 59 and 70 coordinates.
      const bool dear = problem.size() > kDear;
      finish.arrow_from = kMostDense;
      const auto go_on = [&](bool use_ceres, int most_steps) {
        finish.use_ceres = use_ceres;
        finish.max_iterations = most_steps;
        const int so_far = minimum.solution.iterations;
        minimum.solution = Solve(problem, layout, minimum.solution.u, finish, pool);
        minimum.solution.iterations += so_far;
      };
      go_on(false, dear ? kFewSteps : kMostSteps);
      if (!minimum.solution.converged) go_on(true, kMostSteps);
      if (!minimum.solution.converged && dear) go_on(false, kMostSteps);
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
  if (samples.size() <= 3 * options.subsample) return Descend(problem, layout, samples, options, pool);
  const Recipe& recipe = layout.recipe();
  const Samples small = samples.Subset(StratifiedSubsample(samples.size(), options.subsample, options.seed));
  std::vector<DistinctMinimum> minima = Descend(Problem(small, recipe), layout, small, options, pool);
  if (samples.size() > 3 * kMiddle) {
    const Samples middle = samples.Subset(StratifiedSubsample(samples.size(), kMiddle, options.seed + 1));
    Refine(Problem(middle, recipe), layout, kToMiddle, kWorse, kMiddleTolerance, pool, &minima);
  }
  Refine(problem, layout, kToAll, kWorseMiddle, kTolerance, pool, &minima);
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

#include "lobefit/fit/keep_energy.h"

#include "lobefit/base/error.h"
#include "lobefit/fit/inference/energy_balance.h"
#include "lobefit/fit/search/solve.h"

namespace lobefit {
namespace {

// The margin is for what the sums over points miss, and what a penalty leaves.
constexpr double kLimit = 0.998;
constexpr int kRounds = 6, kStepsARound = 40;

}  // namespace

std::unique_ptr<EnergyRule> KeepEnergy(const Recipe& recipe, const Layout& layout, const Incidences& incidences,
                                       const std::vector<std::string>& channels, Problem* problem,
                                       std::vector<DistinctMinimum>* minima, ThreadPool* pool) {
  if (recipe.energy != EnergyChoice::kConserving || minima->empty()) return nullptr;
  if (recipe.instrument.drift || recipe.instrument.alignment || recipe.instrument.offset) {
    throw InputError("recipe '" + recipe.name +
                     "': energy 'conserving' does not go with drift, alignment or offset, which are fitted apart from "
                     "the surface; leave one of them out");
  }
  for (const Lobe& lobe : recipe.model.lobes) {
    if (FamilyOf(lobe.ndf) != Family::kAbg) continue;
    throw InputError("recipe '" + recipe.name +
                     "': energy 'conserving' does not go with ndf abg, most of whose light may lie far from its peak; "
                     "its total integrated scatter is in the result");
  }
  const std::vector<Vec3> wi = SpreadIncidences(incidences, recipe.theta_max);
  Solution& solution = minima->front().solution;
  const auto keeps = [&] {
    return BalanceAt(wi, recipe.model, layout.Report(solution.u.data()), channels, pool, {}).albedo <= 1;
  };
  if (keeps()) return nullptr;
  minima->resize(1);
  // From amplitudes that keep energy: a step of the penalty from far above may end where they are 0, whose cost is
  // flat.
  const double above = BalanceAt(wi, recipe.model, layout.Report(solution.u.data()), channels, pool).albedo;
  for (std::size_t i = layout.shape_size(); i < layout.size(); ++i) {
    if (layout.coordinates()[i].low == 0) solution.u[i] /= above;
  }
  auto rule = std::make_unique<EnergyRule>(wi, kLimit);
  problem->AttachEnergy(rule.get());
  // An excess of 0.01 costs as much as all residuals.
  double weight = 2 * solution.cost / (0.01 * 0.01);
  SolveOptions options;
  options.function_tolerance = 1e-7;
  options.max_iterations = kStepsARound;
  options.use_ceres = false;
  bool kept = false;
  for (int round = 0; round < kRounds && !kept; ++round, weight *= 10) {
    const int before = solution.iterations;
    rule->SetWeight(weight);
    rule->Place(layout.ToKernel(solution.u.data()));
    solution = Solve(*problem, layout, solution.u, options, pool);
    solution.iterations += before;
    kept = keeps();
  }
  solution.cost = problem->Sum(layout.ToKernel(solution.u.data()), false, pool).sum_rho / 2;
  if (!kept) {
    solution.converged = false;
    solution.message = "the albedo could not be kept at or below 1";
  }
  return rule;
}

}  // namespace lobefit

#include "lobefit/fit/last_descent.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/QR>

#include "lobefit/fit/search/solve.h"

namespace lobefit {
namespace {

bool HasLastDescent(const InstrumentRecipe& instrument) {
  return instrument.drift || instrument.alignment || instrument.offset || instrument.source_prior ||
         instrument.detector_prior || instrument.detector_across;
}

// A point of the search in the coordinates of the last descent: its angles stand between shapes and the rest, its
// offsets behind.
std::vector<double> Extended(const std::vector<double>& u, const Layout& from, const Layout& to) {
  std::vector<double> extended(to.size(), 0.0);
  const auto middle = static_cast<std::ptrdiff_t>(from.shape_size());
  std::copy(u.begin(), u.begin() + middle, extended.begin());
  std::copy(u.begin() + middle, u.end(), extended.begin() + static_cast<std::ptrdiff_t>(to.shape_size()));
  return extended;
}

// Variance of the residuals where they tell of a gain, the mean of r^2 weighted by its column squared: under a metric
// that does not level the noise, the mean of all would be that of the dark samples, which tell nothing.
double GainVariance(const Problem& problem, const Layout& layout, const std::vector<double>& u, ThreadPool* pool) {
  const GainSums sums = problem.SumGains(layout.ToKernel(u.data()), pool);
  const double curvature = std::accumulate(sums.curvature.begin(), sums.curvature.end(), 0.0);
  return std::max(sums.weighted_squares, 1e-300) / std::max(curvature, 1e-300);
}

// That and, for drift to be estimated, the mean square of the gains' logarithms with their own uncertainty.
struct Variances {
  double residual, gain;
};
Variances EstimateVariances(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                            ThreadPool* pool) {
  const Gains& gains = *problem.gains();
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  std::vector<GainLink> links;
  Linearise(problem, layout, u.data(), pool, &hessian, &gradient, &links);
  // A gain takes a degree of freedom as far as the data, not the prior, determine it.
  double taken = static_cast<double>(layout.size());
  for (const GainLink& link : links) taken += 1 - gains.precision() / link.curvature;
  const double residuals = static_cast<double>(problem.size() * problem.channels());
  Variances variances;
  variances.residual = GainVariance(problem, layout, u, pool) * residuals / std::max(1.0, residuals - taken);
  const Eigen::MatrixXd inverse = hessian.completeOrthogonalDecomposition().pseudoInverse();
  double sum = 0;
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double d = links[k].curvature, logarithm = gains.logarithms()[k];
    sum += logarithm * logarithm + variances.residual * (1 / d + links[k].link.dot(inverse * links[k].link) / (d * d));
  }
  variances.gain = sum / static_cast<double>(links.size());
  return variances;
}

// Descends with gains, whose precision follows the variances. Returns the standard deviation of the gains.
double DescendWithGains(const DriftRecipe& drift, const Problem& problem, const Layout& layout, Solution* solution,
                        ThreadPool* pool) {
  constexpr int kSteps = 8;
  constexpr double kFirst = 0.05, kSettled = 0.01;
  Gains* gains = problem.gains();
  double sd = drift.sd.value_or(kFirst);
  double variance = GainVariance(problem, layout, solution->u, pool);
  for (int step = 0; step < kSteps; ++step) {
    gains->SetPrior(variance, sd);
    const int before = solution->iterations;
    *solution = Solve(problem, layout, solution->u, {}, pool);
    solution->iterations += before;
    const Variances now = EstimateVariances(problem, layout, solution->u, pool);
    const double next = drift.sd.value_or(std::sqrt(now.gain));
    const bool settled = std::fabs(now.residual / variance - 1) < kSettled && std::fabs(next / sd - 1) < kSettled;
    variance = now.residual;
    sd = next;
    if (settled) break;
  }
  return sd;
}

}  // namespace

Recipe WithoutLastDescent(const Recipe& recipe) {
  Recipe plain = recipe;
  plain.instrument.drift.reset();
  plain.instrument.alignment.reset();
  plain.instrument.offset = false;
  plain.instrument.source_prior.reset();
  plain.instrument.detector_prior.reset();
  if (plain.instrument.detector_across) {
    // A mean over a rectangle takes as long as a hundred over a disc: of the same solid angle.
    plain.instrument.detector = std::sqrt(4 / kPi * *plain.instrument.detector * *plain.instrument.detector_across);
    plain.instrument.detector_across.reset();
  }
  return plain;
}

LastDescent DescendLast(const Recipe& recipe, const std::vector<std::string>& channels, const Incidences& incidences,
                        Layout* layout, Problem* problem, std::vector<DistinctMinimum>* minima, ThreadPool* pool) {
  LastDescent last;
  if (!HasLastDescent(recipe.instrument) || minima->empty()) return last;
  Recipe whole = recipe;
  whole.instrument.finest_width = layout->recipe().instrument.finest_width;
  const Layout before = *layout;
  *layout = Layout(whole, channels);
  if (recipe.instrument.drift) {
    last.gains = std::make_unique<Gains>(incidences);
    problem->AttachGains(last.gains.get());
  }
  std::erase_if(*minima, [](const DistinctMinimum& minimum) { return !minimum.on_all_samples; });
  for (std::size_t k = 0; k < minima->size(); ++k) {
    Solution& solution = (*minima)[k].solution;
    solution.u = Extended(solution.u, before, *layout);
    if (k == 0 && recipe.instrument.drift) {
      last.drift = DescendWithGains(*recipe.instrument.drift, *problem, *layout, &solution, pool);
    } else {
      const int iterations = solution.iterations;
      solution = Solve(*problem, *layout, solution.u, {}, pool);
      solution.iterations += iterations;
    }
  }
  std::stable_sort(minima->begin(), minima->end(), [](const DistinctMinimum& a, const DistinctMinimum& b) {
    return a.solution.cost < b.solution.cost;
  });
  if (last.gains != nullptr) last.gains->Profile(*problem, layout->ToKernel(minima->front().solution.u.data()), pool);
  return last;
}

}  // namespace lobefit

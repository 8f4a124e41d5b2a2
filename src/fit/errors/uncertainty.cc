#include "lobefit/fit/errors/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/fit/errors/bread.h"
#include "lobefit/fit/errors/clusters.h"
#include "lobefit/fit/errors/entries.h"
#include "lobefit/fit/errors/sandwich.h"
#include "lobefit/fit/objective/gains.h"

namespace lobefit {
namespace {

// The scatter of K gains is known from them, with K - 1 degrees of freedom; a number whose variance comes from it to a
// share has no more than the combination of both [Satterthwaite 1946]. Of f0 over 6 incidences under a drift of 2 %
// intervals held 90 % without this.
double FreedomUnderDrift(double freedom, const Gains& gains, double share) {
  return 1 / (1 / freedom + share * share / (static_cast<double>(gains.size()) - 1));
}

}  // namespace

Uncertainty EstimateUncertainty(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, ThreadPool* pool, std::size_t most_full) {
  Uncertainty result;
  const Bread bread = FactorBread(problem, layout, u, pool, most_full);
  result.at_bound = bread.at_bound;
  result.degenerate = bread.degenerate;
  result.has_clusters = incidences.wi.size() >= 2;

  const ReportedEntries entries = EntriesOf(layout, u, bread);
  result.undetermined = entries.undetermined;
  const SparseColumns numbers = UnitColumns(entries.rows);
  const Filling filling = FillSandwich(problem, layout, u, bread, incidences, numbers, pool);
  result.covariance = EntryCovariance(entries, filling.samples, bread.form.full);
  if (result.has_clusters) result.clustered = EntryCovariance(entries, filling.clusters, bread.form.full);
  result.coordinate_variance.resize(bread.whitening.rows());
  for (Eigen::Index k = 0; k < bread.whitening.rows(); ++k)
    result.coordinate_variance(k) = filling.samples.Quadratic(bread.whitening.row(k).transpose());
  result.gain_variance.resize(static_cast<Eigen::Index>(bread.lean.size()));
  for (std::size_t k = 0; k < bread.lean.size(); ++k)
    result.gain_variance(static_cast<Eigen::Index>(k)) = bread.lean[k].dot(filling.samples.Times(bread.lean[k]).col(0));
  const bool scatter_estimated = problem.gains() != nullptr && !layout.recipe().instrument.drift->sd;
  for (Eigen::Index row = 0; row < entries.rows.rows(); ++row) {
    result.freedom.push_back(result.has_clusters ? filling.clusters_freedom(row) : kNan);
    result.independent_freedom.push_back(filling.samples_freedom(row));
    if (!scatter_estimated) continue;
    // With gains all coordinates are the border's.
    const Eigen::VectorXd entry = entries.rows.row(row).transpose();
    const double variance = entry.dot(filling.samples.Times(entry).col(0));
    if (!(variance > 0)) continue;
    const double of_gains = entry.dot(bread.prior_of_gains * entry);
    for (double* freedom : {&result.freedom.back(), &result.independent_freedom.back()})
      *freedom = FreedomUnderDrift(*freedom, *problem.gains(), std::min(1.0, of_gains / variance));
  }
  return result;
}

}  // namespace lobefit

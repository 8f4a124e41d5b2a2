#include "lobefit/fit/errors/uncertainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SparseCore>

#include "lobefit/fit/errors/bread.h"
#include "lobefit/fit/errors/clusters.h"
#include "lobefit/fit/errors/sandwich.h"
#include "lobefit/fit/objective/gains.h"

namespace lobefit {
namespace {

// Rows of many channels depend on the shape and their own channel only: dense products took half of the time of a fit
// with 800 of them.
Eigen::SparseMatrix<double, Eigen::RowMajor> SparseOf(const Eigen::MatrixXd& rows) { return rows.sparseView(); }

// rows middle rows^T.
Eigen::MatrixXd Spread(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& middle) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> sparse = SparseOf(rows);
  const Eigen::MatrixXd half = sparse * middle;
  return sparse * half.transpose();
}

bool IsFinite(const Eigen::MatrixXd& jacobian, Eigen::Index row) { return jacobian.row(row).allFinite(); }

// The scatter of K gains is known from them, with K - 1 degrees of freedom; a number whose variance comes from it to a
// share has no more than the combination of both [Satterthwaite 1946]. Of f0 over 6 incidences under a drift of 2 %
// intervals held 90 % without this.
double FreedomUnderDrift(double freedom, const Gains& gains, double share) {
  return 1 / (1 / freedom + share * share / (static_cast<double>(gains.size()) - 1));
}

}  // namespace

Uncertainty EstimateUncertainty(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, ThreadPool* pool) {
  Uncertainty result;
  const Bread bread = FactorBread(problem, layout, u, pool);
  result.at_bound = bread.at_bound;
  result.degenerate = bread.degenerate;
  result.has_clusters = incidences.wi.size() >= 2;

  const Eigen::MatrixXd jacobian = layout.ReportJacobian(u.data());
  std::vector<Eigen::Index> without_error;
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    bool undetermined = false;
    for (std::size_t k = 0; k < layout.size(); ++k)
      undetermined = undetermined || (bread.undetermined[k] && jacobian(row, static_cast<Eigen::Index>(k)) != 0);
    result.undetermined.push_back(undetermined);
    if (undetermined || !IsFinite(jacobian, row)) without_error.push_back(row);
  }
  // Entry by entry, d entry / d whitened coordinate.
  Eigen::MatrixXd entries = jacobian;
  for (const Eigen::Index row : without_error) entries.row(row).setZero();
  entries = (SparseOf(entries) * bread.whitening).eval();
  const Filling filling = FillSandwich(problem, layout, u, bread, incidences, UnitColumns(entries), pool);
  const auto spread = [&](const Eigen::MatrixXd& middle) {
    Eigen::MatrixXd covariance = Spread(entries, middle);
    for (const Eigen::Index row : without_error) {
      covariance.row(row).setConstant(kNan);
      covariance.col(row).setConstant(kNan);
    }
    return covariance;
  };
  result.of_coordinates = Spread(bread.whitening, filling.samples);
  result.covariance = spread(filling.samples);
  if (result.has_clusters) {
    result.clustered = spread(filling.clusters);
  } else {
    result.clustered.setZero(jacobian.rows(), jacobian.rows());
  }
  const bool scatter_estimated = problem.gains() != nullptr && !layout.recipe().instrument.drift->sd;
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    result.freedom.push_back(result.has_clusters ? filling.clusters_freedom(row) : kNan);
    result.independent_freedom.push_back(filling.samples_freedom(row));
    if (!scatter_estimated) continue;
    const double variance = entries.row(row) * filling.samples * entries.row(row).transpose();
    if (!(variance > 0)) continue;
    const double of_gains = entries.row(row) * bread.prior_of_gains * entries.row(row).transpose();
    for (double* freedom : {&result.freedom.back(), &result.independent_freedom.back()})
      *freedom = FreedomUnderDrift(*freedom, *problem.gains(), std::min(1.0, of_gains / variance));
  }
  return result;
}

}  // namespace lobefit

#include "lobefit/fit/objective/gains.h"

#include <algorithm>
#include <cmath>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"

namespace lobefit {

Gains::Gains(const Incidences& incidences)
    : group_(incidences.group), logarithm_(incidences.wi.size(), 0.0), gain_(incidences.wi.size(), 1.0) {}

double Gains::PriorSum() const {
  double sum = 0;
  for (const double logarithm : logarithm_) sum += logarithm * logarithm;
  return precision_ * sum;
}

void Gains::Profile(const Problem& problem, const KernelModel& model, ThreadPool* pool) {
  constexpr int kMostPasses = 12;
  // Steps in units of the gain's own standard error: a cost that is flat to its square.
  constexpr double kSmallest = 1e-8;
  // A lobe that is far off would be made up for by a gain: no step is longer.
  constexpr double kLongest = 0.5;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const GainSums sums = problem.SumGains(model, pool);
    const double sigma = std::sqrt(std::max(sums.sum_of_squares, 1e-300) / static_cast<double>(problem.size()));
    double largest = 0;
    for (std::size_t k = 0; k < size(); ++k) {
      const double curvature = sums.curvature[k] + precision_;
      const double step = std::clamp((sums.slope[k] + precision_ * logarithm_[k]) / curvature, -kLongest, kLongest);
      if (!std::isfinite(step)) continue;
      logarithm_[k] -= step;
      gain_[k] = std::exp(logarithm_[k]);
      largest = std::max(largest, std::fabs(step) * std::sqrt(curvature) / sigma);
    }
    if (largest < kSmallest) return;
  }
}

void EliminateGains(const KernelSums& sums, const Layout& layout, const Gains& gains, Eigen::MatrixXd* hessian,
                    Eigen::VectorXd* gradient, std::vector<GainLink>* links) {
  const auto n = static_cast<Eigen::Index>(layout.size());
  if (links != nullptr) links->assign(gains.size(), {Eigen::VectorXd::Zero(n), gains.precision()});
  std::vector<std::vector<int>> coordinates;
  for (std::size_t c = 0; c < layout.channels(); ++c) coordinates.push_back(layout.CoordinatesOfColumns(c));
  Eigen::VectorXd link(n);
  for (const GainArrow& arrow : sums.arrows) {
    link.setZero();
    double curvature = gains.precision(), slope = gains.precision() * gains.logarithms()[arrow.group];
    const double* product = arrow.products.data();
    for (const std::vector<int>& columns : coordinates) {
      // The gain's own column is the last but the residual.
      for (std::size_t j = 0; j + 1 < columns.size(); ++j) {
        if (columns[j] >= 0) link(columns[j]) += product[j];
      }
      curvature += product[columns.size() - 1];
      slope += product[columns.size()];
      product += columns.size() + 1;
    }
    *hessian -= link * (link.transpose() / curvature);
    *gradient -= link * (slope / curvature);
    if (links != nullptr) (*links)[arrow.group] = {link, curvature};
  }
}

}  // namespace lobefit

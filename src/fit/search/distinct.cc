#include "lobefit/fit/search/distinct.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace lobefit {
namespace {

constexpr double kStandardErrors = 2;
// Mean square of residuals that are nothing but the rounding of exact values.
constexpr double kRounding = 1e-24;

// Descents of one minimum end at costs that agree to a relative 1e-5 (the subsample's descents end at 1e-12), or that
// are both rounding. With so many residuals that 1e-5 is more than noise explains (1.92 variances, 95 % of chi-square)
// they must agree to a tenth of that.
bool SameCost(double a, double b, std::size_t residuals) {
  const double n = static_cast<double>(residuals);
  return std::fabs(a - b) <= std::min(1e-5, 0.4 / n) * std::max(a, b) + kRounding * n;
}

}  // namespace

Neighbourhood::Neighbourhood(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                             ThreadPool* pool)
    : layout_(layout), u_(u) {
  Eigen::VectorXd gradient;
  const double cost = Linearise(problem, layout, u.data(), pool, &gram_, &gradient);
  const auto residuals = static_cast<double>(problem.size() * problem.channels());
  const double freedom = std::max(1.0, residuals - static_cast<double>(layout.size()));
  // Of exact values each of two descents may end where J d is the root of twice the rounding, on either side.
  radius2_ = kStandardErrors * kStandardErrors * 2 * cost / freedom + 8 * kRounding * residuals;
}

bool Neighbourhood::Holds(const std::vector<double>& u) const {
  const std::vector<double> nearest = layout_.NearestEquivalent(u, u_);
  Eigen::VectorXd way(static_cast<Eigen::Index>(u.size()));
  for (std::size_t i = 0; i < u.size(); ++i) way(static_cast<Eigen::Index>(i)) = nearest[i] - u_[i];
  // Without finite derivatives (the cube root where the model vanishes) the cost alone must tell.
  const double length2 = way.dot(gram_ * way);
  return !(length2 > radius2_);
}

void JoinFoundAgain(const Problem& problem, const Layout& layout, ThreadPool* pool,
                    std::vector<DistinctMinimum>* minima) {
  const std::size_t residuals = problem.size() * problem.channels();
  std::erase_if(*minima, [](const DistinctMinimum& m) { return !std::isfinite(m.solution.cost); });
  std::stable_sort(minima->begin(), minima->end(), [](const DistinctMinimum& a, const DistinctMinimum& b) {
    return a.solution.cost < b.solution.cost;
  });
  std::vector<DistinctMinimum> distinct;
  std::vector<std::unique_ptr<Neighbourhood>> around;  // made where they are asked
  for (const DistinctMinimum& minimum : *minima) {
    std::size_t k = distinct.size();
    for (std::size_t i = distinct.size();
         i-- > 0 && SameCost(distinct[i].solution.cost, minimum.solution.cost, residuals);) {
      if (around[i] == nullptr)
        around[i] = std::make_unique<Neighbourhood>(problem, layout, distinct[i].solution.u, pool);
      if (around[i]->Holds(minimum.solution.u)) k = i;
    }
    if (k < distinct.size()) {
      distinct[k].starts += minimum.starts;
    } else {
      distinct.push_back(minimum);
      around.push_back(nullptr);
    }
  }
  *minima = distinct;
}

}  // namespace lobefit

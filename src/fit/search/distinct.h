// Which of the points where descents ended are one minimum found again.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/solve.h"

namespace lobefit {

struct DistinctMinimum {
  Solution solution;
  std::size_t starts = 1;   // descents that ended here
  std::size_t samples = 0;  // on how many samples it was last descended
  // Solution::cost is on all samples; false: scaled from fewer.
  bool on_all_samples = true;
};

// What lies within two standard errors of a minimum u: d^T J^T J d <= 4 s^2, s^2 the mean square of the residuals and d
// the way there from u, to the nearest of the points that describe the same material (Layout::NearestEquivalent). There
// no parameter differs by more than two of its standard errors. Directions that nothing depends on have no length.
// Memory: the square of the number of coordinates.
class Neighbourhood {
 public:
  Neighbourhood(const Problem& problem, const Layout& layout, const std::vector<double>& u, ThreadPool* pool);
  bool Holds(const std::vector<double>& u) const;

 private:
  const Layout& layout_;
  std::vector<double> u_;
  Eigen::MatrixXd gram_;
  double radius2_ = 0;
};

// Sorts by cost, drops those without a finite one and joins what is one minimum: of the same cost, and within the
// other's neighbourhood. Two solutions of equal cost, such as mirror images, stay two.
void JoinFoundAgain(const Problem& problem, const Layout& layout, ThreadPool* pool,
                    std::vector<DistinctMinimum>* minima);

}  // namespace lobefit

// The active set of a step within bounds. Internal to the two forms of BoundedStep (descent.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace lobefit {

// Solves for the free coordinates, holds what left its bounds there, and solves again. `held`: those that stand at x
// from the beginning. minimum(held, x): the minimum of the quadratic model with these held at x.
template <class Minimum>
Eigen::VectorXd StepByActiveSet(const Eigen::VectorXd& low, const Eigen::VectorXd& high, std::vector<char> held,
                                Eigen::VectorXd x, const Minimum& minimum) {
  const Eigen::Index n = x.size();
  for (Eigen::Index round = 0; round <= n; ++round) {
    const Eigen::VectorXd step = minimum(held, x);
    bool left = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[static_cast<std::size_t>(i)] != 0) continue;
      x(i) = std::isfinite(step(i)) ? step(i) : 0.0;
      if (x(i) >= low(i) && x(i) <= high(i)) continue;
      x(i) = std::clamp(x(i), low(i), high(i));
      held[static_cast<std::size_t>(i)] = 1;
      left = true;
    }
    if (!left) break;
  }
  return x;
}

}  // namespace lobefit

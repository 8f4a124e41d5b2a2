// The active set of a step within bounds. Internal to the two forms of BoundedStep (descent.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace lobefit {

// Whether each held coordinate is pressed against its bound, or cannot move; `slope` is the model's gradient at x, of
// which rounding leaves `noise`.
inline bool IsPressed(double low, double high, double x, double slope, double noise) {
  return low >= high || (x <= low && slope > -noise) || (x >= high && slope < noise);
}

// The minimum of a convex quadratic model within bounds about 0. `held`: those that stand at x from the beginning,
// which have no room. minimum(held, x): the minimum with these held at x; product(x): the matrix times x.
//
// First what leaves its bounds is held there, until nothing leaves them: a few solutions, and most often the minimum.
// Where a coordinate is held that would rather come back it is not, and may even lie higher than 0 does: then from 0
// on, each time to the first bound in the way, with the coordinate of the steepest slope inwards let go at each minimum
// (Nocedal and Wright, Numerical Optimization, algorithm 16.3, of bounds).
template <class Minimum, class Product>
Eigen::VectorXd StepByActiveSet(const Eigen::VectorXd& low, const Eigen::VectorXd& high,
                                const Eigen::VectorXd& gradient, const std::vector<char>& without_room,
                                const Eigen::VectorXd& start, const Minimum& minimum, const Product& product) {
  const Eigen::Index n = start.size();
  const auto of = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  // The held coordinate with the steepest slope inwards, in units of its own rounding; -1: none.
  const auto steepest = [&](const std::vector<char>& held, const Eigen::VectorXd& x) {
    const Eigen::VectorXd hx = product(x);
    Eigen::Index found = -1;
    double most = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[of(i)] == 0 || without_room[of(i)] != 0) continue;
      const double slope = gradient(i) + hx(i), noise = 1e-10 * (std::fabs(gradient(i)) + std::fabs(hx(i)));
      if (IsPressed(low(i), high(i), x(i), slope, noise)) continue;
      const double steep = std::fabs(slope) / noise;
      if (found < 0 || steep > most) found = i, most = steep;
    }
    return found;
  };

  std::vector<char> held = without_room;
  Eigen::VectorXd x = start;
  for (Eigen::Index round = 0; round <= n; ++round) {
    const Eigen::VectorXd step = minimum(held, x);
    bool left = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[of(i)] != 0) continue;
      x(i) = std::isfinite(step(i)) ? step(i) : 0.0;
      if (x(i) >= low(i) && x(i) <= high(i)) continue;
      x(i) = std::clamp(x(i), low(i), high(i));
      held[of(i)] = 1;
      left = true;
    }
    if (!left) break;
  }
  if (held == without_room || steepest(held, x) < 0) return x;

  held = without_room;
  x = start;
  for (Eigen::Index i = 0; i < n; ++i) {
    if ((low(i) >= 0 && gradient(i) > 0) || (high(i) <= 0 && gradient(i) < 0)) held[of(i)] = 1;
  }
  for (Eigen::Index round = 0; round < 4 * n; ++round) {
    const Eigen::VectorXd step = minimum(held, x);
    double share = 1;
    const auto room = [&](Eigen::Index i) {
      if (held[of(i)] != 0 || !std::isfinite(step(i)) || (step(i) >= low(i) && step(i) <= high(i))) return 1.0;
      return std::max(0.0, ((step(i) > high(i) ? high(i) : low(i)) - x(i)) / (step(i) - x(i)));
    };
    for (Eigen::Index i = 0; i < n; ++i) share = std::min(share, room(i));
    if (share < 1) {
      for (Eigen::Index i = 0; i < n; ++i) {
        if (held[of(i)] != 0 || !std::isfinite(step(i))) continue;
        const bool stops = room(i) <= share;
        x(i) = stops ? (step(i) > high(i) ? high(i) : low(i)) : x(i) + share * (step(i) - x(i));
        if (stops) held[of(i)] = 1;
      }
      continue;
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      if (held[of(i)] == 0) x(i) = std::isfinite(step(i)) ? step(i) : 0.0;
    }
    const Eigen::Index back = steepest(held, x);
    if (back < 0) break;
    held[of(back)] = 0;
  }
  return x;
}

}  // namespace lobefit

#include "lobefit/fit/sel/envelope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

#include "lobefit/core/sel/sel.h"
#include "lobefit/fit/search/starts.h"

namespace lobefit {
namespace {

// At most three lobes and the constant.
constexpr int kMaxColumns = 4;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxColumns, 1>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxColumns, kMaxColumns>;

// min cost . x over x >= 0 with rows[j] . x >= lower[j] for all j. Domain: cost > 0, and every row has an entry > 0.
// The dual, max lower . y over y >= 0 with sum_j rows[j] y_j <= cost, has as many equations as there are unknowns here
// and starts feasible at zero, so the simplex method inverts 4 x 4 matrices however many samples there are.
Column LeastCost(const std::vector<Column>& rows, const std::vector<double>& lower, const Column& cost) {
  const Eigen::Index n = cost.size();
  // Entries of the basis: sample j, or slack d as -1 - d.
  std::vector<std::ptrdiff_t> basis;
  for (Eigen::Index d = 0; d < n; ++d) basis.push_back(-1 - d);
  const auto column_of = [&](std::ptrdiff_t k) -> Column {
    if (k >= 0) return rows[static_cast<std::size_t>(k)];
    return Column::Unit(n, -1 - k);
  };
  const double scale = std::max(0.0, *std::max_element(lower.begin(), lower.end()));
  Column x = Column::Zero(n);
  for (int pivot = 0; pivot < 1000; ++pivot) {
    Square b(n, n);
    Column basic_cost(n);
    for (Eigen::Index d = 0; d < n; ++d) {
      const std::ptrdiff_t k = basis[static_cast<std::size_t>(d)];
      b.col(d) = column_of(k);
      basic_cost(d) = k >= 0 ? lower[static_cast<std::size_t>(k)] : 0.0;
    }
    const Eigen::PartialPivLU<Square> lu(b);
    const Square transposed = b.transpose();
    x = Eigen::PartialPivLU<Square>(transposed).solve(basic_cost);
    // Enters: the sample farthest below, or a slack of a negative unknown.
    double worst = 1e-10 * scale;
    std::ptrdiff_t enters = 0;
    bool found = false;
    for (std::size_t j = 0; j < rows.size(); ++j) {
      const double above = lower[j] - rows[j].dot(x);
      if (above > worst) {
        worst = above;
        enters = static_cast<std::ptrdiff_t>(j);
        found = true;
      }
    }
    for (Eigen::Index d = 0; d < n; ++d) {
      if (-x(d) > worst) {
        worst = -x(d);
        enters = -1 - d;
        found = true;
      }
    }
    if (!found) break;
    const Column step = lu.solve(column_of(enters)), level = lu.solve(cost);
    Eigen::Index leaves = -1;
    double least = 0;
    for (Eigen::Index d = 0; d < n; ++d) {
      if (!(step(d) > 1e-13 * step.cwiseAbs().maxCoeff())) continue;
      const double ratio = std::max(0.0, level(d)) / step(d);
      if (leaves < 0 || ratio < least) {
        leaves = d;
        least = ratio;
      }
    }
    if (leaves < 0) break;
    basis[static_cast<std::size_t>(leaves)] = enters;
  }
  return x.cwiseMax(0.0);
}

constexpr std::size_t kCoordinates = 5;
using Steps = std::array<double, kCoordinates>;

// The shape with one coordinate moved: logarithms of the widths, offsets in units of the width, psi.
SelShape Moved(const SelShape& shape, std::size_t coordinate, double step) {
  SelShape moved = shape;
  switch (coordinate) {
    case 0:
      moved.alpha_x *= std::exp(step);
      moved.alpha_y *= std::exp(step);
      break;
    case 1:
      moved.alpha_y *= std::exp(step);
      break;
    case 2:
      moved.offset_in += step * shape.alpha_x;
      break;
    case 3:
      moved.offset_across += step * shape.alpha_x;
      break;
    default:
      moved.psi += step;
  }
  moved.alpha_x = std::clamp(moved.alpha_x, 1e-3, 1.0);
  moved.alpha_y = std::clamp(moved.alpha_y, 1e-3 * moved.alpha_x, moved.alpha_x);
  return moved;
}

// Samples that decide where a bound lies: the brightest of each channel, and a stratified rest.
SelSamples Deciding(const SelSamples& samples, std::size_t count) {
  if (samples.size() <= count) return samples;
  std::vector<std::size_t> chosen = StratifiedSubsample(samples.size(), count / 2, 1), order(samples.size());
  for (const std::vector<double>& values : samples.f_r) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(count / 2 / samples.channels());
    std::nth_element(order.begin(), middle, order.end(),
                     [&](std::size_t a, std::size_t b) { return values[a] > values[b]; });
    chosen.insert(chosen.end(), order.begin(), middle);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return samples.Subset(chosen);
}

}  // namespace

double SelSliceIntegral(const SelSlice& slice) {
  double integral = 0;
  for (const double constant : slice.constant) integral += 2 * kPi * constant;
  for (std::size_t l = 0; l < slice.lobes.size(); ++l) {
    const double lobe = SelIntegral(slice.lobes[l].alpha_x, slice.lobes[l].alpha_y);
    for (const double amplitude : slice.amplitude[l]) integral += amplitude * lobe;
  }
  return integral;
}

SelSlice LeastBound(const SelSamples& samples, SelQuantity quantity, const SelSlice& shapes) {
  SelSlice slice = shapes;
  const std::size_t lobes = shapes.lobes.size();
  const auto n = static_cast<Eigen::Index>(lobes) + 1;
  std::vector<Column> rows(samples.size(), Column::Ones(n));
  Column cost = Column::Constant(n, 2 * kPi);
  for (std::size_t l = 0; l < lobes; ++l) {
    const auto column = static_cast<Eigen::Index>(l);
    const SelLobeInFrame lobe(shapes.lobes[l]);
    for (std::size_t i = 0; i < samples.size(); ++i) rows[i](column) = lobe.Evaluate(samples.v[i], nullptr);
    cost(column) = SelIntegral(shapes.lobes[l].alpha_x, shapes.lobes[l].alpha_y);
  }
  std::vector<double> lower(samples.size());
  slice.amplitude.assign(lobes, std::vector<double>(samples.channels()));
  slice.constant.assign(samples.channels(), 0.0);
  for (std::size_t c = 0; c < samples.channels(); ++c) {
    for (std::size_t i = 0; i < samples.size(); ++i) lower[i] = samples.Value(quantity, c, i);
    const Column x = LeastCost(rows, lower, cost);
    for (std::size_t l = 0; l < lobes; ++l) slice.amplitude[l][c] = x(static_cast<Eigen::Index>(l));
    slice.constant[c] = x(n - 1);
  }
  return slice;
}

SelSlice BoundSelSlice(const SelSamples& samples, SelQuantity quantity, const SelSlice& start) {
  const SelSamples few = Deciding(samples, 400);
  SelSlice best = LeastBound(few, quantity, start);
  double least = SelSliceIntegral(best);
  Steps steps = {0.2, 0.2, 0.2, 0.2, 0.2};
  for (int round = 0; round < 30; ++round) {
    bool improved_any = false;
    for (std::size_t k = 0; k < kCoordinates; ++k) {
      bool improved = false;
      for (std::size_t l = 0; l < best.lobes.size(); ++l) {
        for (const double sign : {1.0, -1.0}) {
          SelSlice trial = best;
          trial.lobes[l] = Moved(best.lobes[l], k, sign * steps[k]);
          trial = LeastBound(few, quantity, trial);
          const double integral = SelSliceIntegral(trial);
          if (!(integral < least * (1 - 1e-9))) continue;
          best = trial;
          least = integral;
          improved = true;
          break;
        }
      }
      steps[k] *= improved ? 1.3 : 0.4;
      improved_any = improved_any || improved;
    }
    if (!improved_any && *std::max_element(steps.begin(), steps.end()) < 2e-3) break;
  }
  return LeastBound(samples, quantity, best);
}

}  // namespace lobefit

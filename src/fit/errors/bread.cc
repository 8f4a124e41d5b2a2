#include "lobefit/fit/errors/bread.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"
#include "lobefit/fit/errors/sample_rows.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

// Below this curvature of the cost along a direction, coordinates scaled to curvature 1 each, it is taken as flat: its
// standard error is 1e5 times that of its coordinates alone.
constexpr double kFlat = 1e-10;
// A coordinate with more than this part in a flat direction of length 1 has no error: that direction gives it a tenth,
// at least, of its error alone.
constexpr double kPart = 1e-6;

// 2 rho'' (J^T r)(J^T r)^T summed over the samples.
Eigen::MatrixXd LossCurvature(const Problem& problem, const Layout& layout, const KernelModel& kernel,
                              ThreadPool* pool) {
  const auto n = static_cast<Eigen::Index>(layout.size());
  const std::vector<std::uint32_t> order = FileOrder(problem.size());
  const std::size_t runs = RunCount(problem.size());
  std::vector<Eigen::MatrixXd> partial(runs);
  pool->Run(runs, [&](std::size_t run) {
    Eigen::MatrixXd& sum = partial[run];
    sum.setZero(n, n);
    RowEvaluator evaluator(problem.kernel_samples(), kernel);
    SampleRows samples;
    Eigen::MatrixXd scores;
    const std::size_t last = RunBegin(problem.size(), run + 1);
    for (std::size_t begin = RunBegin(problem.size(), run); begin < last; begin += kPiece) {
      evaluator.Evaluate(order, begin, std::min(last, begin + kPiece), &samples);
      scores.setZero(samples.curvature.size(), n);
      for (std::size_t c = 0; c < samples.rows.size(); ++c) {
        const std::vector<int> columns = layout.CoordinatesOfColumns(c);
        for (std::size_t j = 0; j < columns.size(); ++j) {
          if (columns[j] >= 0)
            scores.col(columns[j]) +=
                samples.rows[c].col(static_cast<Eigen::Index>(j)).cwiseProduct(samples.residuals[c]);
        }
      }
      sum.noalias() += scores.transpose() * samples.curvature.asDiagonal() * scores;
    }
  });
  for (std::size_t run = 1; run < runs; ++run) partial[0] += partial[run];
  return partial[0];
}

SymmetricEigen Decomposed(const Eigen::MatrixXd& symmetric) {
  if (symmetric.size() == 0) return {Eigen::VectorXd(0), symmetric};
  return DecomposeSymmetric(symmetric);
}

// "ln alpha_x and f0[R]" for the coordinates that dominate a direction.
std::string NameDirection(const Eigen::VectorXd& direction, const Layout& layout) {
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (std::fabs(direction(i)) > 0.3) names.push_back(layout.coordinates()[static_cast<std::size_t>(i)].name);
  }
  if (names.size() == 1) return names[0] + ": the samples do not depend on it";
  return Join(names, " and ") + ": only a combination of them changes what was measured";
}

// Marks what has a part in a flat direction, given in scaled coordinates.
void MarkFlat(const Layout& layout, Eigen::VectorXd direction, Bread* bread) {
  direction.normalize();
  for (Eigen::Index i = 0; i < direction.size(); ++i) {
    if (std::fabs(direction(i)) > kPart) bread->undetermined[static_cast<std::size_t>(i)] = true;
  }
  bread->degenerate.push_back(NameDirection(direction, layout));
}

void AddPriors(const Problem& problem, const Layout& layout, double cost, const std::vector<GainLink>& links,
               Bread* bread) {
  const Gains* gains = problem.gains();
  const double of_gains = gains != nullptr ? gains->PriorSum() : 0.0;
  const double variance = (2 * cost - of_gains) / static_cast<double>(problem.size() * problem.channels());
  bread->residual_variance = variance;
  const bool any = gains != nullptr || std::any_of(layout.coordinates().begin(), layout.coordinates().end(),
                                                   [](const Coordinate& coordinate) { return coordinate.observed; });
  if (!any) return;
  const Eigen::Index border = bread->form.border;
  bread->prior_of_gains = bread->prior_of_coordinates = Eigen::MatrixXd::Zero(border, border);
  for (std::size_t k = 0; gains != nullptr && k < gains->size(); ++k) {
    bread->lean.push_back(bread->whitening.transpose() * links[k].link / links[k].curvature);
    bread->prior_of_gains +=
        gains->precision() * gains->residual_variance() * bread->lean[k] * bread->lean[k].transpose();
  }
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Coordinate& coordinate = layout.coordinates()[i];
    if (!coordinate.observed) continue;
    const Eigen::VectorXd row = Eigen::VectorXd(bread->whitening.row(static_cast<Eigen::Index>(i))).head(border);
    bread->prior_of_coordinates += variance * variance * coordinate.prior * row * row.transpose();
  }
}

// Positions within a list of coordinates of those that no bound holds, and these.
struct Free {
  std::vector<int> positions, coordinates;

  Free(const std::vector<int>& all, const std::vector<bool>& at_bound) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (at_bound[static_cast<std::size_t>(all[k])]) continue;
      positions.push_back(static_cast<int>(k));
      coordinates.push_back(all[k]);
    }
  }
};

// A without the coordinates that a bound holds, rows and columns scaled.
ArrowMatrix FreePart(const ArrowMatrix& a, const std::vector<bool>& at_bound, const Eigen::VectorXd& scale) {
  const auto part = [&scale](const Eigen::MatrixXd& block, const Free& rows, const Free& columns) {
    return Eigen::MatrixXd(scale(rows.coordinates).asDiagonal() * block(rows.positions, columns.positions) *
                           scale(columns.coordinates).asDiagonal());
  };
  const Free border(a.shape.border, at_bound);
  ArrowMatrix free;
  free.shape.border = border.coordinates;
  free.border = part(a.border, border, border);
  for (std::size_t c = 0; c < a.own.size(); ++c) {
    const Free own(a.shape.own[c], at_bound);
    free.shape.own.push_back(own.coordinates);
    free.across.push_back(part(a.across[c], border, own));
    free.own.push_back(part(a.own[c], own, own));
  }
  return free;
}

}  // namespace

Bread FactorBread(const Problem& problem, const Layout& layout, const std::vector<double>& u, ThreadPool* pool,
                  std::size_t most_full) {
  const auto n = static_cast<Eigen::Index>(layout.size());
  Bread bread;
  bread.undetermined.assign(layout.size(), false);
  ArrowMatrix a;
  Eigen::VectorXd gradient;
  std::vector<GainLink> links;
  const double cost = LineariseBlocks(problem, layout, u.data(), pool, &a, &gradient, &links);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Coordinate& coordinate = layout.coordinates()[i];
    const double slack = BoundSlack(coordinate);
    const double slope = gradient(static_cast<Eigen::Index>(i));
    bread.at_bound.push_back((u[i] <= coordinate.low + slack && slope >= 0) ||
                             (u[i] >= coordinate.high - slack && slope <= 0));
  }
  const Eigen::VectorXd scale = a.Diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; });
  if (layout.recipe().loss != Loss::kNone) {
    ArrowMatrix coupled(BorderOnly(layout));
    coupled.border = a.Dense() + LossCurvature(problem, layout, layout.ToKernel(u.data()), pool);
    a = std::move(coupled);
  }

  // With D a channel's own block, E its block with the border and S the border's, T = D^-1 E:
  //   A^-1 = sum of own (D^-1) + (1, -T)^T (S - sum of E^T T)^-1 (1, -T).
  const ArrowMatrix blocks = FreePart(a, bread.at_bound, scale);
  const ArrowShape& arrow = blocks.shape;
  const std::size_t channels = layout.channels();
  WhitenedForm& form = bread.form;
  form.border = form.size = static_cast<Eigen::Index>(arrow.border.size());
  std::vector<Eigen::MatrixXd> roots(channels), t(channels);  // root root^T = D^-1 where it is not flat
  Eigen::MatrixXd schur = blocks.border;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<int>& own = arrow.own[c];
    form.first.push_back(form.size);
    form.own.push_back(static_cast<Eigen::Index>(own.size()));
    form.size += form.own.back();
    const SymmetricEigen eigen = Decomposed(blocks.own[c]);
    Eigen::VectorXd factor(own.size());
    for (Eigen::Index k = 0; k < factor.size(); ++k) {
      const bool flat = eigen.values(k) < kFlat;
      factor(k) = flat ? 0 : 1 / std::sqrt(eigen.values(k));
      if (!flat) continue;
      Eigen::VectorXd direction = Eigen::VectorXd::Zero(n);
      for (std::size_t i = 0; i < own.size(); ++i) direction(own[i]) = eigen.vectors(static_cast<Eigen::Index>(i), k);
      MarkFlat(layout, direction, &bread);
    }
    roots[c] = eigen.vectors * factor.asDiagonal();
    t[c] = roots[c] * (roots[c].transpose() * blocks.across[c].transpose());
    schur -= blocks.across[c] * t[c];
  }
  form.full = layout.size() <= most_full || form.size == form.border;
  const SymmetricEigen eigen = Decomposed(schur);
  Eigen::MatrixXd of_border = Eigen::MatrixXd::Zero(n, form.border);  // columns of W
  for (Eigen::Index k = 0; k < form.border; ++k) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < arrow.border.size(); ++i)
      direction(arrow.border[i]) = eigen.vectors(static_cast<Eigen::Index>(i), k);
    for (std::size_t c = 0; c < channels; ++c) {
      const Eigen::VectorXd own = -t[c] * eigen.vectors.col(k);
      for (std::size_t i = 0; i < arrow.own[c].size(); ++i)
        direction(arrow.own[c][i]) = own(static_cast<Eigen::Index>(i));
    }
    if (eigen.values(k) < kFlat * direction.squaredNorm()) {
      MarkFlat(layout, direction, &bread);
    } else {
      of_border.col(k) = scale.cwiseProduct(direction) / std::sqrt(eigen.values(k));
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&entries](Eigen::Index row, Eigen::Index column, double value) {
    if (value != 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), value);
  };
  for (Eigen::Index k = 0; k < form.border; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) add(i, k, of_border(i, k));
  }
  for (std::size_t c = 0; c < channels; ++c) {
    // Rows of the channel's own coordinates are scaled, so that W W^T is the inverse of A as it is.
    const std::vector<int>& own = arrow.own[c];
    Eigen::MatrixXd root = roots[c];
    for (Eigen::Index i = 0; i < root.rows(); ++i) root.row(i) *= scale(own[static_cast<std::size_t>(i)]);
    for (Eigen::Index i = 0; i < root.rows(); ++i) {
      for (Eigen::Index k = 0; k < root.cols(); ++k)
        add(own[static_cast<std::size_t>(i)], form.first[c] + k, root(i, k));
    }
    const std::vector<int> coordinates = layout.CoordinatesOfColumns(c);
    Eigen::MatrixXd whiten =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(coordinates.size()), form.border + form.own[c]);
    for (std::size_t j = 0; j < coordinates.size(); ++j) {
      if (coordinates[j] < 0) continue;
      const auto row = static_cast<Eigen::Index>(j);
      whiten.row(row).head(form.border) = of_border.row(coordinates[j]);
      const auto at = std::find(own.begin(), own.end(), coordinates[j]);
      if (at != own.end()) whiten.row(row).tail(form.own[c]) = root.row(at - own.begin());
    }
    bread.whiten_row.push_back(whiten);
  }
  bread.whitening.resize(n, form.size);
  bread.whitening.setFromTriplets(entries.begin(), entries.end());
  AddPriors(problem, layout, cost, links, &bread);
  return bread;
}

}  // namespace lobefit

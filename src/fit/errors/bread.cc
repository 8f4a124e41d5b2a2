#include "lobefit/fit/errors/bread.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

// The coordinates that no bound holds; all of them in the border where a loss or a gain couples the channels.
ArrowShape FreeArrow(const Layout& layout, const std::vector<bool>& at_bound) {
  const bool coupled = layout.recipe().loss != Loss::kNone || layout.recipe().instrument.drift;
  ArrowShape shape = ArrowShapeOf(layout);
  if (coupled) {
    shape.border.resize(layout.size());
    std::iota(shape.border.begin(), shape.border.end(), 0);
    for (std::vector<int>& own : shape.own) own.clear();
  }
  const auto held = [&](int i) { return at_bound[static_cast<std::size_t>(i)]; };
  std::erase_if(shape.border, held);
  for (std::vector<int>& own : shape.own) std::erase_if(own, held);
  return shape;
}

Eigen::MatrixXd Part(const Eigen::MatrixXd& matrix, const std::vector<int>& rows, const std::vector<int>& columns) {
  Eigen::MatrixXd part(rows.size(), columns.size());
  for (Eigen::Index j = 0; j < part.cols(); ++j) {
    for (Eigen::Index i = 0; i < part.rows(); ++i)
      part(i, j) = matrix(rows[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
  }
  return part;
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
  bread->prior_of_gains = bread->prior_of_coordinates = Eigen::MatrixXd::Zero(bread->size(), bread->size());
  for (std::size_t k = 0; gains != nullptr && k < gains->size(); ++k) {
    bread->lean.push_back(bread->whitening.transpose() * links[k].link / links[k].curvature);
    bread->prior_of_gains +=
        gains->precision() * gains->residual_variance() * bread->lean[k] * bread->lean[k].transpose();
  }
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Coordinate& coordinate = layout.coordinates()[i];
    if (!coordinate.observed) continue;
    const auto row = bread->whitening.row(static_cast<Eigen::Index>(i));
    bread->prior_of_coordinates += variance * variance * coordinate.prior * row.transpose() * row;
  }
}

}  // namespace

Bread FactorBread(const Problem& problem, const Layout& layout, const std::vector<double>& u, ThreadPool* pool) {
  const auto n = static_cast<Eigen::Index>(layout.size());
  Bread bread;
  bread.undetermined.assign(layout.size(), false);
  Eigen::MatrixXd a;
  Eigen::VectorXd gradient;
  std::vector<GainLink> links;
  const double cost = Linearise(problem, layout, u.data(), pool, &a, &gradient, &links);
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Coordinate& coordinate = layout.coordinates()[i];
    const double slack = BoundSlack(coordinate);
    const double slope = gradient(static_cast<Eigen::Index>(i));
    bread.at_bound.push_back((u[i] <= coordinate.low + slack && slope >= 0) ||
                             (u[i] >= coordinate.high - slack && slope <= 0));
  }
  const Eigen::VectorXd scale = a.diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; });
  if (layout.recipe().loss != Loss::kNone) a += LossCurvature(problem, layout, layout.ToKernel(u.data()), pool);
  a = scale.asDiagonal() * a * scale.asDiagonal();

  // With D a channel's own block, E its block with the border and S the border's, T = D^-1 E:
  //   A^-1 = sum of own (D^-1) + (1, -T)^T (S - sum of E^T T)^-1 (1, -T).
  const ArrowShape arrow = FreeArrow(layout, bread.at_bound);
  const std::size_t channels = layout.channels();
  bread.border = static_cast<Eigen::Index>(arrow.border.size());
  Eigen::Index columns = bread.border;
  std::vector<Eigen::MatrixXd> roots(channels), t(channels);  // root root^T = D^-1 where it is not flat
  Eigen::MatrixXd schur = Part(a, arrow.border, arrow.border);
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<int>& own = arrow.own[c];
    bread.first.push_back(columns);
    bread.own.push_back(static_cast<Eigen::Index>(own.size()));
    columns += bread.own.back();
    const SymmetricEigen eigen = Decomposed(Part(a, own, own));
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
    const Eigen::MatrixXd e = Part(a, own, arrow.border);
    t[c] = roots[c] * (roots[c].transpose() * e);
    schur -= e.transpose() * t[c];
  }
  const SymmetricEigen eigen = Decomposed(schur);
  bread.whitening.setZero(n, columns);
  for (Eigen::Index k = 0; k < bread.border; ++k) {
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
      bread.whitening.col(k) = scale.cwiseProduct(direction) / std::sqrt(eigen.values(k));
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < arrow.own[c].size(); ++i) {
      bread.whitening.row(arrow.own[c][i]).segment(bread.first[c], bread.own[c]) =
          scale(arrow.own[c][i]) * roots[c].row(static_cast<Eigen::Index>(i));
    }
    const std::vector<int> coordinates = layout.CoordinatesOfColumns(c);
    Eigen::MatrixXd whiten(coordinates.size(), bread.border + bread.own[c]);
    whiten.setZero();
    for (std::size_t j = 0; j < coordinates.size(); ++j) {
      if (coordinates[j] < 0) continue;
      const auto row = static_cast<Eigen::Index>(j);
      whiten.row(row).head(bread.border) = bread.whitening.row(coordinates[j]).head(bread.border);
      whiten.row(row).tail(bread.own[c]) = bread.whitening.row(coordinates[j]).segment(bread.first[c], bread.own[c]);
    }
    bread.whiten_row.push_back(whiten);
  }
  AddPriors(problem, layout, cost, links, &bread);
  return bread;
}

}  // namespace lobefit

#include <vector>

#include <Eigen/Cholesky>

#include "lobefit/fit/search/active_set.h"
#include "lobefit/fit/search/descent.h"

namespace lobefit {
namespace {

// A part of the coordinates in the equations of one round: what is held is taken out, its value moved to the right.
struct Equations {
  const std::vector<int>& coordinates;
  std::vector<Eigen::Index> held;

  Equations(const std::vector<int>& of, const std::vector<char>& is_held, const Eigen::MatrixXd& own)
      : coordinates(of) {
    for (Eigen::Index i = 0; i < own.rows(); ++i) {
      if (is_held[static_cast<std::size_t>(Coordinate(i))] != 0 || !(own(i, i) > 0)) held.push_back(i);
    }
  }
  int Coordinate(Eigen::Index i) const { return coordinates[static_cast<std::size_t>(i)]; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(coordinates.size()); }
  // Less what is `of` all.
  void MinusOf(const Eigen::VectorXd& all, Eigen::VectorXd* part) const {
    part->resize(size());
    for (Eigen::Index i = 0; i < size(); ++i) (*part)(i) = -all(Coordinate(i));
  }
  // Of x, zero where a coordinate is not held.
  void Held(const Eigen::VectorXd& x, Eigen::VectorXd* part) const {
    part->setZero(size());
    for (const Eigen::Index i : held) (*part)(i) = x(Coordinate(i));
  }
  // The equation of a held coordinate is that it has its value.
  void TakeOut(Eigen::MatrixXd* own, Eigen::VectorXd* right, const Eigen::VectorXd& values) const {
    for (const Eigen::Index i : held) {
      own->row(i).setZero();
      own->col(i).setZero();
      (*own)(i, i) = 1;
      (*right)(i) = values(i);
    }
  }
};

// The minimum in the coordinates that are not held: S x = r - sum B A^-1 g, S = C - sum B A^-1 B^T, with C the border,
// A a channel's own block and B what is between them; then each channel's own. Hundreds of channels have blocks of two
// coordinates: what is as large in each of them is allocated once.
Eigen::VectorXd Minimum(const ArrowMatrix& h, const Eigen::VectorXd& gradient, const std::vector<char>& is_held,
                        const Eigen::VectorXd& x) {
  const Equations border(h.shape.border, is_held, h.border);
  const bool moves =
      static_cast<Eigen::Index>(border.held.size()) < border.size();  // or the channels are by themselves
  Eigen::VectorXd border_held, right, own_held, r;
  border.Held(x, &border_held);
  border.MinusOf(gradient, &right);
  right.noalias() -= h.border * border_held;
  Eigen::MatrixXd schur = h.border, a, b;
  Eigen::LDLT<Eigen::MatrixXd> factor;
  // Of all channels, one below the other: A^-1 B^T, and A^-1 of the right side.
  const Eigen::Index owned = gradient.size() - border.size();
  Eigen::MatrixXd to_border(moves ? owned : 0, border.size());
  Eigen::VectorXd alone(owned);
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < h.own.size(); ++c) {
    const Equations own(h.shape.own[c], is_held, h.own[c]);
    own.MinusOf(gradient, &r);
    if (!border.held.empty()) r.noalias() -= h.across[c].transpose() * border_held;
    a = h.own[c];
    if (!own.held.empty()) {
      own.Held(x, &own_held);
      r.noalias() -= h.own[c] * own_held;
      right.noalias() -= h.across[c] * own_held;
      own.TakeOut(&a, &r, own_held);
    }
    factor.compute(a);
    auto of_channel = alone.segment(at, own.size());
    of_channel = factor.solve(r);
    if (moves) {
      b = h.across[c];
      for (const Eigen::Index i : own.held) b.col(i).setZero();
      auto solved = to_border.middleRows(at, own.size());
      solved = factor.solve(b.transpose());
      schur.noalias() -= b * solved;
      right.noalias() -= b * of_channel;
    }
    at += own.size();
  }
  border.TakeOut(&schur, &right, border_held);
  const Eigen::VectorXd at_border = schur.ldlt().solve(right);
  // What is held in the border is on the right side already.
  Eigen::VectorXd moved = at_border;
  for (const Eigen::Index i : border.held) moved(i) = 0;
  if (moves) alone.noalias() -= to_border * moved;
  Eigen::VectorXd minimum(gradient.size());
  for (Eigen::Index i = 0; i < at_border.size(); ++i) minimum(border.Coordinate(i)) = at_border(i);
  at = 0;
  for (const std::vector<int>& coordinates : h.shape.own) {
    for (const int coordinate : coordinates) minimum(coordinate) = alone(at++);
  }
  return minimum;
}

Eigen::VectorXd Product(const ArrowMatrix& h, const Eigen::VectorXd& x) {
  const auto take = [&x](const std::vector<int>& coordinates, Eigen::VectorXd* values) {
    values->resize(static_cast<Eigen::Index>(coordinates.size()));
    for (std::size_t i = 0; i < coordinates.size(); ++i) (*values)(static_cast<Eigen::Index>(i)) = x(coordinates[i]);
  };
  Eigen::VectorXd product(x.size()), x_border, x_own, own;
  take(h.shape.border, &x_border);
  Eigen::VectorXd border = h.border * x_border;
  for (std::size_t c = 0; c < h.own.size(); ++c) {
    take(h.shape.own[c], &x_own);
    border.noalias() += h.across[c] * x_own;
    own.noalias() = h.own[c] * x_own;
    own.noalias() += h.across[c].transpose() * x_border;
    for (std::size_t i = 0; i < h.shape.own[c].size(); ++i)
      product(h.shape.own[c][i]) = own(static_cast<Eigen::Index>(i));
  }
  for (std::size_t i = 0; i < h.shape.border.size(); ++i)
    product(h.shape.border[i]) = border(static_cast<Eigen::Index>(i));
  return product;
}

}  // namespace

Eigen::VectorXd BoundedStep(const ArrowMatrix& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& low,
                            const Eigen::VectorXd& high) {
  const Eigen::Index n = gradient.size();
  std::vector<char> held(static_cast<std::size_t>(n), 0);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (low(i) < high(i)) continue;
    held[static_cast<std::size_t>(i)] = 1;
    x(i) = low(i);
  }
  return StepByActiveSet(
      low, high, gradient, held, x,
      [&](const std::vector<char>& fixed, const Eigen::VectorXd& at) { return Minimum(hessian, gradient, fixed, at); },
      [&](const Eigen::VectorXd& at) { return Product(hessian, at); });
}

}  // namespace lobefit

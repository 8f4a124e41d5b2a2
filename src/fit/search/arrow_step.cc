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
  Eigen::VectorXd Of(const Eigen::VectorXd& all) const {
    Eigen::VectorXd part(static_cast<Eigen::Index>(coordinates.size()));
    for (Eigen::Index i = 0; i < part.size(); ++i) part(i) = all(Coordinate(i));
    return part;
  }
  // Of x, zero where a coordinate is not held.
  Eigen::VectorXd Held(const Eigen::VectorXd& x) const {
    Eigen::VectorXd part = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(coordinates.size()));
    for (const Eigen::Index i : held) part(i) = x(Coordinate(i));
    return part;
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
// A a channel's own block and B what is between them; then each channel's own.
Eigen::VectorXd Minimum(const ArrowMatrix& h, const Eigen::VectorXd& gradient, const std::vector<char>& is_held,
                        const Eigen::VectorXd& x) {
  const Equations border(h.shape.border, is_held, h.border);
  const Eigen::VectorXd border_held = border.Held(x);
  Eigen::MatrixXd schur = h.border;
  Eigen::VectorXd right = -border.Of(gradient) - h.border * border_held;
  std::vector<Eigen::MatrixXd> to_border(h.own.size());  // A^-1 B^T
  std::vector<Eigen::VectorXd> alone(h.own.size());      // A^-1 of the right side
  std::vector<Eigen::VectorXd> channel_held(h.own.size());
  for (std::size_t c = 0; c < h.own.size(); ++c) {
    const Equations own(h.shape.own[c], is_held, h.own[c]);
    channel_held[c] = own.Held(x);
    Eigen::VectorXd r = -own.Of(gradient) - h.own[c] * channel_held[c] - h.across[c].transpose() * border_held;
    right -= h.across[c] * channel_held[c];
    Eigen::MatrixXd a = h.own[c], b = h.across[c];
    own.TakeOut(&a, &r, channel_held[c]);
    for (const Eigen::Index i : own.held) b.col(i).setZero();
    const Eigen::LDLT<Eigen::MatrixXd> factor(a);
    to_border[c] = factor.solve(b.transpose());
    alone[c] = factor.solve(r);
    schur -= b * to_border[c];
    right -= b * alone[c];
  }
  border.TakeOut(&schur, &right, border_held);
  const Eigen::VectorXd at_border = schur.ldlt().solve(right);
  // What is held in the border is on the right side already.
  Eigen::VectorXd moved = at_border;
  for (const Eigen::Index i : border.held) moved(i) = 0;
  Eigen::VectorXd minimum(gradient.size());
  for (Eigen::Index i = 0; i < at_border.size(); ++i) minimum(border.Coordinate(i)) = at_border(i);
  for (std::size_t c = 0; c < h.own.size(); ++c) {
    const Eigen::VectorXd of_channel = alone[c] - to_border[c] * moved;
    for (Eigen::Index i = 0; i < of_channel.size(); ++i)
      minimum(h.shape.own[c][static_cast<std::size_t>(i)]) = of_channel(i);
  }
  return minimum;
}

Eigen::VectorXd Product(const ArrowMatrix& h, const Eigen::VectorXd& x) {
  const auto part = [](const Eigen::VectorXd& of, const std::vector<int>& coordinates) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(coordinates.size()));
    for (std::size_t i = 0; i < coordinates.size(); ++i) values(static_cast<Eigen::Index>(i)) = of(coordinates[i]);
    return values;
  };
  Eigen::VectorXd product(x.size());
  const Eigen::VectorXd x_border = part(x, h.shape.border);
  Eigen::VectorXd border = h.border * x_border;
  for (std::size_t c = 0; c < h.own.size(); ++c) {
    const Eigen::VectorXd x_own = part(x, h.shape.own[c]);
    border += h.across[c] * x_own;
    const Eigen::VectorXd own = h.own[c] * x_own + h.across[c].transpose() * x_border;
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

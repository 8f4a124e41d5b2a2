#include "lobefit/fit/errors/freedom.h"

#include <limits>

#include "lobefit/fit/errors/clusters.h"

namespace lobefit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostExact = 100;
// Numbers of 8 bytes that the exact degrees of freedom may store twice.
constexpr double kMostStored = 2e6;

// By how much the square of a sum of w is too large, whose mean is that of the square and twice the sum of v^2.
Eigen::ArrayXd Excess(const Eigen::ArrayXd& fourths) { return fourths * (2.0 / 3); }

}  // namespace

FreedomTally::FreedomTally(const WhitenedForm& form, const SparseColumns& numbers, std::size_t clusters,
                           double residual_variance)
    : form_(&form),
      numbers_(&numbers),
      clusters_(clusters),
      exact_(form.full && clusters <= kMostExact &&
             static_cast<double>(clusters) * static_cast<double>(numbers.size()) <= kMostStored),
      per_unit_(residual_variance > 0 ? 1 / residual_variance : 1) {
  squares_ = fourths_ = h_ = e_ = e2_ = squares_2_ = Eigen::ArrayXd::Zero(numbers.cols());
  if (numbers.rows() < kLeastSparse) dense_ = numbers;
}

Eigen::ArrayXXd FreedomTally::Squares(const Eigen::MatrixXd& a) const {
  if (numbers_->rows() < kLeastSparse) return per_unit_ * PieceTimes(a, dense_).array().square();
  return per_unit_ * (a * *numbers_).array().square();
}

void FreedomTally::Add(const Cluster& cluster) {
  squares_ += cluster.squares;
  fourths_ += cluster.fourths;
  if (exact_) {
    const Eigen::MatrixXd root = InverseRootTimes(cluster.curvature, Eigen::MatrixXd(*numbers_));
    Influence influence;
    influence.b = cluster.curvature.Times(root);
    influence.scattered = per_unit_ * cluster.scatter.Times(root);
    influence.own = root.cwiseProduct(influence.scattered).colwise().sum().transpose().array();
    influence.squares = cluster.squares;
    influence.fourths = cluster.fourths;
    h_ += (root - influence.b).cwiseProduct(influence.b).colwise().sum().transpose().array();
    influence_.push_back(std::move(influence));
    return;
  }
  Eigen::ArrayXd h(numbers_->cols());
  for (Eigen::Index k = 0; k < h.size(); ++k) h(k) = cluster.curvature.Quadratic(numbers_->col(k));
  h_ += h;
  const Eigen::ArrayXd part = (h / Lengths()).min(1 - kAlone);
  const Eigen::ArrayXd e = part.square() / (1 - part);
  e_ += e;
  e2_ += e.square();
  squares_2_ += cluster.squares.square();
}

void FreedomTally::Merge(const FreedomTally& other) {
  squares_ += other.squares_;
  fourths_ += other.fourths_;
  h_ += other.h_;
  e_ += other.e_;
  e2_ += other.e2_;
  squares_2_ += other.squares_2_;
  influence_.insert(influence_.end(), other.influence_.begin(), other.influence_.end());
}

Eigen::ArrayXd FreedomTally::Lengths() const {
  return Eigen::ArrayXd::NullaryExpr(numbers_->cols(),
                                     [this](Eigen::Index k) { return numbers_->col(k).squaredNorm(); });
}

Eigen::VectorXd FreedomTally::OfSamples() const {
  return (fourths_ > 0).select(3 * squares_.square() / fourths_, kInfinity);
}

Eigen::ArrayXd FreedomTally::Exact(const WhitenedMatrix& scatter) const {
  const auto dot = [](const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) -> Eigen::ArrayXd {
    return a.cwiseProduct(b).colwise().sum().transpose().array();
  };
  Eigen::ArrayXd trace = Eigen::ArrayXd::Zero(numbers_->cols()), square = trace;
  for (std::size_t g = 0; g < influence_.size(); ++g) {
    const Influence& one = influence_[g];
    const Eigen::MatrixXd all = per_unit_ * scatter.Times(one.b);
    const Eigen::ArrayXd own = one.own - 2 * dot(one.b, one.scattered) + dot(one.b, all);
    trace += own;
    const Eigen::ArrayXd scale = (one.squares > 0).select(own / one.squares, 0);
    square += own.square() - Excess(one.fourths * scale.square());
    for (std::size_t k = 0; k < g; ++k) {
      const Influence& other = influence_[k];
      square += 2 * (dot(other.b, all) - dot(other.b, one.scattered) - dot(one.b, other.scattered)).square();
    }
  }
  return trace.square() / square;
}

Eigen::VectorXd FreedomTally::OfClusters(const WhitenedMatrix& scatter) const {
  Eigen::ArrayXd freedom;
  if (exact_) {
    freedom = Exact(scatter);
  } else {
    const Eigen::ArrayXd shared = (e_.square() - e2_) * (Lengths() / h_).square();
    freedom = squares_.square() / (squares_2_ - Excess(fourths_) + shared * squares_.square());
  }
  // Residuals of zero, as without noise: errors are zero, whatever their quantile.
  freedom = (squares_ > 0).select(freedom.min(static_cast<double>(clusters_)), kInfinity);
  return (h_ > 0).select(freedom, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace lobefit

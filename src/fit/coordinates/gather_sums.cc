// Sums over samples, which the kernel gives by its columns, in the solver's coordinates.
#include "lobefit/fit/coordinates/coordinates.h"

namespace lobefit {

std::vector<int> Layout::CoordinatesOfColumns(std::size_t c) const {
  std::vector<int> index;
  index.reserve(shape_size_ + linear_[c].size() + 2);
  for (std::size_t k = 0; k < shape_size_; ++k) index.push_back(static_cast<int>(k));
  for (const Linear& linear : linear_[c]) index.push_back(linear.index);
  if (recipe_.instrument.drift) index.push_back(-1);
  return index;
}

template <class Add>
void Layout::GatherEntries(const KernelSums& sums, std::size_t dropped, const Add& add,
                           Eigen::VectorXd* gradient) const {
  gradient->setZero(static_cast<Eigen::Index>(size()));
  for (std::size_t c = 0; c < channels_; ++c) {
    // -2 for the residual.
    std::vector<int> index = CoordinatesOfColumns(c);
    index.erase(index.begin(), index.begin() + static_cast<std::ptrdiff_t>(dropped));
    index.push_back(-2);
    const double* entry = sums.gram[c].data();
    for (std::size_t i = 0; i < index.size(); ++i) {
      for (std::size_t j = i; j < index.size(); ++j, ++entry) {
        if (index[i] < 0) continue;
        if (index[j] == -2) {
          (*gradient)(index[i]) += *entry;
        } else if (index[j] >= 0) {
          add(c, index[i], index[j], *entry);
        }
      }
    }
  }
  for (std::size_t k = 0; k < sums.prior_slope.size(); ++k) {
    if (sums.prior_curvature[k] != 0) add(0, static_cast<int>(k), static_cast<int>(k), sums.prior_curvature[k]);
    (*gradient)(static_cast<Eigen::Index>(k)) += sums.prior_slope[k];
  }
}

void Layout::Gather(const KernelSums& sums, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
  hessian->setZero(static_cast<Eigen::Index>(size()), static_cast<Eigen::Index>(size()));
  const auto add = [hessian](std::size_t, int i, int j, double value) {
    (*hessian)(i, j) += value;
    // A shared amplitude may meet itself in one channel only on the diagonal.
    if (i != j) (*hessian)(j, i) += value;
  };
  GatherEntries(sums, 0, add, gradient);
}

void Layout::Gather(const KernelSums& sums, ArrowMatrix* hessian, Eigen::VectorXd* gradient,
                    std::size_t dropped) const {
  *hessian = ArrowMatrix(ArrowShapeOf(*this));
  // Place of each coordinate in its part; below 0: in the border, from -1 on.
  std::vector<Eigen::Index> place(size());
  const ArrowShape& shape = hessian->shape;
  for (std::size_t k = 0; k < shape.border.size(); ++k)
    place[static_cast<std::size_t>(shape.border[k])] = -1 - static_cast<Eigen::Index>(k);
  for (const std::vector<int>& own : shape.own) {
    for (std::size_t k = 0; k < own.size(); ++k) place[static_cast<std::size_t>(own[k])] = static_cast<Eigen::Index>(k);
  }
  const auto add = [hessian, &place](std::size_t c, int i, int j, double value) {
    const Eigen::Index p = place[static_cast<std::size_t>(i)], q = place[static_cast<std::size_t>(j)];
    if (p >= 0 && q >= 0) {
      hessian->own[c](p, q) += value;
      if (i != j) hessian->own[c](q, p) += value;
    } else if (p < 0 && q < 0) {
      hessian->border(-1 - p, -1 - q) += value;
      if (i != j) hessian->border(-1 - q, -1 - p) += value;
    } else {
      hessian->across[c](p < 0 ? -1 - p : -1 - q, p < 0 ? q : p) += value;
    }
  };
  GatherEntries(sums, dropped, add, gradient);
}

std::vector<std::vector<double>> Layout::GatherScores(const std::vector<std::vector<double>>& scores) const {
  const std::size_t count = scores.empty() ? 0 : scores[0].size();
  std::vector<std::vector<double>> gathered(size(), std::vector<double>(count, 0.0));
  const auto add = [&](const std::vector<double>& from, std::size_t to) {
    for (std::size_t i = 0; i < count; ++i) gathered[to][i] += from[i];
  };
  for (std::size_t k = 0; k < shape_size_; ++k) add(scores[k], k);
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t k = 0; k < linear_[c].size(); ++k) {
      if (linear_[c][k].index >= 0)
        add(scores[shape_size_ + c * linear_[c].size() + k], static_cast<std::size_t>(linear_[c][k].index));
    }
  }
  return gathered;
}

}  // namespace lobefit

// Sums of products of the columns of arrays of samples: rows^T rows.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/kernel/kernel_arrays.h"

namespace lobefit {

// The sums of one range of samples.
class ProductSums {
 public:
  // rows^T rows of samples [begin, end) of the `count` of a piece (padded samples x columns).
  void Sum(const Eigen::MatrixXd& rows, Eigen::Index begin, Eigen::Index end, Eigen::Index count) {
    const Eigen::MatrixXd* from = &rows;
    if (begin > 0 || end < count) {
      const Eigen::Index padded = (end - begin + 7) / 8 * 8;
      part_.setZero(padded, rows.cols());
      part_.topRows(end - begin) = rows.middleRows(begin, end - begin);
      from = &part_;
    }
    columns_ = from->cols();
    sums_.assign(static_cast<std::size_t>(columns_ * (columns_ + 1) / 2), 0.0);
    const auto n = static_cast<std::size_t>(from->rows());
    arrays::AddGram(from->data(), static_cast<std::size_t>(columns_), n, n, sums_.data());
  }

  // add(j, k, sum of columns j and k), j <= k.
  template <class Add>
  void ForEach(const Add& add) const {
    std::size_t next = 0;
    for (Eigen::Index j = 0; j < columns_; ++j) {
      for (Eigen::Index k = j; k < columns_; ++k) add(j, k, sums_[next++]);
    }
  }

 private:
  Eigen::Index columns_ = 0;
  Eigen::MatrixXd part_;
  std::vector<double> sums_;
};

}  // namespace lobefit

// Matrices over whitened coordinates for the tests of the errors.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "lobefit/fit/errors/whitened_matrix.h"

namespace lobefit {

// All pairs, of the border.
inline WhitenedForm FormOf(Eigen::Index size) { return {size, {size}, {0}, size, true}; }

// Samples of `channels` channels of two own numbers each beside a border of three: their rows, and what they sum to.
struct ManyChannels {
  static constexpr Eigen::Index kBorder = 3, kOwn = 2;
  WhitenedForm form;
  WhitenedMatrix sum;
  Eigen::MatrixXd dense;

  ManyChannels(std::size_t channels, bool full, double scale) {
    form.border = form.size = kBorder;
    form.full = full;
    for (std::size_t c = 0; c < channels; ++c) {
      form.first.push_back(form.size);
      form.own.push_back(c == 1 ? 0 : kOwn);  // those of one are held
      form.size += form.own.back();
    }
    sum = WhitenedMatrix(form);
    dense = Eigen::MatrixXd::Zero(form.size, form.size);
    ProductSums products;
    for (std::size_t c = 0; c < channels; ++c) {
      const Eigen::Index own = form.own[c];
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(8, kBorder + own), placed = Eigen::MatrixXd::Zero(8, form.size);
      for (Eigen::Index i = 0; i < 5; ++i) {
        for (Eigen::Index j = 0; j < rows.cols(); ++j)
          rows(i, j) = scale * std::sin(1 + 3.7 * static_cast<double>(i) + static_cast<double>(c * 7) +
                                        2.1 * static_cast<double>(j));
      }
      products.Sum(rows, 0, 5, 5);
      sum.AddChannel(c, products);
      placed.leftCols(kBorder) = rows.leftCols(kBorder);
      placed.middleCols(form.first[c], own) = rows.rightCols(own);
      dense += placed.transpose() * placed;
    }
  }
};

}  // namespace lobefit

#include "lobefit/fit/coordinates/arrow.h"

#include <numeric>

#include "lobefit/fit/coordinates/coordinates.h"

namespace lobefit {

ArrowShape ArrowShapeOf(const Layout& layout) {
  constexpr int kSeveral = -2, kNone = -1;
  std::vector<int> channel(layout.size(), kNone);
  for (std::size_t c = 0; c < layout.channels(); ++c) {
    for (const Layout::Linear& linear : layout.linear(c)) {
      if (linear.index < 0) continue;
      int& of = channel[static_cast<std::size_t>(linear.index)];
      of = of == kNone || of == static_cast<int>(c) ? static_cast<int>(c) : kSeveral;
    }
  }
  ArrowShape shape;
  shape.own.resize(layout.channels());
  for (std::size_t i = 0; i < layout.size(); ++i)
    (channel[i] < 0 ? shape.border : shape.own[static_cast<std::size_t>(channel[i])]).push_back(static_cast<int>(i));
  return shape;
}

ArrowShape BorderOnly(const Layout& layout) {
  ArrowShape shape;
  shape.border.resize(layout.size());
  std::iota(shape.border.begin(), shape.border.end(), 0);
  shape.own.resize(layout.channels());
  return shape;
}

ArrowMatrix::ArrowMatrix(const ArrowShape& zero_of) : shape(zero_of) {
  const auto m = static_cast<Eigen::Index>(shape.border.size());
  border = Eigen::MatrixXd::Zero(m, m);
  for (const std::vector<int>& coordinates : shape.own) {
    const auto k = static_cast<Eigen::Index>(coordinates.size());
    across.push_back(Eigen::MatrixXd::Zero(m, k));
    own.push_back(Eigen::MatrixXd::Zero(k, k));
  }
}

Eigen::VectorXd ArrowMatrix::Diagonal() const {
  std::size_t size = shape.border.size();
  for (const std::vector<int>& coordinates : shape.own) size += coordinates.size();
  Eigen::VectorXd diagonal(static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < shape.border.size(); ++i)
    diagonal(shape.border[i]) = border(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
  for (std::size_t c = 0; c < shape.own.size(); ++c) {
    for (std::size_t i = 0; i < shape.own[c].size(); ++i)
      diagonal(shape.own[c][i]) = own[c](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
  }
  return diagonal;
}

void ArrowMatrix::AddToDiagonal(const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < shape.border.size(); ++i)
    border(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += values(shape.border[i]);
  for (std::size_t c = 0; c < shape.own.size(); ++c) {
    for (std::size_t i = 0; i < shape.own[c].size(); ++i)
      own[c](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += values(shape.own[c][i]);
  }
}

bool ArrowMatrix::AllFinite() const {
  bool finite = border.allFinite();
  for (std::size_t c = 0; c < own.size(); ++c) finite = finite && own[c].allFinite() && across[c].allFinite();
  return finite;
}

Eigen::MatrixXd ArrowMatrix::Dense() const {
  const Eigen::Index n = Diagonal().size();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  const auto put = [&dense](const std::vector<int>& rows, const std::vector<int>& columns,
                            const Eigen::MatrixXd& part) {
    for (Eigen::Index j = 0; j < part.cols(); ++j) {
      for (Eigen::Index i = 0; i < part.rows(); ++i) {
        const int row = rows[static_cast<std::size_t>(i)], column = columns[static_cast<std::size_t>(j)];
        dense(row, column) = dense(column, row) = part(i, j);
      }
    }
  };
  put(shape.border, shape.border, border);
  for (std::size_t c = 0; c < own.size(); ++c) {
    put(shape.border, shape.own[c], across[c]);
    put(shape.own[c], shape.own[c], own[c]);
  }
  return dense;
}

}  // namespace lobefit

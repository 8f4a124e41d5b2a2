#include "lobefit/fit/errors/entry_covariance.h"

#include "lobefit/math/vec.h"

namespace lobefit {

EntryCovariance::EntryCovariance(const ReportedEntries& entries, const WhitenedMatrix& filling, bool full)
    : full_(full) {
  const Eigen::Index count = entries.rows.rows();
  variance_.setZero(count);
  kept_.assign(static_cast<std::size_t>(count), -1);
  std::vector<Eigen::Index> rows;
  const Eigen::MatrixXd middle = full ? filling.Dense() : filling.Border();
  for (Eigen::Index i = 0; i < count; ++i) {
    const SparseColumn row = entries.rows.row(i).transpose();
    variance_(i) = filling.Quadratic(row);
    const bool of_border = row.nonZeros() > 0 && row.innerIndexPtr()[row.nonZeros() - 1] < middle.rows();
    if (!full && !of_border) continue;
    kept_[static_cast<std::size_t>(i)] = static_cast<Eigen::Index>(rows.size());
    rows.push_back(i);
  }
  Eigen::MatrixXd kept(static_cast<Eigen::Index>(rows.size()), middle.rows());
  for (std::size_t k = 0; k < rows.size(); ++k)
    kept.row(static_cast<Eigen::Index>(k)) =
        Eigen::VectorXd(entries.rows.row(rows[k]).transpose()).head(middle.rows()).transpose();
  matrix_ = kept * middle * kept.transpose();
  for (const Eigen::Index i : entries.without_error) {
    variance_(i) = kNan;
    const Eigen::Index k = kept_[static_cast<std::size_t>(i)];
    if (k < 0) continue;
    matrix_.row(k).setConstant(kNan);
    matrix_.col(k).setConstant(kNan);
  }
}

double EntryCovariance::operator()(Eigen::Index i, Eigen::Index j) const {
  if (i == j) return variance_(i);
  const Eigen::Index k = kept_[static_cast<std::size_t>(i)], l = kept_[static_cast<std::size_t>(j)];
  return k < 0 || l < 0 ? kNan : matrix_(k, l);
}

void EntryCovariance::AddSquare(const Eigen::VectorXd& moved) {
  const auto has_error = [this](Eigen::Index i) { return variance_(i) > 0; };
  std::vector<Eigen::Index> known;  // of which the matrix holds the pairs
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (kept_[static_cast<std::size_t>(i)] >= 0 && has_error(i)) known.push_back(i);
  }
  for (const Eigen::Index i : known) {
    for (const Eigen::Index j : known)
      matrix_(kept_[static_cast<std::size_t>(i)], kept_[static_cast<std::size_t>(j)]) += moved(i) * moved(j);
  }
  for (Eigen::Index i = 0; i < size(); ++i) {
    if (has_error(i)) variance_(i) += moved(i) * moved(i);
  }
}

}  // namespace lobefit

#include "lobefit/fit/errors/whitened_matrix.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

// The sum of squares of a symmetric matrix, of its lower half.
double SquaredNorm(const Eigen::Ref<const Eigen::MatrixXd>& lower) {
  double sum = 0;
  for (Eigen::Index j = 0; j < lower.cols(); ++j) {
    sum += lower(j, j) * lower(j, j);
    for (Eigen::Index i = j + 1; i < lower.rows(); ++i) sum += 2 * lower(i, j) * lower(i, j);
  }
  return sum;
}

}  // namespace

WhitenedMatrix::WhitenedMatrix(const WhitenedForm& form) : form_(&form) {
  const Eigen::Index corner = form.full ? form.size : form.border;
  corner_.setZero(corner, corner);
  if (form.full) return;
  across_.setZero(form.border, form.size - form.border);
  own_.setZero(*std::max_element(form.own.begin(), form.own.end()), form.size - form.border);
}

void WhitenedMatrix::AddBesideBorder(std::size_t channel, const ProductSums& of_rows) {
  const Eigen::Index border = form_->border, from = form_->first[channel] - border;
  of_rows.ForEach([&](Eigen::Index j, Eigen::Index k, double sum) {  // j <= k
    if (k < border) return;
    (j < border ? across_(j, from + k - border) : own_(k - border, from + j - border)) += sum;
  });
}

void WhitenedMatrix::AddChannel(std::size_t channel, const ProductSums& of_rows) {
  const Eigen::Index border = form_->border, shift = form_->first[channel] - border;
  if (!form_->full) AddBesideBorder(channel, of_rows);
  of_rows.ForEach([&](Eigen::Index j, Eigen::Index k, double sum) {
    if (k >= border && !form_->full) return;
    corner_(k < border ? k : k + shift, j < border ? j : j + shift) += sum;
  });
}

void WhitenedMatrix::AddScatter(const Eigen::MatrixXd& a, Eigen::Index begin, Eigen::Index end, Eigen::Index count,
                                ProductSums* sums) {
  if (form_->full) {
    sums->Sum(a, begin, end, count);
    sums->ForEach([this](Eigen::Index j, Eigen::Index k, double sum) { corner_(k, j) += sum; });
    return;
  }
  const Eigen::Index border = form_->border;
  Eigen::MatrixXd part = a.leftCols(border);
  sums->Sum(part, begin, end, count);
  sums->ForEach([this](Eigen::Index j, Eigen::Index k, double sum) { corner_(k, j) += sum; });
  for (std::size_t c = 0; c < form_->own.size(); ++c) {
    if (form_->own[c] == 0) continue;
    part.conservativeResize(Eigen::NoChange, border + form_->own[c]);
    part.rightCols(form_->own[c]) = a.middleCols(form_->first[c], form_->own[c]);
    sums->Sum(part, begin, end, count);
    AddBesideBorder(c, *sums);
  }
}

void WhitenedMatrix::AddSquare(const Eigen::VectorXd& v) {
  if (form_->full) {
    corner_.selfadjointView<Eigen::Lower>().rankUpdate(v);
    return;
  }
  const Eigen::Index border = form_->border;
  corner_.selfadjointView<Eigen::Lower>().rankUpdate(v.head(border));
  across_.noalias() += v.head(border) * v.tail(form_->size - border).transpose();
  for (std::size_t c = 0; c < form_->own.size(); ++c) {
    const auto part = v.segment(form_->first[c], form_->own[c]);
    own_.block(0, form_->first[c] - border, form_->own[c], form_->own[c])
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(part);
  }
}

void WhitenedMatrix::AddToBorder(const Eigen::MatrixXd& symmetric) {
  corner_.topLeftCorner(form_->border, form_->border).triangularView<Eigen::Lower>() += symmetric;
}

void WhitenedMatrix::AddToBorder(const Eigen::VectorXd& v, double weight) {
  corner_.topLeftCorner(form_->border, form_->border).selfadjointView<Eigen::Lower>().rankUpdate(v, weight);
}

WhitenedMatrix& WhitenedMatrix::operator+=(const WhitenedMatrix& other) {
  if (other.empty()) return *this;
  if (empty()) return *this = other;
  corner_ += other.corner_;
  across_ += other.across_;
  own_ += other.own_;
  return *this;
}

// By hand: Eigen's product of a symmetric matrix copies its blocks into panels first, which of a few rows takes ten
// times as long as the product.
void WhitenedMatrix::AddOwnTimes(std::size_t channel, const double* vector, double* product) const {
  const Eigen::Index first = form_->first[channel], own = form_->own[channel];
  for (Eigen::Index j = 0; j < own; ++j) {
    const double* column = &own_(0, first - form_->border + j);
    const double at_j = vector[first + j];
    double sum = column[j] * at_j;
    for (Eigen::Index i = j + 1; i < own; ++i) {
      product[first + i] += column[i] * at_j;
      sum += column[i] * vector[first + i];
    }
    product[first + j] += sum;
  }
}

Eigen::MatrixXd WhitenedMatrix::Times(const Eigen::MatrixXd& vectors) const {
  if (form_->full) return corner_.selfadjointView<Eigen::Lower>() * vectors;
  const Eigen::Index border = form_->border, others = form_->size - border;
  Eigen::MatrixXd product(vectors.rows(), vectors.cols());
  product.topRows(border) = corner_.selfadjointView<Eigen::Lower>() * vectors.topRows(border);
  product.topRows(border).noalias() += across_ * vectors.bottomRows(others);
  product.bottomRows(others).noalias() = across_.transpose() * vectors.topRows(border);
  for (Eigen::Index v = 0; v < vectors.cols(); ++v) {
    for (std::size_t c = 0; c < form_->own.size(); ++c) AddOwnTimes(c, &vectors(0, v), &product(0, v));
  }
  return product;
}

double WhitenedMatrix::Norm() const {
  double sum = SquaredNorm(corner_) + 2 * across_.squaredNorm();
  for (std::size_t c = 0; !form_->full && c < form_->own.size(); ++c)
    sum += SquaredNorm(own_.block(0, form_->first[c] - form_->border, form_->own[c], form_->own[c]));
  return std::sqrt(sum);
}

Eigen::MatrixXd WhitenedMatrix::Dense() const {
  if (form_->full) return corner_.selfadjointView<Eigen::Lower>();
  return Times(Eigen::MatrixXd::Identity(form_->size, form_->size));
}

Eigen::MatrixXd WhitenedMatrix::Border() const {
  return corner_.topLeftCorner(form_->border, form_->border).selfadjointView<Eigen::Lower>();
}

// i >= j.
double WhitenedMatrix::At(Eigen::Index i, Eigen::Index j) const {
  const Eigen::Index border = form_->border;
  if (form_->full || i < border) return corner_(i, j);
  if (j < border) return across_(j, i - border);
  const auto channel = std::upper_bound(form_->first.begin(), form_->first.end(), j) - form_->first.begin() - 1;
  const Eigen::Index first = form_->first[static_cast<std::size_t>(channel)];
  return own_(i - first, j - border);
}

double WhitenedMatrix::Quadratic(const SparseColumn& z) const {
  double sum = 0;
  for (SparseColumn::InnerIterator i(z); i; ++i) {
    for (SparseColumn::InnerIterator j(z); j; ++j)
      sum += i.value() * At(std::max(i.index(), j.index()), std::min(i.index(), j.index())) * j.value();
  }
  return sum;
}

}  // namespace lobefit

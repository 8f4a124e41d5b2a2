// Symmetric matrices over the whitened coordinates of the sandwich (bread.h): sums of products of its samples.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "lobefit/fit/kernel/product_sums.h"

namespace lobefit {

// Up to so many coordinates all pairs of them are kept, of which a document then holds the covariance: 6 MB.
inline constexpr std::size_t kMostFull = 400;

// Where the whitened coordinates stand: the border's first, then channel by channel those of its own.
struct WhitenedForm {
  Eigen::Index border = 0;
  std::vector<Eigen::Index> first, own;  // [channel]: where its own begin, and how many there are
  Eigen::Index size = 0;
  // Whether all pairs are kept. Of hundreds of channels only those of which one is the border's or both are of one
  // channel: a square of 2400 numbers takes 46 MB, and 800 channels took 430 MB and half of their time for six of them.
  bool full = true;
};

using SparseColumn = Eigen::SparseVector<double>;

class WhitenedMatrix {
 public:
  WhitenedMatrix() = default;                         // empty: of no pairs, for what nothing is added to
  explicit WhitenedMatrix(const WhitenedForm& form);  // zeros; keeps a reference

  bool empty() const { return form_ == nullptr; }

  // Adds the sums of a channel's rows, whose columns are the border's and its own.
  void AddChannel(std::size_t channel, const ProductSums& of_rows);
  // Adds the sum of a a^T over samples [begin, end) of the `count` of a piece (padded samples x size). `sums` is room.
  void AddScatter(const Eigen::MatrixXd& a, Eigen::Index begin, Eigen::Index end, Eigen::Index count,
                  ProductSums* sums);
  void AddSquare(const Eigen::VectorXd& v);                   // v v^T
  void AddToBorder(const Eigen::MatrixXd& symmetric);         // border x border
  void AddToBorder(const Eigen::VectorXd& v, double weight);  // weight v v^T, of the border's numbers
  WhitenedMatrix& operator+=(const WhitenedMatrix& other);    // of the same form, or empty

  // Of the pairs that are kept, the others taken as zero.
  Eigen::MatrixXd Times(const Eigen::MatrixXd& vectors) const;
  double Norm() const;
  Eigen::MatrixXd Dense() const;
  Eigen::MatrixXd Border() const;
  // z^T this z. Of a matrix that is not full, z has parts in the border and in one channel at most.
  double Quadratic(const SparseColumn& z) const;

 private:
  void AddBesideBorder(std::size_t channel, const ProductSums& of_rows);
  // Adds a channel's own block times its part of a vector.
  void AddOwnTimes(std::size_t channel, const double* vector, double* product) const;
  double At(Eigen::Index i, Eigen::Index j) const;

  const WhitenedForm* form_ = nullptr;
  Eigen::MatrixXd corner_;  // lower half, of all or of the border
  // Of what is not full: border x others, and the lower halves of the channels' own blocks side by side.
  Eigen::MatrixXd across_, own_;
};

}  // namespace lobefit

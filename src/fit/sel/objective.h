// The objective of a fit of squared ellipsoidal lobes to the samples of one incident direction: sum of squares and
// pulls of neighbouring slices, with analytic derivatives.
//
// Coordinates of the descent: per lobe t with alpha_x = 1 / (1 + exp(-t)), s with alpha_y = alpha_x exp(-s^2), the two
// offsets, psi; then ln amplitude and ln constant a channel. So alpha_y <= alpha_x always, the kink of the lobe at
// equal alphas (sel.h) is reached at s = 0 and never crossed, and amplitudes stay positive. All
// have limits, beyond which a lobe fits single samples or none, or hides between them.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/coordinates/arrow.h"
#include "lobefit/fit/kernel/product_sums.h"
#include "lobefit/fit/sel/slice.h"

namespace lobefit {

class SelObjective {
 public:
  static constexpr Eigen::Index kShape = 5;  // coordinates of a lobe's shape
  using Coordinates = Eigen::VectorXd;

  // All arguments must outlive the object.
  SelObjective(const SelSamples& samples, std::size_t lobes, const SelSliceOptions& options,
               const std::vector<SelPull>& pulls);

  Eigen::Index size() const { return kShape * lobes_ + (lobes_ + 1) * channels_; }
  Coordinates From(const SelSlice& slice) const;
  SelSlice ToSlice(const Coordinates& u) const;
  // The limits.
  Coordinates Low() const;
  Coordinates High() const;

  // Whether a coordinate stands at its limit. An amplitude or constant of nothing is no limit.
  bool IsAtLimit(const Coordinates& u) const;

  // Sum of squares; with `hessian` also J^T J and J^T r.
  double SumSquares(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const;
  // The same with the hessian (not null) as an arrow, the shapes its border: linear in the channels.
  double SumSquares(const Coordinates& u, ArrowMatrix* hessian, Eigen::VectorXd* gradient) const;
  // The pulls' part of the objective, added to gradient and to `hessian`, whose first rows are the shapes, unless null.
  double Pulls(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const;

 private:
  struct Prepared;
  // K of each lobe at a sample, and its derivatives by the shape's coordinates.
  struct LobeValues {
    std::vector<double> k;
    std::vector<std::array<double, kShape>> dk;
  };
  Eigen::Index Amplitude(Eigen::Index lobe, Eigen::Index channel) const {
    return kShape * lobes_ + lobe * channels_ + channel;
  }
  Eigen::Index Constant(Eigen::Index channel) const { return Amplitude(lobes_, channel); }
  double High(Eigen::Index k) const;
  double Low(Eigen::Index k) const;
  ArrowMatrix EmptyArrow() const;
  template <class Gram>
  double Sum(const Coordinates& u, Gram* hessian, Eigen::VectorXd* gradient) const;
  // Adds the products of a channel's columns: of the shapes of all lobes, then of its amplitudes and its constant.
  void AddGram(const ProductSums& sums, Eigen::Index channel, Eigen::MatrixXd* hessian) const;
  void AddGram(const ProductSums& sums, Eigen::Index channel, ArrowMatrix* hessian) const;
  void EvaluateLobes(const Prepared& at, std::size_t sample, bool derivatives, LobeValues* values) const;
  void AddPull(const SelPull& pull, Eigen::Index lobe, const Coordinates& u, double* sum, Eigen::MatrixXd* hessian,
               Eigen::VectorXd* gradient) const;

  const SelSamples& samples_;
  const SelSliceOptions& options_;
  const std::vector<SelPull>& pulls_;
  Eigen::Index lobes_, channels_;
  std::vector<double> most_;  // ln of the largest amplitude, [channel]
};

}  // namespace lobefit

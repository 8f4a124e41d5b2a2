// Residuals and their derivatives sample by sample, for what a sum over samples cannot give: leverages, clusters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/fit/metric/loss.h"

namespace lobefit {

// A piece of samples, evaluated. With a loss rows and residuals are those of the samples times sqrt(rho'), so that
// rows^T residuals is the gradient of the cost, and its derivative by the coordinates is
//   rows^T rows + curvature (rows^T residuals)(rows^T residuals)^T,   curvature = 2 rho'' / rho'^2.
struct SampleRows {
  std::vector<Eigen::MatrixXd> rows;       // [channel] samples x columns of KernelModel without the residual
  std::vector<Eigen::VectorXd> residuals;  // [channel]
  Eigen::VectorXd curvature, root_rho;     // a sample: the curvature, 0 without a loss, and sqrt(rho')
};

// Samples of a piece for which the evaluator is quickest.
inline constexpr std::size_t kPiece = 256;

using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// rows * matrix, of the samples of a piece, padded with rows of zeros to a multiple of 8.
Eigen::MatrixXd PieceTimes(const Eigen::MatrixXd& rows, const RowMajorMatrix& matrix);

// 0, 1, ..., count - 1.
std::vector<std::uint32_t> FileOrder(std::size_t count);

// Evaluates the samples order[begin .. end) of a model.
class RowEvaluator {
 public:
  // Keeps references to both.
  RowEvaluator(const KernelSamples& samples, const KernelModel& model);
  void Evaluate(const std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end, SampleRows* to);

 private:
  const KernelSamples& samples_;
  KernelModel model_;  // without the loss
  Loss loss_;
  std::vector<std::vector<double>> gathered_, columns_;
  std::vector<std::uint32_t> gathered_groups_;
  std::vector<std::uint16_t> gathered_turns_;
};

}  // namespace lobefit

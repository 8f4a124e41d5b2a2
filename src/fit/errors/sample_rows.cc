#include "lobefit/fit/errors/sample_rows.h"

#include <cmath>
#include <numeric>

#include "lobefit/fit/kernel/kernel_arrays.h"

namespace lobefit {

Eigen::MatrixXd PieceTimes(const Eigen::MatrixXd& rows, const RowMajorMatrix& matrix) {
  // Eigen's products know no wider vectors than those that every machine has.
  const Eigen::Index padded = (rows.rows() + 7) / 8 * 8;
  const auto n = static_cast<std::size_t>(padded), columns = static_cast<std::size_t>(matrix.cols());
  Eigen::MatrixXd wider, to(padded, matrix.cols());
  if (padded > rows.rows()) {
    wider.setZero(padded, rows.cols());
    wider.topRows(rows.rows()) = rows;
  }
  arrays::Contract(padded > rows.rows() ? wider.data() : rows.data(), matrix.data(),
                   static_cast<std::size_t>(matrix.rows()), columns, n, n, to.data());
  return to;
}

std::vector<std::uint32_t> FileOrder(std::size_t count) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

RowEvaluator::RowEvaluator(const KernelSamples& samples, const KernelModel& model)
    : samples_(samples), model_(model), loss_(model.loss) {
  model_.loss = Loss::kNone;
}

void RowEvaluator::Evaluate(const std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end,
                            SampleRows* to) {
  // Copies, so that the kernel finds the samples side by side.
  KernelSamples piece = samples_;
  std::size_t next = 0;
  const auto gather = [&](const double* from) -> const double* {
    if (from == nullptr) return nullptr;
    if (gathered_.size() == next) gathered_.emplace_back();
    std::vector<double>& array = gathered_[next++];
    array.resize(end - begin);
    for (std::size_t i = begin; i < end; ++i) array[i - begin] = from[order[i]];
    return array.data();
  };
  for (const double*& direction : piece.direction) direction = gather(direction);
  for (const double*& measured : piece.measured) measured = gather(measured);
  piece.weight = gather(piece.weight);
  piece.solid_angle = gather(piece.solid_angle);
  if (piece.gain_group != nullptr) {
    gathered_groups_.resize(end - begin);
    for (std::size_t i = begin; i < end; ++i) gathered_groups_[i - begin] = samples_.gain_group[order[i]];
    piece.gain_group = gathered_groups_.data();
  }
  if (piece.turn != nullptr) {
    gathered_turns_.resize(end - begin);
    for (std::size_t i = begin; i < end; ++i) gathered_turns_[i - begin] = samples_.turn[order[i]];
    piece.turn = gathered_turns_.data();
  }
  piece.count = end - begin;
  Columns(piece, model_, 0, piece.count, &columns_);

  const auto count = static_cast<Eigen::Index>(piece.count);
  const auto columns = static_cast<Eigen::Index>(model_.columns()) - 1;
  to->rows.resize(model_.channels);
  to->residuals.resize(model_.channels);
  to->curvature.setZero(count);
  to->root_rho.setOnes(count);
  for (std::size_t c = 0; c < model_.channels; ++c) {
    to->rows[c] = Eigen::Map<const Eigen::MatrixXd>(columns_[c].data(), count, columns);
    to->residuals[c] = Eigen::Map<const Eigen::VectorXd>(columns_[c].data() + columns * count, count);
  }
  if (loss_ == Loss::kNone) return;
  for (Eigen::Index i = 0; i < count; ++i) {
    double s = 0;
    for (const Eigen::VectorXd& r : to->residuals) s += r(i) * r(i);
    const LossValue rho = EvaluateLoss(loss_, model_.loss_scale, s);
    // Beyond its scale a loss may count a sample for nothing.
    if (rho.first > 0) to->curvature(i) = 2 * rho.second / (rho.first * rho.first);
    to->root_rho(i) = std::sqrt(rho.first);
    for (std::size_t c = 0; c < model_.channels; ++c) {
      to->rows[c].row(i) *= to->root_rho(i);
      to->residuals[c](i) *= to->root_rho(i);
    }
  }
}

}  // namespace lobefit

#include "lobefit/fit/inference/outlier_pull.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/fit/errors/bread.h"
#include "lobefit/fit/errors/sample_rows.h"

namespace lobefit {
namespace {

constexpr double kMostDeviations = 5, kMostPull = 2;

constexpr const char* kPullPhrase = " further from the model than noise explains still move ";

// Standard deviations of the residuals of samples [begin, begin + count) of one channel by the noise of their readings.
std::vector<double> Deviations(const Problem& problem, const Transform& transform, const NoiseModel& noise,
                               const std::vector<double>& f_r, std::size_t begin) {
  const double* cos_i = problem.kernel_samples().direction[2] + begin;
  std::vector<double> inverse_slope(f_r.size()), deviation(f_r.size());
  InverseSlopes(transform, f_r.data(), cos_i, f_r.size(), inverse_slope.data());
  for (std::size_t i = 0; i < f_r.size(); ++i) {
    deviation[i] =
        std::sqrt(problem.Weight(begin + i) * noise.VarianceAt(f_r[i] * cos_i[i])) / std::fabs(inverse_slope[i]);
  }
  return deviation;
}

}  // namespace

std::optional<OutlierPull> PullOfOutliers(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                          const Uncertainty& uncertainty, const NoiseModel& noise, ThreadPool* pool) {
  const KernelModel kernel = layout.ToKernel(u.data());
  if (kernel.loss == Loss::kNone) return std::nullopt;
  const Bread bread = FactorBread(problem, layout, u, pool);
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(bread.form.size, 2);  // whitened; above the model, below it
  OutlierPull result;
  const std::vector<std::uint32_t> order = FileOrder(problem.size());
  RowEvaluator evaluator(problem.kernel_samples(), kernel);
  SampleRows rows;
  std::vector<std::vector<double>> f_r, deviations(problem.channels());
  for (std::size_t begin = 0; begin < problem.size(); begin += kPiece) {
    const std::size_t count = std::min(problem.size() - begin, kPiece);
    evaluator.Evaluate(order, begin, begin + count, &rows);
    ModelValues(problem.kernel_samples(), kernel, begin, begin + count, &f_r);
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      f_r[c].resize(count);
      deviations[c] = Deviations(problem, kernel.transform, noise, f_r[c], begin);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      bool wrong = false;
      for (std::size_t c = 0; c < f_r.size(); ++c)
        wrong = wrong || std::fabs(rows.residuals[c](i)) > kMostDeviations * rows.root_rho(i) * deviations[c][k];
      if (!wrong) continue;
      ++result.outliers;
      for (std::size_t c = 0; c < f_r.size(); ++c) {
        const double residual = rows.residuals[c](i);
        const Eigen::VectorXd pull = (rows.rows[c].row(i) * bread.whiten_row[c]).transpose() * residual;
        auto side = pulls.col(residual < 0 ? 0 : 1);
        side.head(bread.form.border) += pull.head(bread.form.border);
        side.segment(bread.form.first[c], bread.form.own[c]) += pull.tail(bread.form.own[c]);
      }
    }
  }
  if (result.outliers == 0) return std::nullopt;
  const Eigen::MatrixXd moved = -layout.ReportJacobian(u.data()) * (bread.whitening * pulls);
  Eigen::Index row = 0;
  for (const Parameter& parameter : Parameters(layout.recipe().model)) {
    for (std::size_t c = 0; c < (parameter.per_channel ? layout.channels() : 1); ++c, ++row) {
      const double variance = uncertainty.covariance.Variance(row);
      if (!(variance > 0) || !moved.row(row).allFinite()) continue;
      OutlierPull pull = result;
      pull.above = moved(row, 0) / std::sqrt(variance);
      pull.below = moved(row, 1) / std::sqrt(variance);
      pull.parameter = parameter.json_name;
      if (pull.errors() > result.errors()) result = pull;
    }
  }
  return result;
}

std::string ToPullRemark(const OutlierPull& pull, Loss loss, double scale) {
  if (!(pull.errors() > kMostPull)) return "";
  return fmt::format(
      "loss {} of scale {:g}: {} samples{}{} by {:+.2g} (those above it) and {:+.2g} standard errors (below); its "
      "intervals hold where the two cancel in the mean, and a smaller scale leaves less of both",
      NameOf(LossChoices(), loss), scale, pull.outliers, kPullPhrase, pull.parameter, pull.above, pull.below);
}

bool IsPullRemark(const std::string& remark) { return remark.find(kPullPhrase) != std::string::npos; }

}  // namespace lobefit

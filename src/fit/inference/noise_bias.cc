#include "lobefit/fit/inference/noise_bias.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/fit/inference/noisy_loss.h"
#include "lobefit/fit/search/descent.h"

namespace lobefit {
namespace {

constexpr double kMostNegative = 0.001, kMostNearFloor = 0.05, kMostErrors = 0.5, kLeastRelative = 0.02;

double DeviationAt(const NoiseModel& noise, double v) { return std::sqrt(noise.VarianceAt(v)); }

bool IsNearFloor(const NoiseModel& noise, double v) { return v < 3 * std::sqrt(noise.DarkVarianceAt(v)); }

constexpr const char* kBiasPhrase = " is biased by the noise of these values (";

// The means of the loss over the noise of samples of a problem: of some of them, spread over all.
class ScoresOfLoss {
 public:
  ScoresOfLoss(const Problem& problem, const KernelModel& kernel, const Samples& samples, const NoiseModel& noise,
               const std::vector<std::vector<double>>& f_r)
      : problem_(problem),
        samples_(samples),
        f_r_(f_r),
        loss_(kernel.transform, kernel.loss, kernel.loss_scale, noise),
        step_(std::max<std::size_t>(1, problem.size() / kMost)) {}

  // [channel] of sample i; all 0 for those that are passed over.
  std::vector<MeanScore> Of(std::size_t i) const {
    if (i % step_ != 0) return std::vector<MeanScore>(f_r_.size());
    std::vector<double> v;
    for (const std::vector<double>& f : f_r_) v.push_back(f[i] * samples_.wi_z[i]);
    return loss_.Evaluate(v, std::sqrt(problem_.Weight(i)));
  }

 private:
  static constexpr std::size_t kMost = 4000;
  const Problem& problem_;
  const Samples& samples_;
  const std::vector<std::vector<double>>& f_r_;
  NoisyLoss loss_;
  std::size_t step_;
};

// J^T W (T'' s^2 / 2), in the columns of `shift` with the s of floor and counts and with that of all noise, and J^T W J
// of the samples. With a loss: the first with the mean of its curvature as a further weight, in place of the second the
// mean of its score.
void AddShift(const Problem& problem, const Layout& layout, const KernelModel& model, const Samples& samples,
              const NoiseModel& noise, const std::vector<std::vector<double>>& f_r, ArrowMatrix* hessian,
              Eigen::MatrixXd* shift) {
  constexpr std::size_t kPiece = 256;
  std::optional<ScoresOfLoss> scores;
  if (model.loss != Loss::kNone) scores.emplace(problem, model, samples, noise, f_r);
  KernelModel kernel = model;
  kernel.loss = Loss::kNone;
  std::vector<std::vector<MeanScore>> means(kPiece);  // [sample][channel], with a loss
  std::vector<std::vector<double>> columns;
  std::vector<double> level(kPiece), curvature(kPiece), deviation(kPiece);
  const std::vector<double> one(kPiece, 1.0);
  KernelSums sums;
  sums.gram.resize(f_r.size());
  for (std::size_t begin = 0; begin < problem.size(); begin += kPiece) {
    const std::size_t count = std::min(problem.size(), begin + kPiece) - begin;
    Columns(problem.kernel_samples(), kernel, begin, begin + count, &columns);
    for (std::size_t i = 0; scores && i < count; ++i) means[i] = scores->Of(begin + i);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (std::size_t i = 0; i < count; ++i) {
        const double v = f_r[c][begin + i] * samples.wi_z[begin + i];
        deviation[i] = DeviationAt(noise, v);
        level[i] = std::max(v, 2 * deviation[i]);
      }
      Curvatures(kernel.transform, level.data(), one.data(), count, curvature.data());
      const Eigen::Index rows = static_cast<Eigen::Index>(count),
                         width = static_cast<Eigen::Index>(columns[c].size() / count);
      const Eigen::Map<const Eigen::MatrixXd> j(columns[c].data(), rows, width);
      Eigen::MatrixXd moved(rows, 2);
      Eigen::VectorXd weight = Eigen::VectorXd::Ones(rows);
      for (std::size_t i = 0; i < count; ++i) {
        const double half = std::sqrt(problem.Weight(begin + i)) * 0.5 * curvature[i];
        moved(static_cast<Eigen::Index>(i), 0) =
            half * noise.DarkVarianceAt(f_r[c][begin + i] * samples.wi_z[begin + i]);
        moved(static_cast<Eigen::Index>(i), 1) = half * deviation[i] * deviation[i];
        if (!scores) continue;
        const MeanScore& mean = means[i][c];
        weight(static_cast<Eigen::Index>(i)) = mean.curvature;
        moved(static_cast<Eigen::Index>(i), 0) *= mean.curvature;
        moved(static_cast<Eigen::Index>(i), 1) = -mean.score;
      }
      const Eigen::MatrixXd gram = j.transpose() * weight.asDiagonal() * j, pull = j.transpose() * moved;
      sums.gram[c].resize(static_cast<std::size_t>(width * (width + 1) / 2), 0.0);
      double* entry = sums.gram[c].data();
      for (Eigen::Index a = 0; a < width; ++a) {
        for (Eigen::Index b = a; b < width; ++b) *entry++ += gram(a, b);
      }
      const std::vector<int> index = layout.CoordinatesOfColumns(c);
      for (std::size_t k = 0; k < index.size(); ++k) {
        if (index[k] >= 0) shift->row(index[k]) += pull.row(static_cast<Eigen::Index>(k));
      }
    }
  }
  Eigen::VectorXd gradient;
  layout.Gather(sums, hessian, &gradient);
}

// The largest bias of a reported parameter. `moved`: by entry.
NoiseBias::Largest LargestOf(const Layout& layout, const Eigen::VectorXd& moved, const Uncertainty& uncertainty) {
  NoiseBias::Largest largest;
  Eigen::Index row = 0;
  for (const Parameter& parameter : Parameters(layout.recipe().model)) {
    for (std::size_t c = 0; c < (parameter.per_channel ? layout.channels() : 1); ++c, ++row) {
      const double errors = std::fabs(moved(row)) / std::sqrt(uncertainty.covariance.Variance(row));
      if (std::isfinite(errors) && errors > largest.errors) largest = {errors, parameter.json_name};
    }
  }
  return largest;
}

std::string NoiseInWords(const NoiseModel& noise) {
  // Noise of the value that hides below the floor is not determined.
  const std::string counts =
      noise.poisson > 0 ? fmt::format(", counting noise of {:.2g}/sr a count", noise.poisson) : std::string();
  if (noise.relative < kLeastRelative) {
    return fmt::format("noise floor {:.2g}/sr{}, noise below {:g} % of the value", noise.floor, counts,
                       100 * kLeastRelative);
  }
  return fmt::format("noise floor {:.2g}/sr{}, noise {:.2g} % of the value", noise.floor, counts, 100 * noise.relative);
}

std::string BiasInWords(const NoiseBias::Largest& bias, const char* metric) {
  if (!(bias.errors > kMostErrors)) return fmt::format("{} would be biased by such noise", metric);
  return fmt::format("{} would be biased by such noise ({} by about {:.2g} standard errors)", metric, bias.parameter,
                     bias.errors);
}

}  // namespace

std::optional<NoiseBias> PredictNoiseBias(const Layout& layout, const std::vector<double>& u,
                                          const Uncertainty& uncertainty, const Samples& all,
                                          const Incidences& incidences, ThreadPool* pool) {
  const auto [samples, groups] = SubsetForNoise(all, incidences);
  if (samples.size() == 0) return std::nullopt;
  Problem problem(samples, layout.recipe());
  const KernelModel kernel = layout.ToKernel(u.data());
  problem.Reweigh(kernel, pool);
  std::vector<std::vector<double>> f_r;
  ModelValues(problem.kernel_samples(), kernel, 0, problem.size(), &f_r);
  const std::optional<NoiseModel> noise = EstimateNoise(samples, groups, f_r);
  if (!noise) return std::nullopt;
  NoiseBias bias;
  bias.noise = *noise;
  std::size_t negative = 0, near_floor = 0;
  for (std::size_t c = 0; c < f_r.size(); ++c) {
    negative += static_cast<std::size_t>(
        std::count_if(all.values[c].begin(), all.values[c].end(), [](double f) { return f < 0; }));
    for (std::size_t i = 0; i < samples.size(); ++i)
      near_floor += IsNearFloor(*noise, f_r[c][i] * samples.wi_z[i]) ? 1 : 0;
  }
  const auto channels = static_cast<double>(f_r.size());
  bias.negative = static_cast<double>(negative) / (channels * static_cast<double>(all.size()));
  bias.near_floor = static_cast<double>(near_floor) / (channels * static_cast<double>(samples.size()));
  const auto n = static_cast<Eigen::Index>(layout.size());
  ArrowMatrix hessian;
  Eigen::MatrixXd shift = Eigen::MatrixXd::Zero(n, 2), moved(n, 2);
  AddShift(problem, layout, kernel, samples, *noise, f_r, &hessian, &shift);
  // What a hair of the curvature is: directions that the samples do not determine stay where they are.
  constexpr double kUndetermined = 1e-10;
  hessian.AddToDiagonal(kUndetermined * hessian.Diagonal());
  // Coordinates at a bound have variance 0: they stay there.
  const Eigen::VectorXd room = uncertainty.coordinate_variance.unaryExpr([](double x) { return x > 0 ? 1e300 : 0.0; });
  for (Eigen::Index k = 0; k < 2; ++k) moved.col(k) = BoundedStep(hessian, -shift.col(k), -room, room);
  const Eigen::MatrixXd of_entries = layout.ReportJacobian(u.data()) * moved;
  bias.of_floor = LargestOf(layout, of_entries.col(0), uncertainty);
  bias.of_all = LargestOf(layout, of_entries.col(1), uncertainty);
  bias.moved = moved.col(1);
  return bias;
}

void AddBias(const NoiseBias& bias, const Layout& layout, const std::vector<double>& u, Uncertainty* uncertainty) {
  const Eigen::VectorXd moved = layout.ReportJacobian(u.data()) * bias.moved;
  uncertainty->covariance.AddSquare(moved);
  if (uncertainty->has_clusters) uncertainty->clustered.AddSquare(moved);
}

bool WantsAsinh(const NoiseBias& bias) {
  return (bias.noise.floor > 0 || bias.noise.poisson > 0) &&
         (bias.negative > kMostNegative || bias.near_floor > kMostNearFloor || bias.of_floor.errors > kMostErrors);
}

NoiseModel NoiseForAsinh(const NoiseModel& estimated) {
  // With counting noise the share of the value does not set the knee (TransformOf).
  const double least = estimated.poisson > 0 ? 0.05 * kLeastRelative : kLeastRelative;
  return {estimated.floor, std::max(estimated.relative, least), estimated.poisson};
}

bool IsNear(const NoiseModel& a, const NoiseModel& b) {
  const auto near = [](double x, double y) { return std::fabs(x - y) <= 0.1 * std::max(x, y); };
  return near(a.floor, b.floor) && near(a.relative, b.relative) && near(a.poisson, b.poisson);
}

std::string ToSwitchRemark(const NoiseBias& bias, Metric before) {
  const NoiseModel used = NoiseForAsinh(bias.noise);
  std::string why;
  if (bias.negative > kMostNegative) {
    why = fmt::format("{:.2g} % of the readings are negative", 100 * bias.negative);
  } else if (bias.near_floor > kMostNearFloor) {
    why = fmt::format("{:.2g} % of the fitted values lie below three times the noise floor", 100 * bias.near_floor);
  } else {
    why = "small values drown in noise";
  }
  const char* name = RowOf(before).name;
  return fmt::format("{} ({}): fitted with metric asinh, knee {:.2g}/sr; {}. --metric {} keeps it", why,
                     NoiseInWords(bias.noise), TransformOf(Metric::kAsinh, used).knee, BiasInWords(bias.of_floor, name),
                     name);
}

std::string ToBiasRemark(const NoiseBias& bias, Metric metric, Loss loss) {
  const NoiseBias::Largest& largest = bias.of_all;
  if (!(largest.errors > kMostErrors)) return "";
  if (loss != Loss::kNone) {
    return fmt::format(
        "loss {} of metric {}{}{}): {} by about {:.2g} standard errors, which the errors hold; a larger scale is less",
        NameOf(LossChoices(), loss), RowOf(metric).name, kBiasPhrase, NoiseInWords(bias.noise), largest.parameter,
        largest.errors);
  }
  return fmt::format("metric {}{}{}): {} by about {:.2g} standard errors; --metric asinh is not", RowOf(metric).name,
                     kBiasPhrase, NoiseInWords(bias.noise), largest.parameter, largest.errors);
}

bool IsBiasRemark(const std::string& remark) {
  return (remark.starts_with("metric ") || remark.starts_with("loss ")) &&
         remark.find(kBiasPhrase) != std::string::npos;
}

}  // namespace lobefit

#include "lobefit/fit/sel_slice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "lobefit/fit/starts.h"

namespace lobefit {
namespace {

constexpr Eigen::Index kShape = 5;  // coordinates of a lobe's shape

// Limits of the coordinates: alpha_x from 1e-3 to 0.999, aspect to 1:126, offsets to 57 degrees. Beyond them a lobe
// fits single samples, or none.
constexpr double kMaxT = 6.9, kMaxS = 2.2, kMaxOffset = 1, kMinLog = -40, kMaxLog = 30;

struct Transformed {
  double value, derivative;  // of a model's f_r
};

Transformed Transform1(Metric metric, double f, double cos_i, double measured) {
  switch (metric) {
    case Metric::kLog:
    case Metric::kLowLog:
      return {std::log1p(f * cos_i), cos_i / (1 + f * cos_i)};
    case Metric::kCubeRoot: {
      const double root = std::cbrt(f * cos_i);
      return {root, f > 0 ? cos_i / (3 * root * root) : 0.0};
    }
    case Metric::kRelative:
      return {f / measured, 1 / measured};
    case Metric::kCosineL2:
    case Metric::kNgan:
      return {f * cos_i, cos_i};
  }
  return {0, 0};
}

using Coordinates = Eigen::VectorXd;

SelShape ShapeAt(const Coordinates& u, Eigen::Index lobe) {
  const double* x = u.data() + kShape * lobe;
  SelShape shape;
  shape.alpha_x = 1 / (1 + std::exp(-x[0]));
  shape.alpha_y = shape.alpha_x * std::exp(-x[1] * x[1]);
  shape.offset_in = x[2];
  shape.offset_across = x[3];
  shape.psi = x[4];
  return shape;
}

class Objective {
 public:
  Objective(const SelSamples& samples, std::size_t lobes, const SelSliceOptions& options,
            const std::vector<SelPull>& pulls)
      : samples_(samples),
        options_(options),
        pulls_(pulls),
        lobes_(static_cast<Eigen::Index>(lobes)),
        channels_(static_cast<Eigen::Index>(samples.channels())),
        target_(samples.channels(), std::vector<double>(samples.size())) {
    for (std::size_t c = 0; c < samples.channels(); ++c) {
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const double m = samples.f_r[c][i];
        target_[c][i] = Transform1(options.metric, m, samples.cos_i[i], m).value;
      }
    }
  }

  Eigen::Index size() const { return kShape * lobes_ + (lobes_ + 1) * channels_; }
  Eigen::Index Amplitude(Eigen::Index lobe, Eigen::Index channel) const {
    return kShape * lobes_ + lobe * channels_ + channel;
  }
  Eigen::Index Constant(Eigen::Index channel) const { return Amplitude(lobes_, channel); }

  Coordinates From(const SelSlice& slice) const {
    Coordinates u(size());
    for (Eigen::Index l = 0; l < lobes_; ++l) {
      const SelShape& shape = slice.lobes[static_cast<std::size_t>(l)];
      const double alpha = std::clamp(shape.alpha_x, 1e-3, 0.999);
      u(kShape * l) = std::log(alpha / (1 - alpha));
      u(kShape * l + 1) = std::sqrt(std::max(0.0, std::log(shape.alpha_x / shape.alpha_y)));
      u(kShape * l + 2) = shape.offset_in;
      u(kShape * l + 3) = shape.offset_across;
      u(kShape * l + 4) = shape.psi;
      for (Eigen::Index c = 0; c < channels_; ++c)
        u(Amplitude(l, c)) = std::log(slice.amplitude[static_cast<std::size_t>(l)][static_cast<std::size_t>(c)]);
    }
    for (Eigen::Index c = 0; c < channels_; ++c) u(Constant(c)) = std::log(slice.constant[static_cast<std::size_t>(c)]);
    return Clamped(u);
  }

  Coordinates Clamped(Coordinates u) const {
    for (Eigen::Index k = 0; k < size(); ++k) u(k) = std::clamp(u(k), Low(k), High(k));
    return u;
  }

  // Takes coordinates that the descent presses against a limit out of the step, so that the others go on at full speed.
  void Hold(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
    for (Eigen::Index k = 0; k < size(); ++k) {
      const bool held = (u(k) <= Low(k) && (*gradient)(k) > 0) || (u(k) >= High(k) && (*gradient)(k) < 0);
      if (!held) continue;
      hessian->row(k).setZero();
      hessian->col(k).setZero();
      (*gradient)(k) = 0;
    }
  }

  SelSlice ToSlice(const Coordinates& u) const {
    SelSlice slice;
    for (Eigen::Index l = 0; l < lobes_; ++l) {
      SelShape shape = ShapeAt(u, l);
      shape.psi = std::remainder(shape.psi, kPi);
      slice.lobes.push_back(shape);
      slice.amplitude.emplace_back();
      for (Eigen::Index c = 0; c < channels_; ++c) slice.amplitude.back().push_back(std::exp(u(Amplitude(l, c))));
    }
    for (Eigen::Index c = 0; c < channels_; ++c) slice.constant.push_back(std::exp(u(Constant(c))));
    return slice;
  }

  // Sum of squares; with `hessian` also J^T J and J^T r.
  double SumSquares(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
    std::vector<SelLobeInFrame> lobes;
    std::vector<SelShape> shapes;
    for (Eigen::Index l = 0; l < lobes_; ++l) {
      shapes.push_back(ShapeAt(u, l));
      lobes.emplace_back(shapes.back());
    }
    const Eigen::VectorXd linear = u.tail((lobes_ + 1) * channels_).array().exp();
    const bool wanted = hessian != nullptr;
    if (wanted) {
      hessian->setZero(size(), size());
      gradient->setZero(size());
    }
    const Eigen::Index columns = kShape * lobes_ + lobes_ + 1;
    std::vector<Eigen::Index> index(static_cast<std::size_t>(columns));
    std::vector<double> row(index.size()), k(lobes.size());
    std::vector<std::array<double, kShape>> dk(lobes.size());
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      for (std::size_t l = 0; l < lobes.size(); ++l) {
        double by[kShape];
        k[l] = lobes[l].Evaluate(samples_.v[i], wanted ? by : nullptr);
        if (!wanted) continue;
        const SelShape& shape = shapes[l];
        const double s = u(kShape * static_cast<Eigen::Index>(l) + 1);
        dk[l] = {(1 - shape.alpha_x) * (by[0] * shape.alpha_x + by[1] * shape.alpha_y), -2 * s * shape.alpha_y * by[1],
                 by[2], by[3], by[4]};
      }
      const double to_f = options_.quantity == SelQuantity::kBrdf ? 1.0 : 1 / samples_.cos_o[i];
      for (Eigen::Index c = 0; c < channels_; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        double g = linear(lobes_ * channels_ + c);
        for (Eigen::Index l = 0; l < lobes_; ++l) g += linear(l * channels_ + c) * k[static_cast<std::size_t>(l)];
        const Transformed model = Transform1(options_.metric, g * to_f, samples_.cos_i[i], samples_.f_r[channel][i]);
        const double residual = model.value - target_[channel][i], w = samples_.weight[i];
        sum += w * residual * residual;
        if (!wanted) continue;
        const double factor = model.derivative * to_f;
        std::size_t at = 0;
        for (Eigen::Index l = 0; l < lobes_; ++l) {
          const double a = linear(l * channels_ + c) * factor;
          for (Eigen::Index j = 0; j < kShape; ++j, ++at) {
            index[at] = kShape * l + j;
            row[at] = a * dk[static_cast<std::size_t>(l)][static_cast<std::size_t>(j)];
          }
          index[at] = Amplitude(l, c);
          row[at++] = a * k[static_cast<std::size_t>(l)];
        }
        index[at] = Constant(c);
        row[at] = linear(lobes_ * channels_ + c) * factor;
        for (std::size_t p = 0; p < row.size(); ++p) {
          (*gradient)(index[p]) += w * row[p] * residual;
          for (std::size_t q = 0; q < row.size(); ++q) (*hessian)(index[p], index[q]) += w * row[p] * row[q];
        }
      }
    }
    return sum;
  }

  // The pulls' part of the objective, added to hessian and gradient.
  double Pulls(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
    double sum = 0;
    for (const SelPull& pull : pulls_) {
      for (Eigen::Index l = 0; l < lobes_; ++l) {
        const SelShape shape = ShapeAt(u, l), &other = (*pull.shapes)[static_cast<std::size_t>(l)];
        const Features mine = FeaturesOf(shape), theirs = FeaturesOf(other);
        const double s = u(kShape * l + 1), cosine = std::cos(2 * shape.psi), sine = std::sin(2 * shape.psi);
        // d(features) / d(t, s, offsets, psi).
        const double jacobian[5][kShape] = {{1 - shape.alpha_x, -s, 0, 0, 0},
                                            {0, s * cosine, 0, 0, -s * s * sine},
                                            {0, s * sine, 0, 0, s * s * cosine},
                                            {0, 0, 1, 0, 0},
                                            {0, 0, 0, 1, 0}};
        for (std::size_t f = 0; f < 5; ++f) {
          const double difference = mine[f] - theirs[f];
          sum += pull.weight * difference * difference;
          if (hessian == nullptr) continue;
          for (Eigen::Index p = 0; p < kShape; ++p) {
            (*gradient)(kShape * l + p) += pull.weight * jacobian[f][p] * difference;
            for (Eigen::Index q = 0; q < kShape; ++q)
              (*hessian)(kShape * l + p, kShape * l + q) += pull.weight * jacobian[f][p] * jacobian[f][q];
          }
        }
      }
    }
    return sum;
  }

 private:
  double High(Eigen::Index k) const {
    if (k >= kShape * lobes_) return kMaxLog;
    constexpr double kHigh[kShape] = {kMaxT, kMaxS, kMaxOffset, kMaxOffset, 1e9};
    return kHigh[k % kShape];
  }
  double Low(Eigen::Index k) const { return k >= kShape * lobes_ ? kMinLog : -High(k); }

  using Features = std::array<double, 5>;
  static Features FeaturesOf(const SelShape& shape) {
    const double x = std::log(shape.alpha_x), y = std::log(shape.alpha_y), half = 0.5 * (x - y);
    return {0.5 * (x + y), half * std::cos(2 * shape.psi), half * std::sin(2 * shape.psi), shape.offset_in,
            shape.offset_across};
  }

  const SelSamples& samples_;
  const SelSliceOptions& options_;
  const std::vector<SelPull>& pulls_;
  Eigen::Index lobes_, channels_;
  std::vector<std::vector<double>> target_;
};

// Least and largest g of the samples in a channel, the least made positive.
std::pair<double, double> ValueRange(const SelSamples& samples, SelQuantity quantity, std::size_t channel) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    low = std::min(low, samples.Value(quantity, channel, i));
    high = std::max(high, samples.Value(quantity, channel, i));
  }
  high = std::max(high, 1e-12);
  return {std::max(low, 1e-4 * high), high};
}

// Amplitudes and constants from which a descent with these shapes begins.
SelSlice WithLinearStarts(const SelSamples& samples, SelQuantity quantity, const std::vector<SelShape>& shapes) {
  SelSlice slice;
  slice.lobes = shapes;
  slice.amplitude.resize(shapes.size());
  for (std::size_t c = 0; c < samples.channels(); ++c) {
    const auto [low, high] = ValueRange(samples, quantity, c);
    slice.constant.push_back(low);
    for (std::size_t l = 0; l < shapes.size(); ++l)
      slice.amplitude[l].push_back(high * shapes[0].alpha_x / shapes[l].alpha_x);
  }
  return slice;
}

// Every choice of `lobes` of the shapes, in their order.
std::vector<std::vector<SelShape>> Choices(const std::vector<SelShape>& shapes, std::size_t lobes, std::size_t first) {
  if (lobes == 0) return {{}};
  std::vector<std::vector<SelShape>> choices;
  for (std::size_t k = first; k < shapes.size(); ++k) {
    for (std::vector<SelShape> rest : Choices(shapes, lobes - 1, k + 1)) {
      rest.insert(rest.begin(), shapes[k]);
      choices.push_back(rest);
    }
  }
  return choices;
}

constexpr double kStartAlphas[] = {0.015, 0.04, 0.1, 0.25, 0.6};

// Shapes to start one lobe from: the aspect of a mirror lobe, 1 to cos_theta_i, and wider and narrower ones at four
// orientations.
std::vector<SelShape> SingleStarts(double theta_i) {
  std::vector<SelShape> shapes;
  const double aspect = std::clamp(std::cos(theta_i), 0.2, 0.95);
  for (const double alpha : kStartAlphas) shapes.push_back({alpha, alpha * aspect, 0, 0, 0});
  for (const double alpha : {0.06, 0.3}) {
    for (const double psi : {0.0, kPi / 4, kPi / 2, -kPi / 4}) shapes.push_back({alpha, alpha / 3, 0, 0, psi});
  }
  return shapes;
}

void SortNarrowFirst(SelSlice* slice) {
  std::vector<std::size_t> order(slice->lobes.size());
  for (std::size_t l = 0; l < order.size(); ++l) order[l] = l;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return slice->lobes[a].alpha_x * slice->lobes[a].alpha_y < slice->lobes[b].alpha_x * slice->lobes[b].alpha_y;
  });
  SelSlice sorted = *slice;
  for (std::size_t l = 0; l < order.size(); ++l) {
    sorted.lobes[l] = slice->lobes[order[l]];
    sorted.amplitude[l] = slice->amplitude[order[l]];
  }
  *slice = sorted;
}

// The best of a few steps from each start.
SelSliceFit BestTrial(const SelSamples& samples, const std::vector<std::vector<SelShape>>& starts,
                      SelSliceOptions options) {
  options.max_iterations = 15;
  SelSliceFit best;
  best.objective = std::numeric_limits<double>::infinity();
  for (const std::vector<SelShape>& shapes : starts) {
    const SelSliceFit trial = FitSelSlice(samples, WithLinearStarts(samples, options.quantity, shapes), options);
    if (trial.objective < best.objective) best = trial;
  }
  return best;
}

}  // namespace

SelSamples SelSamples::Subset(const std::vector<std::size_t>& indices) const {
  SelSamples subset;
  subset.f_r.resize(channels());
  for (const std::size_t i : indices) {
    subset.v.push_back(v[i]);
    subset.cos_i.push_back(cos_i[i]);
    subset.cos_o.push_back(cos_o[i]);
    subset.weight.push_back(weight[i]);
    for (std::size_t c = 0; c < channels(); ++c) subset.f_r[c].push_back(f_r[c][i]);
  }
  return subset;
}

SelSamples SelSamples::Mean() const {
  SelSamples mean = *this;
  mean.f_r.assign(1, std::vector<double>(size(), 0.0));
  for (const std::vector<double>& values : f_r) {
    for (std::size_t i = 0; i < size(); ++i) mean.f_r[0][i] += values[i] / static_cast<double>(channels());
  }
  return mean;
}

std::size_t SelFreeParameters(std::size_t lobes, std::size_t channels) {
  return static_cast<std::size_t>(kShape) * lobes + (lobes + 1) * channels;
}

SelSliceFit FitSelSlice(const SelSamples& samples, const SelSlice& start, const SelSliceOptions& options,
                        const std::vector<SelPull>& pulls) {
  const Objective objective(samples, start.lobes.size(), options, pulls);
  Coordinates u = objective.From(start);
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  SelSliceFit fit;
  fit.sum_squares = objective.SumSquares(u, &hessian, &gradient);
  fit.objective = fit.sum_squares + objective.Pulls(u, &hessian, &gradient);
  double damping = 1e-3;
  // Marquardt's scaling, with a floor for coordinates that nothing depends on.
  while (fit.iterations < options.max_iterations && !fit.converged && damping < 1e12) {
    ++fit.iterations;
    Eigen::MatrixXd damped = hessian;
    Eigen::VectorXd slope = gradient;
    objective.Hold(u, &damped, &slope);
    const double floor = 1e-12 * std::max(hessian.diagonal().maxCoeff(), 1e-300);
    damped.diagonal() += damping * damped.diagonal().cwiseMax(floor).eval();
    damped.diagonal().array() += floor;
    const Coordinates next = objective.Clamped(u - damped.ldlt().solve(slope));
    const double sum_squares = objective.SumSquares(next, nullptr, nullptr);
    const double value = sum_squares + objective.Pulls(next, nullptr, nullptr);
    if (!(value <= fit.objective)) {
      // A rejected step of no length: this is the minimum to rounding.
      if ((next - u).norm() <= 1e-10 * (1 + u.norm())) fit.converged = true;
      damping *= 8;
      continue;
    }
    fit.converged = fit.objective - value <= 1e-7 * fit.objective;
    u = next;
    damping = std::max(damping / 5, 1e-12);
    fit.sum_squares = objective.SumSquares(u, &hessian, &gradient);
    fit.objective = fit.sum_squares + objective.Pulls(u, &hessian, &gradient);
  }
  fit.slice = objective.ToSlice(u);
  fit.slice.theta_i = start.theta_i;
  fit.slice.phi_i = start.phi_i;
  return fit;
}

SelSliceFit SearchSelSlice(const SelSamples& samples, double theta_i, std::size_t lobes, const SelSliceOptions& options,
                           std::size_t subsample) {
  const SelSamples few = samples.Subset(StratifiedSubsample(samples.size(), subsample, 1)).Mean();
  const std::vector<SelShape> singles = SingleStarts(theta_i);
  SelSliceFit best = BestTrial(few, Choices(singles, 1, 0), options);
  if (lobes > 1) {
    // Narrower and wider copies of the best single lobe, and the grid of mirror lobes.
    std::vector<SelShape> copies;
    for (const double factor : {0.25, 0.5, 1.0, 2.0, 4.0}) {
      SelShape shape = best.slice.lobes[0];
      shape.alpha_x = std::min(0.9, factor * shape.alpha_x);
      shape.alpha_y = std::min(shape.alpha_x, factor * shape.alpha_y);
      copies.push_back(shape);
    }
    std::vector<std::vector<SelShape>> starts = Choices(copies, lobes, 0);
    const std::vector<SelShape> mirror(singles.begin(), singles.begin() + std::size(kStartAlphas));
    for (const std::vector<SelShape>& choice : Choices(mirror, lobes, 0)) starts.push_back(choice);
    best = BestTrial(few, starts, options);
  }
  // From the mean of the channels to all of them.
  SelSlice start = best.slice;
  for (std::vector<double>& amplitude : start.amplitude) amplitude.resize(samples.channels(), amplitude[0]);
  start.constant.resize(samples.channels(), start.constant[0]);
  SelSliceFit fit = FitSelSlice(samples, start, options);
  SortNarrowFirst(&fit.slice);
  return fit;
}

}  // namespace lobefit

#include "lobefit/fit/inference/noisy_loss.h"

#include <cmath>

namespace lobefit {
namespace {

constexpr double kMostStandardDeviations = 6, kMostCounts = 30, kLeastProbability = 1e-10;

// Readings with their probabilities, not normalised.
struct Readings {
  std::vector<double> m, probability;
  void Add(double reading, double weight) {
    m.push_back(reading);
    probability.push_back(weight);
  }
};

// Calls each(z, weight) at equal steps over the normal distribution: the error falls faster than any power of the step.
template <class Each>
void ForNormal(double step, const Each& each) {
  const int most = static_cast<int>(kMostStandardDeviations / step);
  for (int k = -most; k <= most; ++k) each(k * step, std::exp(-0.5 * k * step * k * step));
}

void AddContinuous(double v, double deviation, double skewness, Readings* readings) {
  ForNormal(0.1,
            [&](double z, double weight) { readings->Add(v + deviation * (z + skewness / 6 * (z * z - 1)), weight); });
}

void AddCounts(double counts, double of_one, double deviation, Readings* readings) {
  const int most = static_cast<int>(counts + 8 * std::sqrt(counts) + 8);
  double probability = std::exp(-counts);
  for (int n = 0; n <= most; probability *= counts / ++n) {
    if (probability < kLeastProbability) continue;
    ForNormal(0.5, [&](double z, double weight) { readings->Add(n * of_one + deviation * z, probability * weight); });
  }
}

}  // namespace

NoisyLoss::Spread NoisyLoss::Residuals(double v, double root) const {
  const double rest = std::sqrt(noise_.floor * noise_.floor + noise_.relative * noise_.relative * v * v);
  const double counts = noise_.poisson > 0 && v > 0 ? v / noise_.poisson : 0;
  Readings readings;
  if (counts > 0 && counts <= kMostCounts) {
    AddCounts(counts, noise_.poisson, rest, &readings);
  } else {
    const double deviation = std::sqrt(noise_.VarianceAt(v));
    const double third = counts > 0 ? noise_.poisson * noise_.poisson * v : 0;
    AddContinuous(v, deviation, third > 0 ? third / (deviation * deviation * deviation) : 0, &readings);
  }
  const std::size_t count = readings.m.size();
  const std::vector<double> model(count, v), one(count, 1.0), roots(count, root);
  Spread spread;
  spread.residual.resize(count);
  spread.slope.resize(count);
  lobefit::Residuals(transform_, model.data(), one.data(), readings.m.data(), roots.data(), count,
                     spread.residual.data(), spread.slope.data());
  double none = 0, at_model = 1;
  lobefit::Residuals(transform_, &v, one.data(), &v, &root, 1, &none, &at_model);
  for (double& slope : spread.slope) slope = slope == at_model ? 1 : slope / at_model;
  spread.probability = std::move(readings.probability);
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    // Readings that the metric has no number for are set aside before a fit.
    if (!Takes(transform_, readings.m[k], 1)) spread.probability[k] = spread.residual[k] = spread.slope[k] = 0;
    sum += spread.probability[k];
  }
  for (std::size_t k = 0; k < count; ++k) {
    spread.probability[k] = sum > 0 ? spread.probability[k] / sum : 0;
    spread.mean_square += spread.probability[k] * spread.residual[k] * spread.residual[k];
  }
  return spread;
}

std::vector<MeanScore> NoisyLoss::Evaluate(const std::vector<double>& v, double root) const {
  std::vector<Spread> spreads;
  double squares = 0;
  for (const double value : v) {
    spreads.push_back(Residuals(value, root));
    squares += spreads.back().mean_square;
  }
  std::vector<MeanScore> means(v.size());
  for (std::size_t c = 0; c < v.size(); ++c) {
    const Spread& spread = spreads[c];
    // Rounding must not bring the others' squares below 0.
    const double others = v.size() == 1 ? 0 : std::fmax(0.0, squares - spread.mean_square);
    for (std::size_t k = 0; k < spread.residual.size(); ++k) {
      const double r = spread.residual[k], s = spread.slope[k];
      const LossValue rho = EvaluateLoss(loss_, scale_, others + r * r);
      means[c].score += spread.probability[k] * rho.first * r * s;
      means[c].curvature += spread.probability[k] * (rho.first + 2 * rho.second * r * r) * s * s;
    }
  }
  return means;
}

}  // namespace lobefit

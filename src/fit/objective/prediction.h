// What a material says of the samples of a measurement, and how far off it is: for materials of every kind, fitted here
// or not.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// f_r[channel][sample], 1/sr, as the material's instrument would read it, if it has one (Reading, without gains). The
// result does not depend on the number of threads.
std::vector<std::vector<double>> Predict(const Material& material, const Samples& samples, ThreadPool* pool);

// Sums over samples and channels; samples that a metric has no number for (relative: measured f_r <= 0) do not count.
struct SquareSum {
  double square = 0;  // of weight times squared residual
  double weight = 0;
  std::size_t residuals = 0;

  double MeanSquare() const { return square / weight; }  // NaN where nothing was counted
};

// Weight of a sample's squared residual: the samples' own (where `own_weights`), its solid angle, and what belongs to
// the metric (sines of ngan and low-log).
double SampleWeight(Metric metric, Weighting weighting, bool own_weights, const Samples& samples, std::size_t i);

// Squared residuals of a prediction under a metric, so weighted; own weights with those of stated uncertainties, at the
// readings.
SquareSum SumSquares(Metric metric, const NoiseModel& noise, Weighting weighting, bool own_weights,
                     const Samples& samples, const std::vector<std::vector<double>>& f_r);

// f_r[channel][sample - begin] of a model at the samples [begin, end); safe from several threads.
using PredictPiece = std::function<void(std::size_t begin, std::size_t end, std::vector<std::vector<double>>* f_r)>;

// Root mean square under every metric, as in Material::errors (without the samples' own weights), piece by piece: no
// memory beside the samples, and no dependence on the number of threads. Metrics that need the noise are left out where
// none is known.
std::vector<MetricError> ErrorsUnderAllMetrics(const NoiseModel& noise, Weighting weighting, const Samples& samples,
                                               const PredictPiece& predict, ThreadPool* pool);
// The same for a prediction that is there already.
std::vector<MetricError> ErrorsUnderAllMetrics(const NoiseModel& noise, Weighting weighting, const Samples& samples,
                                               const std::vector<std::vector<double>>& f_r, ThreadPool* pool);

}  // namespace lobefit

// Squared ellipsoidal lobes fitted to the samples of one incident direction (sel_table.h).
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/core/sel/sel_table.h"
#include "lobefit/fit/metric/transform.h"
#include "lobefit/fit/sel/samples.h"

namespace lobefit {

// A neighbouring slice that the shapes are drawn to: `weight` times the squared differences of the mean logarithm of
// the widths, of the anisotropy as a vector of angle 2 psi, and of the offsets, is added to the sum of squares.
struct SelPull {
  const std::vector<SelShape>* shapes;
  double weight;
};

struct SelSliceOptions {
  Transform transform;  // of the metric
  SelQuantity quantity = SelQuantity::kBrdfCosineO;
  // Flat valleys between two lobes of nearly equal widths take 100 to 300 steps.
  int max_iterations = 400;
};

struct SelSliceFit {
  SelSlice slice;
  double sum_squares = 0;  // weighted, of the residuals
  double objective = 0;    // sum_squares and the pulls
  bool converged = false;
  bool at_limit = false;  // a width, offset or amplitude stands at its limit (objective.h)
  int iterations = 0;
};

// Levenberg-Marquardt from `start` with analytic derivatives. The objective never grows.
SelSliceFit FitSelSlice(const SelSamples& samples, const SelSlice& start, const SelSliceOptions& options,
                        const std::vector<SelPull>& pulls = {});

// Fits `lobes` lobes from a grid of shapes, ranked by a few steps each on the mean of the channels and at most
// `subsample` samples. Lobes come narrowest first.
SelSliceFit SearchSelSlice(const SelSamples& samples, double theta_i, std::size_t lobes, const SelSliceOptions& options,
                           std::size_t subsample = 300);

// Numbers of one slice that a fit moves.
std::size_t SelFreeParameters(std::size_t lobes, std::size_t channels);

}  // namespace lobefit

// Squared ellipsoidal lobes fitted to the samples of one incident direction (sel_table.h).
//
// Coordinates of the descent, none with a bound: per lobe t with alpha_x = 1 / (1 + exp(-t)), s with alpha_y = alpha_x
// exp(-s^2), the two offsets, psi; then ln amplitude and ln constant a channel. So alpha_y <= alpha_x always, the kink
// of the lobe at equal alphas (sel.h) is reached at s = 0 and never crossed, and amplitudes stay positive.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/core/sel_table.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// Samples of one incident direction, in the mirror frame of their own wi.
struct SelSamples {
  std::vector<Vec3> v;
  std::vector<double> cos_i, cos_o;
  std::vector<double> weight;            // of the squared residual
  std::vector<std::vector<double>> f_r;  // [channel][sample]

  std::size_t size() const { return v.size(); }
  std::size_t channels() const { return f_r.size(); }
  // g of a sample: f_r, or f_r cos_theta_o.
  double Value(SelQuantity quantity, std::size_t channel, std::size_t i) const {
    return quantity == SelQuantity::kBrdf ? f_r[channel][i] : f_r[channel][i] * cos_o[i];
  }
  SelSamples Subset(const std::vector<std::size_t>& indices) const;
  // One channel, the mean of all.
  SelSamples Mean() const;
};

// A neighbouring slice that the shapes are drawn to: `weight` times the squared differences of the mean logarithm of
// the widths, of the anisotropy as a vector of angle 2 psi, and of the offsets, is added to the sum of squares.
struct SelPull {
  const std::vector<SelShape>* shapes;
  double weight;
};

struct SelSliceOptions {
  Metric metric = Metric::kLog;
  SelQuantity quantity = SelQuantity::kBrdfCosineO;
  int max_iterations = 100;
};

struct SelSliceFit {
  SelSlice slice;
  double sum_squares = 0;  // weighted, of the residuals
  double objective = 0;    // sum_squares and the pulls
  bool converged = false;
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

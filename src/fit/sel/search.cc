#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/fit/search/starts.h"
#include "lobefit/fit/sel/slice.h"

namespace lobefit {
namespace {

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

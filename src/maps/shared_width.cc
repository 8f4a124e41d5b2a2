#include "lobefit/maps/shared_width.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/parallel.h"
#include "lobefit/base/progress.h"
#include "lobefit/maps/stack/geometry.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostTexels = 4096, kPieces = 64;
constexpr int kMostSteps = 12;

struct GridTexel {
  std::size_t index = 0;
  std::vector<float> values;  // [channel lights + light]
};
std::vector<GridTexel> GridTexels(const Stack& stack, const FittedLights& lights) {
  std::size_t step = 1;
  while (stack.Texels() / (step * step) > kMostTexels) ++step;
  std::vector<GridTexel> texels;
  StackReader reader(stack);
  Progress progress("reading a grid of texels", stack.height);
  for (std::size_t y = step / 2; y < stack.height; y += step) {
    const StackBand band = reader.Read(y, 1);
    for (std::size_t x = step / 2; x < stack.width; x += step) {
      if (!stack.Holds(y * stack.width + x)) continue;
      texels.push_back({y * stack.width + x, std::vector<float>(stack.channels * lights.index.size())});
      Gather(band, x, stack.channels, lights, stack.lights.size(), texels.back().values.data());
    }
    progress.Advance(std::min(step, stack.height - y));
  }
  return texels;
}

struct Sums {
  double slope = 0, square = 0, curvature = 0;
  std::size_t texels = 0;
};

}  // namespace

SharedWidth EstimateSharedWidth(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, int threads) {
  const std::vector<GridTexel> texels = GridTexels(stack, lights);
  const std::size_t count = lights.index.size();
  // One sum a piece, added in their order: the same bits on any number of threads.
  const auto visit = [&](double log_alpha, std::vector<double>* widths) {
    std::vector<Sums> pieces(kPieces);
    std::vector<std::vector<double>> found(kPieces);
    ParallelFor(kPieces, threads, [&](std::size_t piece) {
      TexelFitter fitter(recipe.rules, lights.directions, static_cast<int>(stack.channels));
      std::vector<Vec3> directions;
      for (std::size_t t = piece * texels.size() / kPieces; t < (piece + 1) * texels.size() / kPieces; ++t) {
        if (stack.near) {
          DirectionsAt(stack, lights.index, texels[t].index, &directions);
          fitter.MoveLights(directions);
        }
        const TexelFit fit = fitter.Fit(texels[t].values.data(), count, log_alpha);
        double slope, curvature;
        if (fitter.ProfileOfLastFit(&slope, &curvature)) {
          Sums& s = pieces[piece];
          s.slope += slope, s.square += slope * slope, s.curvature += curvature, ++s.texels;
        }
        if (std::isfinite(fit.alpha_x)) found[piece].push_back(std::log(fit.alpha_x));
      }
    });
    Sums all;
    for (std::size_t p = 0; p < kPieces; ++p) {
      all.slope += pieces[p].slope, all.square += pieces[p].square, all.curvature += pieces[p].curvature;
      all.texels += pieces[p].texels;
      if (widths != nullptr) widths->insert(widths->end(), found[p].begin(), found[p].end());
    }
    return all;
  };
  std::vector<double> widths;
  visit(kNan, &widths);
  SharedWidth shared;
  if (widths.empty()) return shared;
  std::nth_element(widths.begin(), widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2), widths.end());
  shared.log_alpha = widths[widths.size() / 2];
  for (int step = 0; step < kMostSteps; ++step) {
    const Sums sums = visit(shared.log_alpha, nullptr);
    if (sums.texels == 0) break;
    shared.texels = sums.texels;
    shared.error = std::sqrt(sums.square) / sums.curvature;
    const double move = std::clamp(-sums.slope / sums.curvature, -0.3, 0.3);
    shared.log_alpha =
        std::clamp(shared.log_alpha + move, std::log(recipe.rules.least_alpha), std::log(recipe.rules.most_alpha));
    if (std::fabs(move) < 0.02 * shared.error || std::fabs(move) < 1e-9) break;
  }
  return shared;
}

}  // namespace lobefit

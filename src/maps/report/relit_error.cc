#include "lobefit/maps/report/relit_error.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/process/progress.h"
#include "lobefit/maps/bands.h"
#include "lobefit/maps/stack/geometry.h"
#include "lobefit/maps/stack/reader.h"

namespace lobefit {
namespace {

// Lights of a stack as a texel sees them.
class RelitStack {
 public:
  RelitStack(const Maps& maps, const Stack& stack, const Fallback& fallback)
      : stack_(stack), relighting_(maps, {DirectionsOf(stack), {}}, stack.calibrated, fallback) {
    for (std::size_t l = 0; l < stack.lights.size(); ++l) all_.push_back(l);
  }
  void Texel(std::size_t texel, double* values, std::size_t stride) {
    if (stack_.MovesPaths()) {
      PathsAt(stack_, all_, texel, &paths_);
      relighting_.Move(paths_);
    }
    relighting_.Texel(texel, values, stride);
  }

 private:
  static std::vector<Vec3> DirectionsOf(const Stack& stack) {
    std::vector<Vec3> directions;
    for (const StackLight& light : stack.lights) directions.push_back(light.direction);
    return directions;
  }

  const Stack& stack_;
  Relighting relighting_;
  std::vector<std::size_t> all_;
  LightPaths paths_;
};

}  // namespace

Judgement JudgeLights(const Maps& maps, const Stack& stack, const std::vector<std::size_t>& left_out,
                      const Fallback& fallback) {
  const std::size_t lights = stack.lights.size(), channels = stack.channels;
  RelitStack relighting(maps, stack, fallback);
  std::vector<double> squares(lights), counts(lights), fit(channels * lights);
  std::vector<float> bright;
  const FittedLights fitted = LightsWithout(stack, left_out);
  DoubtMeter doubts(fitted.directions, stack.calibrated, maps.channels);
  std::vector<double> sums(fitted.index.size());
  StackReader reader(stack);
  Progress progress("relighting", stack.height);
  const std::size_t rows = RowsOfBand(stack);
  for (std::size_t first = 0; first < stack.height; first += rows) {
    const StackBand band = reader.Read(first, std::min(rows, stack.height - first));
    for (std::size_t t = 0; t < band.rows * stack.width; ++t) {
      const std::size_t texel = first * stack.width + t;
      if (!stack.Holds(texel)) continue;
      relighting.Texel(texel, fit.data(), lights);
      if (std::isnan(fit[0])) continue;
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t l = 0; l < lights; ++l) {
          const float value = band.values[(t * channels + c) * lights + l];
          if (!std::isfinite(value)) continue;
          const double difference = static_cast<double>(value) - fit[c * lights + l];
          squares[l] += difference * difference, counts[l] += 1;
          // A sample of all, for the percentile.
          if ((texel * 7 + l) % 61 == 0) bright.push_back(value);
        }
      }
      for (std::size_t k = 0; k < fitted.index.size(); ++k) {
        sums[k] = 0;
        for (std::size_t c = 0; c < channels; ++c) {
          sums[k] += static_cast<double>(band.values[(t * channels + c) * lights + fitted.index[k]]);
        }
      }
      const double width = static_cast<double>(stack.width);
      const double x = (static_cast<double>(texel % stack.width) + 0.5) / width - 0.5;
      const double y =
          (0.5 * static_cast<double>(stack.height) - static_cast<double>(texel / stack.width) - 0.5) / width;
      doubts.Add(sums, RelitTexelAt(maps, texel, fallback), x, y);
    }
    progress.Advance(band.rows);
  }
  double peak = kNan;
  if (!bright.empty()) {
    const auto at = bright.begin() + static_cast<std::ptrdiff_t>((bright.size() - 1) * 999 / 1000);
    std::nth_element(bright.begin(), at, bright.end());
    peak = static_cast<double>(*at);
  }
  Judgement judgement;
  judgement.doubts = doubts.Result();
  // Gathered with distant lights and camera.
  if (stack.MovesPaths()) judgement.doubts = {};
  for (std::size_t l = 0; l < lights; ++l) {
    const bool is_fitted = std::find(left_out.begin(), left_out.end(), l) == left_out.end();
    judgement.lights.push_back({l, is_fitted, 10 * std::log10(peak * peak * counts[l] / squares[l])});
  }
  return judgement;
}

RelitPair Relit(const Maps& maps, const Stack& stack, std::size_t light, const Fallback& fallback) {
  Stack one = stack;
  one.images = {stack.images[light]}, one.lights = {stack.lights[light]};
  if (!stack.parts.empty()) one.parts = {stack.parts[light]};
  if (!stack.white.empty()) one.white = {stack.white[light]};
  if (stack.cameras.size() > 1) one.cameras = {stack.cameras[light]};
  RelitStack relighting(maps, one, fallback);
  StackReader reader(one);
  RelitPair pair;
  pair.photograph = reader.Read(0, one.height).values;
  pair.fit.resize(pair.photograph.size());
  for (std::size_t t = 0; t < one.width * one.height; ++t) {
    double values[kMostChannels];
    relighting.Texel(t, values, 1);
    // Over a white board the light's fall has dropped out.
    const double irradiance = one.white.empty() ? IrradianceAt(one, 0, t) : 1;
    for (std::size_t c = 0; c < one.channels; ++c) {
      pair.fit[t * one.channels + c] = static_cast<float>(one.Holds(t) ? irradiance * values[c] : kNan);
      pair.photograph[t * one.channels + c] *= static_cast<float>(irradiance);
      if (!one.Holds(t)) pair.photograph[t * one.channels + c] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return pair;
}

}  // namespace lobefit

#include "lobefit/maps/report/relit_error.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/progress.h"
#include "lobefit/maps/bands.h"
#include "lobefit/maps/stack/reader.h"

namespace lobefit {
namespace {

std::vector<Vec3> DirectionsOf(const Stack& stack) {
  std::vector<Vec3> directions;
  for (const StackLight& light : stack.lights) directions.push_back(light.direction);
  return directions;
}

}  // namespace

std::vector<RelitLight> JudgeLights(const Maps& maps, const Stack& stack, const std::vector<std::size_t>& left_out,
                                    const Fallback& fallback) {
  const std::size_t lights = stack.lights.size(), channels = stack.channels;
  Relighting relighting(maps, DirectionsOf(stack), stack.calibrated, fallback);
  std::vector<double> squares(lights), counts(lights), fit(channels * lights);
  std::vector<float> bright;
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
    }
    progress.Advance(band.rows);
  }
  double peak = kNan;
  if (!bright.empty()) {
    const auto at = bright.begin() + static_cast<std::ptrdiff_t>((bright.size() - 1) * 999 / 1000);
    std::nth_element(bright.begin(), at, bright.end());
    peak = static_cast<double>(*at);
  }
  std::vector<RelitLight> judged;
  for (std::size_t l = 0; l < lights; ++l) {
    const bool fitted = std::find(left_out.begin(), left_out.end(), l) == left_out.end();
    judged.push_back({l, fitted, 10 * std::log10(peak * peak * counts[l] / squares[l])});
  }
  return judged;
}

RelitPair Relit(const Maps& maps, const Stack& stack, std::size_t light, const Fallback& fallback) {
  Stack one = stack;
  one.images = {stack.images[light]}, one.lights = {stack.lights[light]};
  Relighting relighting(maps, DirectionsOf(one), stack.calibrated, fallback);
  StackReader reader(one);
  RelitPair pair;
  pair.photograph = reader.Read(0, one.height).values;
  pair.fit.resize(pair.photograph.size());
  for (std::size_t t = 0; t < one.width * one.height; ++t) {
    double values[kMostChannels];
    relighting.Texel(t, values, 1);
    for (std::size_t c = 0; c < one.channels; ++c) {
      pair.fit[t * one.channels + c] = static_cast<float>(one.Holds(t) ? values[c] : kNan);
      if (!one.Holds(t)) pair.photograph[t * one.channels + c] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return pair;
}

}  // namespace lobefit

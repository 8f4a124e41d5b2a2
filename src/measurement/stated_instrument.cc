#include "lobefit/measurement/stated_instrument.h"

#include <algorithm>

#include "lobefit/base/text/text.h"

namespace lobefit {

std::optional<StatedDrift> ParseDrift(std::string_view word) {
  if (word == "auto") return StatedDrift{};
  const std::optional<double> sd = ParseDouble(word);
  if (!(sd && *sd > 0 && *sd <= 1)) return std::nullopt;
  return StatedDrift{sd};
}

std::optional<StatedNoise> ParseNoiseModel(std::string_view words) {
  StatedNoise noise;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(','), words.size());
    const std::string_view term = words.substr(0, end);
    words.remove_prefix(std::min(words.size(), end + 1));
    const std::size_t equals = term.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const std::string_view name = Trim(term.substr(0, equals));
    const std::optional<double> value = ParseDouble(Trim(term.substr(equals + 1)));
    if (!value || !(*value >= 0)) return std::nullopt;
    if (name == "floor") {
      noise.floor = *value;
    } else if (name == "relative") {
      noise.relative = *value;
    } else if (name == "poisson") {
      noise.poisson = *value;
    } else {
      return std::nullopt;
    }
  }
  const bool known = (noise.floor > 0 || noise.poisson > 0) && noise.relative > 0 && noise.relative <= 1;
  return known ? std::optional(noise) : std::nullopt;
}

}  // namespace lobefit

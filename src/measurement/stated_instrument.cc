#include "lobefit/measurement/stated_instrument.h"

#include <algorithm>
#include <cmath>

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
    double* const known = name == "floor"      ? &noise.floor
                          : name == "relative" ? &noise.relative
                          : name == "poisson"  ? &noise.poisson
                                               : nullptr;
    // Twice the same term: one of them would be passed over.
    if (known == nullptr || *known > 0 || !value || !(*value >= 0) || !std::isfinite(*value)) return std::nullopt;
    *known = *value;
  }
  const bool complete = (noise.floor > 0 || noise.poisson > 0) && noise.relative > 0 && noise.relative <= 1;
  return complete ? std::optional(noise) : std::nullopt;
}

}  // namespace lobefit

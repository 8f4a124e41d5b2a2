// Numbers on the command line.
#pragma once

#include <cmath>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "lobefit/base/text/text.h"

namespace lobefit {

// A number in [low, high]; "nan", which CLI::Range lets pass, is not one.
inline CLI::Validator Within(double low, double high) {
  // Angles come from radians: 29.999999999999996 degrees are 30.
  const std::string range = fmt::format("[{:.9g} - {:.9g}]", low, high);
  const double most = high + 1e-12 * std::abs(high);
  return {[=](const std::string& text) {
            const std::optional<double> value = ParseDouble(text);
            return value && *value >= low && *value <= most
                       ? std::string()
                       : fmt::format("'{}' is no number in {}", Excerpt(text), range);
          },
          "FLOAT in " + range};
}

}  // namespace lobefit

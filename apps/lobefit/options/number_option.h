// Numbers on the command line.
#pragma once

#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "lobefit/base/text.h"

namespace lobefit {

// A number in [low, high]; "nan", which CLI::Range lets pass, is not one.
inline CLI::Validator Within(double low, double high) {
  const std::string range = fmt::format("[{} - {}]", low, high);
  return {[=](const std::string& text) {
            const std::optional<double> value = ParseDouble(text);
            return value && *value >= low && *value <= high
                       ? std::string()
                       : fmt::format("'{}' is no number in {}", Excerpt(text), range);
          },
          "FLOAT in " + range};
}

}  // namespace lobefit

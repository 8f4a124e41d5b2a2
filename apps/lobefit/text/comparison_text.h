// A comparison of models as text for people and as a JSON document.
#pragma once

#include <string>

#include "lobefit/fit/compare.h"

namespace lobefit {

// What was compared, where the results lie.
struct ComparisonContext {
  std::string source, sha256, format, command, document;
};

// The table of models, the recommendation and the remarks.
std::string ComparisonText(const Comparison& comparison, const ComparisonContext& context);

// The document of src/fit/comparison.schema.json; NaN as null, angles in degrees.
std::string ComparisonJson(const Comparison& comparison, const ComparisonContext& context);

}  // namespace lobefit

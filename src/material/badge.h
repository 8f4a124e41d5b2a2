// The one line that stands beside the title of a report.
#pragma once

#include <string>

#include "lobefit/material/material.h"

namespace lobefit {

enum class BadgeMark { kGood, kRough, kBad };

struct Badge {
  BadgeMark mark = BadgeMark::kGood;
  std::string words;  // "close, typical error 7.2 %"
};

// What failed comes first: the descent, the description of the data, what the measurement leaves open.
Badge BadgeOf(const Material& material);

}  // namespace lobefit

// What titles and comments say of the values, where their columns do not: "BRF Values", "Quantity: reflectance factor",
// "BRDF in 10^-3 1/sr", "normalised to the peak".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/io/text/format.h"
#include "lobefit/io/text/units.h"

namespace lobefit {

struct ValueMention {
  std::optional<ValueKind> kind;    // where all lines that name one name the same
  std::optional<ValueScale> scale;  // beside the kind
  std::string line;                 // that both are from
  // A kind that is not clear: two of them, a cosine of which angle, "reflectance" alone.
  std::string question;
  std::string arbitrary;     // a line by which the scale to 1/sr is not known
  std::string multiple;      // a line by which the numbers may be a multiple of the values, or their logarithm
  std::string transmission;  // a line that speaks of light that passes the sample, and of no other
  std::string polarised;     // a line that names one polarisation
};

// The kind of value that a name of a column or a title holds among other words: "Panel BRF". Empty where it holds none,
// several, or words for a value that is not the measured one ("BRDF model", "reference BRF").
std::optional<ValueKind> KindNamedIn(std::string_view text);

// `lines`: titles and comments of the head, without their marks.
ValueMention FindValueMention(const std::vector<std::string>& lines);

}  // namespace lobefit

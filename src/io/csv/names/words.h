// A column's name as words: whatever alphabet, case, separators and unit it is written with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

struct NameWords {
  std::vector<std::string> words;  // "ThetaIn [°]", "theta-in", "θ_in" all give {"theta", "in"}
  std::string unit;                // as PlainUnit gives it: "deg"; empty where there is none
  std::string function;            // "log10", "u", ... of "log10(BRDF)"
  bool magnitude = false;          // "|beta - beta0|"
  bool foreign = false;            // words of another language than English were put into it
};

// Greek letters become their names, letters with accents those without, subscripts and LaTeX plain text, words of other
// languages English ones (foreign_words.h). A unit is what stands in brackets at the end, behind a slash or a comma, or
// the last word, where it is a unit of anything; other brackets are words like the rest.
NameWords SplitName(std::string_view name);

}  // namespace lobefit

// What a sentence says about where angles count from: "azimuth 0 is the specular direction", "scatter angles are
// relative to the specular direction".
#pragma once

#include <cstddef>
#include <string_view>

#include "lobefit/io/csv/head/keys.h"

namespace lobefit {

// Takes a comment or a title as such a sentence, in English, German, French, Italian or Spanish. False, with nothing
// changed, for one that says nothing of the kind or contradicts itself.
bool ReadConvention(std::size_t line, std::string_view text, CsvKeys* keys);

// Of names that are not understood for what stands in their brackets: "relative azimuth (0 = specular)".
void TakeConventionsOfNames(std::size_t line, std::vector<CsvColumn>* columns, CsvKeys* keys);

}  // namespace lobefit

// Columns of values whose names are none of those that are known.
#pragma once

#include <string>
#include <vector>

#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

// "BRDF 1,BRDF 2,BRDF 3": where both polar angles have columns of their own, these are no angles. Of one sample
// measured again or of several, only a column of their mean tells: beside it, or where one column is `chosen`, they are
// ignored. Else returns what to do, and an empty text where there are none.
std::string SetRepetitionsAside(bool chosen, std::vector<CsvColumn>* columns);

// "Panel BRF": takes the column whose name holds one kind of value among other words as the value, where no other does.
bool TakeOnlyNamed(std::vector<CsvColumn>* columns);

// "R550,R650", "refl_550nm": the names of reflectances at wavelengths, which can be f_r or pi f_r. Takes them as
// channels where the kind is known.
std::vector<std::string> TakeReflectances(bool kind_is_known, std::vector<CsvColumn>* columns);

// Names of columns that are not known and hold numbers.
std::vector<std::string> FindUnknownNumbers(const CsvHeader& header, const std::vector<CsvColumn>& columns);

}  // namespace lobefit

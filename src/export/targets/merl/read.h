// A MERL table as the database's own reader evaluates it.
#pragma once

#include <string_view>

#include "lobefit/export/targets/target.h"

namespace lobefit {

// 90 x 90 x 180 cells, or 90 x 90 x 360 of a table without reciprocity.
bool IsMerlTable(std::string_view bytes);
// Each value is that of the cell that holds the angles; a negative channel makes the sample black.
ImportedMaterial ReadMerlLookup(const InputFile& file);

}  // namespace lobefit

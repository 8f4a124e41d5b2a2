// Names of angles that are too short to mean anything by themselves, and do beside each other.
#pragma once

#include <vector>

#include "lobefit/io/csv/names/columns.h"

namespace lobefit {

// "src_z,src_a,view_z,view_a" are zenith and azimuth of a direction of which no x and y are given; "i,e,g" of planetary
// work incidence, emission and phase, "i,e" beside an azimuth the first two.
void NameShortAngles(std::vector<CsvColumn>* columns);

}  // namespace lobefit

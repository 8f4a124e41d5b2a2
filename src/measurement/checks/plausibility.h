// Conventions checked against the data: what of a measurement is implausible as a whole, and which option cures it.
//
// A convention that is read wrongly leaves directions and values that are each possible; only together they are not.
// Nothing is changed here: a retro-reflector, a pinhole camera's field of one degree and a saturated detector exist.
#pragma once

#include <string>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// One remark for each of these that holds, with the option that cures it:
// - light: in most incident directions the largest values lie about the light's own direction instead of the mirror's;
// - peaks: in most incident directions the largest values lie about the normal, or where the mirror direction would be
//   if one of the angles counted from the surface;
// - level: more light would leave than arrives, by a third at least, where the samples tell; negative throughout; the
//   largest value exactly 1 or 100;
// - uncertainties: half of those stated are above their values;
// - marks: values that are exactly 0, -1, -999 and their like, or many that share the largest one.
// Tables with cells (samples.solid_angle) are made by programs and are checked for the light and the level only.
std::vector<std::string> FindImplausible(const Measurement& measurement);

}  // namespace lobefit

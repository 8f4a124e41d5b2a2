// How numbers of UTIA files become f_r: the same in .bin and EXR files.
#pragma once

#include "lobefit/io/text/format.h"

namespace lobefit {

// f_r of a finite stored number. kSrgb: stored / 140 behind the sRGB curve, times 100, negative ones 0.
double UtiaValue(double stored, const ReadOptions& options);
void EchoUtiaOptions(const ReadOptions& options, Measurement* measurement);

}  // namespace lobefit

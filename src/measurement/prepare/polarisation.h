// Readings of several polarisations made one of unpolarised light.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

// A name, in small letters, that stands for unpolarised light or the mean over polarisations.
bool IsUnpolarised(std::string_view name);

// The samples of each pair of directions become their mean over the polarisations, since unpolarised light is half of
// each of two that are orthogonal; repeated samples of one polarisation are averaged first. A pair that lacks a
// polarisation is set aside as a hole. Four states of two letters each ("ss", "s p", ...) are those of the light before
// and of a filter behind the sample: their sum is halved. Where one of the names stands for unpolarised light, its
// samples are kept and the others are outside the selection. Weights are gathered as values are.
//
// `polarisation` is one index into `names` a sample. Returns a remark that says what was done, empty where there is one
// polarisation only. Throws InputError for more than two polarisations that are not such four, none of them
// unpolarised.
std::string AverageOverPolarisation(const std::vector<std::uint8_t>& polarisation,
                                    const std::vector<std::string>& names, Measurement* measurement);

}  // namespace lobefit

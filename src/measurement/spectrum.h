// Choosing and converting channels: wavelengths to R G B or luminance by CIE 1931, and R G B to a smooth spectrum.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// A linear map between channels: row r of `matrix` gives channel r of `channels`.
struct ChannelMap {
  Channels channels;
  std::vector<std::vector<double>> matrix;
  // For people: "R G B from 31 wavelengths (CIE 1931 2 deg, D65, sRGB primaries)".
  std::string description;
};

// `choice` as on the command line (--channels):
//   all         as they are
//   rgb         linear sRGB. Wavelengths: CIE 1931 2-degree observer under illuminant D65, the spectrum linear between
//               its wavelengths and constant beyond them, integrated from 380 to 780 nm in steps of 1 nm, scaled so
//               that a white reflectance is (1, 1, 1)
//   luminance   CIE Y of the same
//   spectrum    R G B as a smooth spectrum of 400 to 700 nm in steps of 10 nm whose R G B are these (three overlapping
//               bands)
//   LIST        names or wavelengths in nm or ranges of them, separated by commas: "R,B", "550,600nm", "400:700"
// Throws UsageError for a choice that the channels cannot give: rgb needs R G B, X Y Z or wavelengths that cover 430 to
// 650 nm.
ChannelMap MakeChannelMap(const std::string& choice, const Channels& channels);

// Channels of these names, with wavelengths where each is one: "550nm".
Channels ChannelsNamed(std::vector<std::string> names);

// Whether the wavelengths cover 430 to 650 nm, as colours need it.
bool CoversVisible(const std::vector<double>& wavelengths_nm);

// Replaces the channels of a measurement; adds "channels" to its conventions.
void Apply(const ChannelMap& map, Measurement* measurement);
// The function with its channels replaced.
BrdfFunction Apply(const ChannelMap& map, const BrdfFunction& brdf, std::size_t channels_before);

// Linear sRGB (IEC 61966-2-1, D65) from CIE XYZ and back.
std::array<double, 3> SrgbFromXyz(const std::array<double, 3>& xyz);
std::array<double, 3> XyzFromSrgb(const std::array<double, 3>& rgb);

// CIE X, Y, Z of the wavelength under D65, scaled so that the sum over 380..780 nm in steps of 1 nm of Y is 1. 0
// outside that range.
std::array<double, 3> WeightedMatching(double nm);

}  // namespace lobefit

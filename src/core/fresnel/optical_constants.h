// Published refractive indices of common metals, by name and wavelength.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobefit/core/fresnel/fresnel.h"

namespace lobefit {

struct MetalIndex {
  ConductorIndex index;
  std::string source;  // author, journal, volume, pages (year) of the measurement
};

// Complex index of a metal at a wavelength in air, by linear interpolation between the published wavelengths: measured
// on films or bulk samples at room temperature, from 350 nm to 1.9 um (Ag Cr Ni Ti), 2.5 um (W) or 12.4 um (Al Au Cu Fe
// brass). Where two sources cover a wavelength the one for the visible is taken. `name`: chemical symbol or English
// word, case ignored. Thin-film and bulk samples differ by several per cent between sources: these are starting values
// and plausibility checks, not properties of a given sample. Throws InputError that lists the names, or the range of
// the metal.
MetalIndex MetalIndexAt(std::string_view name, double wavelength_nm);

struct MetalInfo {
  std::string symbol, name;
  double low_nm, high_nm;
  std::vector<std::string> sources;
};
std::vector<MetalInfo> Metals();

}  // namespace lobefit

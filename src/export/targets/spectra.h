// Spectra in the texts of renderers: values at wavelengths, linear between them.
#pragma once

#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct SpectrumNodes {
  std::vector<double> wavelengths_nm, values;
};

// The nodes with the first and last value held to 360 and 830 nm: renderers take a spectrum for 0 beyond its ends.
SpectrumNodes Continued(const SpectrumNodes& nodes);
// Linear between the nodes, constant beyond.
double ValueAt(const SpectrumNodes& nodes, double nm);

// The channels that a file's spectra have in common: its own wavelengths, without an end at which every spectrum
// repeats its neighbour (the continuation above). Domain: all have the same wavelengths, at least two.
std::vector<double> WavelengthsOf(const std::vector<SpectrumNodes>& spectra);
Channels WavelengthChannels(const std::vector<double>& wavelengths_nm);

// The function of `from` wavelengths at the wavelengths of `to`, linear between.
BrdfFunction AtWavelengths(const BrdfFunction& brdf, const std::vector<double>& from, const std::vector<double>& to);

}  // namespace lobefit

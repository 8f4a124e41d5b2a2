// The parts of a material for Mitsuba, in both spellings: XML and Python.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

struct MitsubaComponent {
  std::string xml, python;
  double share = 0;  // of the blend
};

// `wavelengths_nm` empty: colours are R, G, B; else spectra at these.
MitsubaComponent MitsubaLobe(const SurfaceLobe& lobe, const std::vector<double>& wavelengths_nm);
MitsubaComponent MitsubaDiffuse(const Spectrum& reflectance, double share, const std::vector<double>& wavelengths_nm);
// Below a normal map: `map` as the XML is to name it, `file` its name beside the Python file. `shadowing`: the XML
// switches off the shadowing function, which Mitsuba has from 3.7.1 on and before which it refuses the property.
void Tilt(const std::string& map, const std::string& file, bool shadowing, MitsubaComponent* component);
// Nested blends of all; the weight of a blend is the share of its second.
MitsubaComponent Blend(std::vector<MitsubaComponent> components);

std::string Indented(const std::string& text, const std::string& by);

}  // namespace lobefit

// Universal BRDF file of the European metrology institutes (EMPIR projects BiRD and BxDiff): JSON.
//
// Arrays of one length, one for each variable, under "data": theta_i, phi_i, theta_r, phi_r with their units,
// wavelength_i, polarization_i, and BRDF with its unit and uncertainty [data_json_schema_v1.0]. Drafts of the format
// have a list of "variables" and rows of "values" instead, BRDF and uBRDF among them. Azimuths are stated in the
// sample's coordinates, both directions away from the surface, so phi_r = phi_i + 180 degrees is the mirror's side.
#pragma once

#include <string_view>

#include "lobefit/io/text/format.h"

namespace lobefit {

bool IsBird(std::string_view bytes);
// Rows that differ in polarisation only are averaged, as CSV rows are (measurement/prepare/polarisation.h). Throws
// InputError.
Measurement ReadBird(const InputFile& file, const ReadOptions& options);

}  // namespace lobefit

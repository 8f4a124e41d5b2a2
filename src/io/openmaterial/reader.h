// ASAM OpenMATERIAL 3D table of reflectance (JSON, material_brdf_schema): rows of wavelength in metres, theta_i,
// theta_o and phi_o in radians, and f_r in 1/sr under brdf.lookupTable. phi_o is relative to the light at azimuth 0
// [schema]: 180 degrees is the mirror's side, and the surface is isotropic by construction. null is a value that was
// not measured.
#pragma once

#include <string_view>

#include "lobefit/io/text/format.h"

namespace lobefit {

bool IsOpenMaterial(std::string_view bytes);
// Throws InputError.
Measurement ReadOpenMaterial(const InputFile& file, const ReadOptions& options);

}  // namespace lobefit

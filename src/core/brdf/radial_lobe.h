// Lobes of a radial profile (profile.h) and of Student's slopes (student.h) for arrays of samples: the specular factor
// of the BRDF with its gradient by the ellipse and by the profile.
#pragma once

#include <memory>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/brdf/model.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/radial/profile_masking.h"

namespace lobefit {

// specular[i] and cos_d[i] as in ggx_lobe.h, `masking` one of the first three kinds. The density is GGX's times e^E pi
// / Z, the projected areas are GGX's and sqrt(q) times the table's difference: with all coefficients 0 the values are
// GGX's to the bit. gradient: 5 + masking.profile().q().size() arrays of `count`, by the slope coordinates and by q;
// null = not wanted. The last bits depend on the processor, whose exp and log in SIMD they are.
void RadialLobe(const DirectionArrays& directions, const SlopeCoordinates& shape, const ProfileMasking& profile,
                Masking masking, double* specular, double* cos_d, double* gradient);

}  // namespace lobefit

// What an instrument makes of a reflectance function before any noise: means over its discs, a crooked sample.
#pragma once

#include <cstddef>

#include "lobefit/core/instrument/aperture.h"
#include "lobefit/measurement/brdf_function.h"

namespace lobefit {

// The mean of `brdf` over the discs of source and detector, by quadrature that knows nothing of the function but the
// width of its finest structure, `lobe_width` (radians, about the smallest alpha): to 1e-5 of the value up to discs of
// 10 widths. Both discs, the smaller of them wider than 2 widths: by the mixture of concentric discs (aperture.h), to
// 1e-3. Over a rectangular detector by a product rule, with a source that is a point. Below the horizon a surface
// reflects nothing: in the flux mean that part of a disc counts with 0, in the plain mean it does not count.
BrdfFunction WithAperture(const BrdfFunction& brdf, const Aperture& aperture, std::size_t channels,
                          double lobe_width = 1e9);

// f_r of a sample that is turned about x, then y: the directions that the instrument names are not those of the
// sample's frame. Zero where the turned direction is at or below the sample's horizon.
BrdfFunction WithMisalignment(const BrdfFunction& brdf, double about_x, double about_y, std::size_t channels);

}  // namespace lobefit

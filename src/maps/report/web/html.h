// The live page of maps: the picture under a dragged light, and the pictures of the report.
#pragma once

#include <string>

#include "lobefit/maps/report/page.h"

namespace lobefit {

// The longer side of the live picture, in texels; larger maps are shown by every second, third, ... texel.
inline constexpr std::size_t kLiveSide = 320;

// One file that names no other. Throws what reading the photographs throws.
std::string MapsHtml(const Maps& maps, const Stack& stack, const MapsPage& page);

}  // namespace lobefit

// What the live picture of the page is made of.
#pragma once

#include <string>

#include "lobefit/maps/report/page.h"

namespace lobefit {

// JSON: width, height; the textures normals, diffuses, mirrors, lasts (maps.glsl says what they hold) as base64 of half
// floats, rows from the top; schlick; grid (maps.glsl); lights, directions; near (null, or reference distance and
// distances of the lights, mm, and `fall` of maps.glsl); cameras, places; first, the light that is shown at first;
// exposure, with which 99 % of the picture under it is below white. `step`: every which texel.
std::string LiveData(const Maps& maps, const Stack& stack, const MapsPage& page, std::size_t step);

// The step for pictures of at most kLiveSide.
std::size_t LiveStep(const Maps& maps);

}  // namespace lobefit

// How far what a renderer makes of textures is from the maps.
#pragma once

#include "lobefit/export/targets/error_meter.h"
#include "lobefit/maps/textures/map_target.h"

namespace lobefit {

// Over at most `most_texels` texels on a grid, those with a normal within the mask; of each 24 pairs of directions to
// 88 degrees from z and above the shading normal's horizon by 2 degrees: half of them uniform over both hemispheres,
// half with half vectors among those that hold 90 % of the lobe's normals. The values are those that the pictures hold,
// steps of their bits included. The albedo is not asked (NaN).
ExportError ErrorOfTarget(const MapTarget& target, const MapNumbers& maps, std::size_t most_texels, int threads);

}  // namespace lobefit

// Where the lights and cameras of a stack are for each texel.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/maps/engine/lights.h"
#include "lobefit/maps/stack/stack.h"

namespace lobefit {

// The middle of a texel, mm; of a stack whose width is known.
Vec3 PointOf(const Stack& stack, std::size_t texel);

// Unit direction from a texel to a light, and to the camera of its photograph.
Vec3 DirectionAt(const Stack& stack, std::size_t light, std::size_t texel);
Vec3 ViewAt(const Stack& stack, std::size_t light, std::size_t texel);

// Irradiance across the beam over that which the light's intensity stands for; 1 for distant lights.
double IrradianceAt(const Stack& stack, std::size_t light, std::size_t texel);

// The lights `index` as a texel sees them, into `paths`.
void PathsAt(const Stack& stack, const std::vector<std::size_t>& index, std::size_t texel, LightPaths* paths);

}  // namespace lobefit

// Where the lights of a stack are for each texel.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/maps/stack/stack.h"

namespace lobefit {

// The middle of a texel, mm; of a stack of near lights.
Vec3 PointOf(const Stack& stack, std::size_t texel);

// Unit direction from a texel to a light.
Vec3 DirectionAt(const Stack& stack, std::size_t light, std::size_t texel);

// Irradiance across the beam over that which the light's intensity stands for; 1 for distant lights.
double IrradianceAt(const Stack& stack, std::size_t light, std::size_t texel);

// Fills `directions` with those of the lights `index` at the texel.
void DirectionsAt(const Stack& stack, const std::vector<std::size_t>& index, std::size_t texel,
                  std::vector<Vec3>* directions);

}  // namespace lobefit

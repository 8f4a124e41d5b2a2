// The two functions of the light that a texel's values are made of, with derivatives by the shape.
#pragma once

#include "lobefit/maps/engine/lights.h"
#include "lobefit/maps/engine/model.h"

namespace lobefit {

// Arrays over the padded lights: cosine = max(i_z, 0), specular = i_z D G1(i) G1(o) / (4 i_z o_z), and for each number
// of the shape its derivative; the first two are turns of the normal by n -> n + a t + b b at a = b = 0, or slopes. 0
// below the horizon.
struct ShapeArrays {
  LightVector cosine, specular, dcosine[2], dspecular[kMostShape];
  void Resize(std::size_t padded);
};

// Domain: normal.z > 0. Without a lobe specular is not touched.
void EvaluateShape(MapLobe lobe, const MapPoint& point, const LightArrays& lights, bool gradient, ShapeArrays* out);

}  // namespace lobefit

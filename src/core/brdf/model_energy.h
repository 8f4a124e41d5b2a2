// Energy of a fitted model: what share of the light that comes in goes out.
#pragma once

#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Points of the integral over a lobe's own slopes, where the visible facets are.
struct FacetGrid {
  int rings = 160, steps = 64;
};

// Directional albedo, integral of f_r cos(theta_o) over wo, a channel; wi away from the surface. The specular part is
// integrated over each lobe's slopes, that of an ABg lobe over direction cosines (abg_lobe.h); a Lambertian part
// exactly, diffuse microfacets over 24 x 48 directions.
std::vector<double> DirectionalAlbedo(const Model& model, const ParameterValues& values, std::size_t channels,
                                      const Vec3& wi, const FacetGrid& grid = {});

// The specular lobes alone with F = 1: what a single bounce keeps. One lobe at a time.
double SingleBounceAlbedo(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& wi);

// Weak white furnace [Heitz eq 36], over the whole sphere of reflected directions: min(1, sigma(u) / cos) for a clamped
// Smith G1, 1 for an unclamped one and for V-cavities [MATH.md section 5]; over the points above (error below 1 %) for
// the maskings that do not come from a surface, NaN for an ABg lobe, which has none.
double WeakFurnace(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& u);

}  // namespace lobefit

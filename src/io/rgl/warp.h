// Density on the unit square with bilinear interpolation between grid nodes, and its inverse: the warp of RGL files
// [Dupuy and Jakob 2018]. It must be the one that the renderers' loaders apply, since a file's samples stand on warped
// nodes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

// A piecewise bilinear density of `height` rows (y) and `width` columns (x), normalised on construction. The row is
// drawn from the marginal, then the column from the conditional.
class BilinearWarp {
 public:
  // `values` holds height x width numbers >= 0, x fastest, width and height >= 2, of positive sum.
  BilinearWarp(const float* values, std::size_t width, std::size_t height);

  // The point of [0, 1]^2 that the uniform point `u` goes to; *pdf is the density there.
  Vec2 Sample(const Vec2& u, double* pdf) const;
  // The uniform point that Sample sends to `x`; *pdf is the density at x.
  Vec2 Invert(const Vec2& x, double* pdf) const;

  // A warp and its share in a mixture of densities of equal size, as loaders interpolate between tabulated directions.
  struct Part {
    const BilinearWarp* warp;
    double share;
  };
  static Vec2 Invert(std::span<const Part> parts, const Vec2& x, double* pdf);

 private:
  template <class Tables>
  static Vec2 InvertIn(const Tables& tables, std::size_t width, std::size_t height, const Vec2& x, double* pdf);

  std::size_t width_, height_;
  std::vector<double> data_, conditional_, marginal_;
};

// Bilinear interpolation in a grid of `height` x `width` over the unit square, x fastest; clamped at the borders.
double Bilinear(const float* values, std::size_t width, std::size_t height, const Vec2& x);

}  // namespace lobefit

// Integrals of the GGX slope distribution over triangles and polygons of the slope plane [Loubet section 3], for
// averages over a detector's aperture or a pixel's footprint. slope_sampling.h draws from it inside a triangle.
//
// The distribution is P(x, y) = 1 / (pi alpha_x alpha_y (1 + x^2/alpha_x^2 + y^2/alpha_y^2)^2), eq 3; int P = 1 over
// the plane. Alphas > 0. Any ellipsoid or off-centre correlated GGX is this one after an affine map of the slopes: y =
// L^-1 (s - mean), alphas 1.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

struct GgxPolygonGradient {
  double dalpha_x, dalpha_y;
  std::vector<Vec2> dvertices;
};

struct GgxTriangleGradient {
  double dalpha_x, dalpha_y;
  std::array<Vec2, 3> dvertices;
};

// P itself at the slope s, 1 / slope^2.
double GgxSlopeDensity(const Vec2& s, double alpha_x, double alpha_y);

// Integral of P over the triangle, never negative: the orientation does not matter. [Loubet] unnumbered after eq 12
// (Lambert's formula for a cosine over a spherical triangle), in three forms that agree where they meet, because the
// printed one cancels for triangles that are small, far away or thin: a 7-point rule for small ones; the edge sum in
// differences; and, where that would lose more than a few digits, int s (edge integral at s) ds over copies of one edge
// shrunk towards the opposite vertex, whose terms are all positive. Vertex derivatives are line integrals along the
// edges in a closed form of their own. Relative error below 1e-12 for sizes 1e-7 to 1e3 and distances to 300 alphas,
// thin triangles included. A triangle without area gives 0; its gradient is that of a counter-clockwise one.
double GgxTriangleIntegral(const std::array<Vec2, 3>& vertices, double alpha_x, double alpha_y,
                           GgxTriangleGradient* gradient = nullptr);

// Integral of P over a simple polygon of at least three vertices in order, convex or not, by the triangles of its first
// vertex with their signs. Not negative.
double GgxPolygonIntegral(const std::vector<Vec2>& vertices, double alpha_x, double alpha_y,
                          GgxPolygonGradient* gradient = nullptr);

// The edge form for any scalar, the oracle of the tests: accurate for triangles of moderate size near the origin only.
template <class T>
T GgxTriangleIntegralFormula(const std::array<Vec2T<T>, 3>& vertices, const T& alpha_x, const T& alpha_y) {
  using std::atan2;
  using std::sqrt;
  T sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2T<T>&p = vertices[i], &q = vertices[(i + 1) % 3];
    const T ax = p.x / alpha_x, ay = p.y / alpha_y, bx = q.x / alpha_x, by = q.y / alpha_y;
    const T cross = ax * by - ay * bx;
    const T n = sqrt(cross * cross + (ax - bx) * (ax - bx) + (ay - by) * (ay - by));
    sum = sum + cross * atan2(n, 1.0 + ax * bx + ay * by) / n;
  }
  return (sum < 0.0 ? -sum : sum) / (2.0 * kPi);
}

}  // namespace lobefit

// The points of a sphere that fills a square picture.
#pragma once

#include "lobefit/math/vec.h"

namespace lobefit {

// World: x right, y up, z to the viewer. The tangent runs around the vertical axis.
struct PointFrame {
  Vec3 x, y, n;
  Vec3 ToLocal(const Vec3& w) const { return {Dot(w, x), Dot(w, y), Dot(w, n)}; }
  Vec3 ToWorld(const Vec3& w) const { return w.x * x + w.y * y + w.z * n; }
};

// False outside the sphere and a rim of two pixels around it, which is drawn like the edge, for the interpolation when
// the picture is enlarged.
bool FrameOfPixel(int column, int row, int size, PointFrame* frame);

}  // namespace lobefit

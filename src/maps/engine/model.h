// What is fitted to a texel, and where its numbers stand.
#pragma once

#include <array>
#include <cstddef>

#include "lobefit/math/vec.h"

namespace lobefit {

inline constexpr int kMostShape = 5, kMostChannels = 3, kMostUnknowns = kMostShape + 2 * kMostChannels;

// Distribution of micro-normals about the shading normal: none (Lambert alone), GGX with one width, GGX with two and a
// direction; or the latter about a mean of its own, an ellipsoid, while the normal is held.
enum class MapLobe { kNone, kGgx, kGgxAnisotropic, kEllipsoid };

// A value is f_r(i, o) i_z with all directions in the frame of the shading normal n,
//   diffuse_c / pi i_z + (f0_c (1 - k) + k) D G1(i) G1(o) / (4 o_z),  k = (1 - cos_d)^5 [Schlick 1994],
// 0 where i_z <= 0; the lobe's part also where o_z <= 0. D: GGX in slope space with L = (a 0; b c) [Heitz 2014 eq
// 84-95]; G1 separable [Walter 2007 eq 34], of the ellipsoid at most 1.
// The frame of n is the one that the shortest turn from z to n makes of x and y.
struct MapModel {
  MapLobe lobe = MapLobe::kGgx;
  int channels = 3;
  bool schlick = true;  // else k = 0: f0 is an amplitude in the stack's unit

  // Unknowns: two tangents of the normal (of the ellipsoid two mean slopes), ln alpha or (ln a, b, ln c), then for each
  // channel diffuse and, with a lobe, f0.
  int Shape() const { return lobe == MapLobe::kNone ? 2 : lobe == MapLobe::kGgx ? 3 : 5; }
  bool TurnsNormal() const { return lobe != MapLobe::kEllipsoid; }
  int PerChannel() const { return lobe == MapLobe::kNone ? 1 : 2; }
  int Unknowns() const { return Shape() + channels * PerChannel(); }
  int DiffuseAt(int channel) const { return Shape() + channel * PerChannel(); }
  int F0At(int channel) const { return DiffuseAt(channel) + 1; }
};

// A point of the search. width: ln alpha, or ln a, b, ln c; slope: the ellipsoid's mean slopes in the frame of the
// normal (core/ellipsoid/off_center.h). diffuse is diffuse / (pi scale), f0 is f0 / scale, where scale is that of the
// texel's values.
struct MapPoint {
  Vec3 normal = {0, 0, 1};
  std::array<double, 2> slope = {0, 0};
  std::array<double, 3> width = {-1, 0, -1};
  std::array<double, kMostChannels> diffuse = {}, f0 = {};
};

// The frame's axes as columns t, b, n; minimal turn from z.
struct MapFrame {
  Vec3 t, b, n;
};
inline MapFrame FrameOf(const Vec3& n) {
  const double q = 1 / (1 + n.z);
  return {{1 - n.x * n.x * q, -n.x * n.y * q, -n.x}, {-n.x * n.y * q, 1 - n.y * n.y * q, -n.y}, n};
}

}  // namespace lobefit

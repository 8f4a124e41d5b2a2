#include "lobefit/core/ellipsoid/canonical_axes.h"

#include <limits>

namespace lobefit {
namespace {

void Flip(CanonicalAxes* axes, std::size_t k) {
  axes->axis[k] = -axes->axis[k];
  axes->turn[k] = -axes->turn[k];
}

void ChooseDegenerateAxes(bool same_xy, bool same_xz, CanonicalAxes* axes) {
  auto& [x, y, z] = axes->axis;
  if (same_xy && same_xz) {
    x = {1, 0, 0};
    y = {0, 1, 0};
    z = {0, 0, 1};
  } else if (same_xy) {
    x = std::hypot(z.x, z.z) > 0 ? Normalized(Vec3{z.z, 0, -z.x}) : Vec3{1, 0, 0};
    y = Cross(z, x);
  } else if (std::abs(y.z) < 1) {
    z = Normalized(Vec3{-y.z * y.x, -y.z * y.y, y.x * y.x + y.y * y.y});
    x = Cross(y, z);
  }
}

}  // namespace

CanonicalAxes ToCanonicalAxes(const PrincipalAxes& axes) {
  CanonicalAxes result = {{axes.length[1], axes.length[2], axes.length[0]},
                          {axes.axes.row[1], axes.axes.row[2], axes.axes.row[0]},
                          {axes.rotation.row[1], axes.rotation.row[2], axes.rotation.row[0]},
                          false};
  constexpr double kSame = 32 * std::numeric_limits<double>::epsilon();
  const bool same_xy = result.length[0] - result.length[1] <= kSame * result.length[0];
  const bool same_xz = result.length[2] - result.length[0] <= kSame * result.length[2];
  result.degenerate = same_xy || same_xz;
  if (result.degenerate) ChooseDegenerateAxes(same_xy, same_xz, &result);

  const auto& [x, y, z] = result.axis;
  if (z.z < 0) Flip(&result, 2);
  if (Dot(Cross(x, y), z) < 0) Flip(&result, 1);
  if (x.x < 0 || (x.x == 0 && x.y > 0)) {
    Flip(&result, 0);
    Flip(&result, 1);
  }
  return result;
}

Ellipsoid EllipsoidFromAxes(const CanonicalAxes& axes) {
  Ellipsoid e = EllipsoidFromRotation(axes.length[0] / axes.length[2], axes.length[1] / axes.length[2],
                                      {{{axes.axis[0], axes.axis[1], axes.axis[2]}}});
  // R11 > 0 says that theta_z is in range, unless theta_y is +-pi/2 to rounding: then the x and y axes are reversed
  // here.
  if (e.theta_z > 0.5 * kPi || e.theta_z <= -0.5 * kPi) {
    e.theta_x = 0.0 - e.theta_x;
    e.theta_y = 0.0 - e.theta_y;
    e.theta_z += e.theta_z > 0 ? -kPi : kPi;
  }
  return e;
}

Ellipsoid EllipsoidFromRotation(double alpha_x, double alpha_y, const Mat3& rotation) {
  const auto& [x, y, z] = rotation.row;
  Ellipsoid e = {alpha_x, alpha_y, 0, 0, 0};
  e.theta_x = std::atan2(0.0 - y.z, z.z);  // 0.0 - y.z, not -y.z: no negative zero in a report
  e.theta_y = std::atan2(x.z, std::hypot(y.z, z.z));
  if (std::hypot(x.x, x.y) > 1e-3) {
    e.theta_z = std::atan2(0.0 - x.y, x.x);
  } else {
    // Near gimbal lock R11, R12 are rounding errors; the second row of Rx(-theta_x) R is (sin, cos, 0) of theta_z
    // whatever theta_x is.
    const double cx = std::cos(e.theta_x), sx = std::sin(e.theta_x);
    e.theta_z = std::atan2(cx * y.x + sx * z.x, cx * y.y + sx * z.y);
  }
  return e;
}

}  // namespace lobefit

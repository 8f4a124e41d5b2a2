#include "lobefit/core/ellipsoid/ellipsoid_symmetry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lobefit/core/ellipsoid/canonical_axes.h"

namespace lobefit {
namespace {

// `angle` plus a multiple of `period` in (-period / 2, period / 2].
double Wrapped(double angle, double period) {
  const double wrapped = std::remainder(angle, period);
  return wrapped <= -0.5 * period ? wrapped + period : wrapped;
}

}  // namespace

Ellipsoid CanonicalEllipsoid(const Ellipsoid& ellipsoid) {
  PrincipalAxes axes;
  axes.axes = EllipsoidRotation(ellipsoid);
  axes.length = {ellipsoid.alpha_x, ellipsoid.alpha_y, 1.0};
  axes.rotation = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  // Longest first; of equal axes the later one, so that a canonical ellipsoid keeps its third axis.
  const auto put_longest = [&](std::size_t at, std::size_t from) {
    if (axes.length[from] >= axes.length[at]) {
      std::swap(axes.length[from], axes.length[at]);
      std::swap(axes.axes.row[from], axes.axes.row[at]);
    }
  };
  put_longest(0, 1);
  put_longest(0, 2);
  put_longest(1, 2);
  return EllipsoidFromAxes(ToCanonicalAxes(axes));
}

Ellipsoid FoldAngles(const Ellipsoid& ellipsoid) {
  Ellipsoid e = ellipsoid;
  e.theta_y = Wrapped(e.theta_y, 2 * kPi);
  if (std::abs(e.theta_y) > 0.5 * kPi) {
    e.theta_y = std::copysign(kPi, e.theta_y) - e.theta_y;
    e.theta_z += kPi;
  }
  e.theta_z = Wrapped(e.theta_z, 2 * kPi);
  if (e.theta_z > 0.5 * kPi || e.theta_z <= -0.5 * kPi) {
    e.theta_x = -e.theta_x;
    e.theta_y = -e.theta_y;
    e.theta_z += e.theta_z > 0 ? -kPi : kPi;
  }
  e.theta_x = Wrapped(e.theta_x, kPi);
  return e;
}

Ellipsoid SwapAxes(const Ellipsoid& ellipsoid) {
  const Mat3 r = EllipsoidRotation(ellipsoid);
  return EllipsoidFromRotation(ellipsoid.alpha_y, ellipsoid.alpha_x, {{{-r.row[1], r.row[0], r.row[2]}}});
}

Ellipsoid PromoteAxis(const Ellipsoid& ellipsoid, int axis) {
  const Mat3 r = EllipsoidRotation(ellipsoid);
  const double ax = ellipsoid.alpha_x, ay = ellipsoid.alpha_y;
  if (axis == 0) return EllipsoidFromRotation(ay / ax, 1 / ax, {{{r.row[1], r.row[2], r.row[0]}}});
  return EllipsoidFromRotation(1 / ay, ax / ay, {{{r.row[2], r.row[0], r.row[1]}}});
}

Ellipsoid NearestEllipsoid(const Ellipsoid& ellipsoid, const Ellipsoid& to) {
  Ellipsoid nearest = ellipsoid;
  double least = std::numeric_limits<double>::infinity();
  for (Ellipsoid e : {ellipsoid, SwapAxes(ellipsoid)}) {
    for (int turn = 0; turn < 2; ++turn, e = {e.alpha_x, e.alpha_y, -e.theta_x, -e.theta_y, e.theta_z + kPi}) {
      e.theta_z = to.theta_z + std::remainder(e.theta_z - to.theta_z, 2 * kPi);
      const double gaps[] = {std::log(e.alpha_x / to.alpha_x), std::log(e.alpha_y / to.alpha_y), e.theta_x - to.theta_x,
                             e.theta_y - to.theta_y, e.theta_z - to.theta_z};
      double square = 0;
      for (const double gap : gaps) square += gap * gap;
      if (square < least) least = square, nearest = e;
    }
  }
  return nearest;
}

Ellipsoid MirrorY(const Ellipsoid& e) { return {e.alpha_x, e.alpha_y, -e.theta_x, e.theta_y, -e.theta_z}; }

Ellipsoid TurnAboutNormal(const Ellipsoid& e, double angle) {
  return {e.alpha_x, e.alpha_y, e.theta_x, e.theta_y, e.theta_z - angle};
}

Vec3 EllipsoidPeak(const Ellipsoid& ellipsoid, double* D_max) {
  const EllipsoidFrame frame(ellipsoid);
  const double ax = ellipsoid.alpha_x, ay = ellipsoid.alpha_y;
  std::size_t axis = 2;
  double longest = 1.0;
  if (ax > longest) axis = 0, longest = ax;
  if (ay > longest) axis = 1, longest = ay;
  const Vec3 wm = frame.rotation().row[axis];
  if (D_max != nullptr) {
    const double square = longest * longest;
    *D_max = kInvPi * square * square / (ax * ay * std::sqrt(frame.norm2_an()));
  }
  return wm.z < 0 ? -wm : wm;
}

std::vector<std::array<double, kEllipsoidParameters>> FlatDirections(const Ellipsoid& ellipsoid, double tolerance) {
  const double ax = ellipsoid.alpha_x, ay = ellipsoid.alpha_y;
  const auto same = [&](double a, double b) { return std::abs(a - b) <= tolerance * std::max(a, b); };
  const double cx = std::cos(ellipsoid.theta_x), sx = std::sin(ellipsoid.theta_x);
  const double cy = std::cos(ellipsoid.theta_y), sy = std::sin(ellipsoid.theta_y);
  std::vector<std::array<double, kEllipsoidParameters>> flat;
  const auto add = [&](double tx, double ty, double tz) {
    const double norm = std::sqrt(tx * tx + ty * ty + tz * tz);
    flat.push_back({0, 0, tx / norm, ty / norm, tz / norm});
  };
  // A turn g about an axis of the ellipsoid is d theta with g = ex d theta_x + (0, cx, sx) d theta_y + (sy, -sx cy, cx
  // cy) d theta_z; times cy, so that it stays finite.
  if (same(ay, 1)) add(1, 0, 0);
  const bool gimbal = std::abs(cy) <= tolerance;
  if (same(ax, 1) && !gimbal) add(sx * sy, cx * cy, -sx);
  if (same(ax, ay) && !gimbal) add(-cx * sy, sx * cy, cx);
  if (gimbal) add(1, 0, -sy);
  return flat;
}

}  // namespace lobefit

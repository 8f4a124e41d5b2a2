#include "lobefit/io/exr/map.h"

#include <algorithm>
#include <cmath>

#include "lobefit/io/bsdf_xml/tensor_tree.h"
#include "lobefit/io/utia/grid.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kHorizon = 1e-9;

// x, y in [-1, 1], y up. False outside the hemisphere.
bool OnHemisphere(ExrProjection projection, double x, double y, Vec3* w, double* measure) {
  if (projection == ExrProjection::kConcentric) {
    const Vec2 disk = SquareToDisk({(x + 1) / 2, (y + 1) / 2});
    *w = {disk.x, disk.y, std::sqrt(std::max(0.0, 1 - disk.x * disk.x - disk.y * disk.y))};
    *measure = w->z > 0 ? 1 / w->z : 0.0;
    return true;
  }
  const double radius = std::hypot(x, y);
  if (radius >= 1) return false;
  const bool equal_area = projection == ExrProjection::kEqualArea;
  const double theta = equal_area ? 2 * std::asin(radius / std::sqrt(2.0)) : radius * kPi / 2;
  *w = FromSpherical(theta, std::atan2(y, x));
  *measure = equal_area || radius == 0 ? 1.0 : std::sin(theta) / theta;
  return true;
}

}  // namespace

bool ExrMap::Directions(std::size_t column, std::size_t row, std::size_t width, std::size_t height, Vec3* wi, Vec3* wo,
                        double* measure) const {
  const double u = (static_cast<double>(column) + 0.5) / static_cast<double>(width);
  const double down = (static_cast<double>(row) + 0.5) / static_cast<double>(height);
  switch (axes) {
    case ExrAxes::kSlice:
    case ExrAxes::kSliceSqrt: {
      const double v = rows == ExrRows::kUp ? 1 - down : down;
      const bool squared = axes == ExrAxes::kSliceSqrt;
      const double theta_h = (squared ? u * u : u) * kPi / 2, theta_d = v * kPi / 2;
      FromHalfDifference({theta_h, 0, theta_d, phi_d}, wi, wo);
      *measure = std::cos(theta_d) * std::sin(theta_d) * std::sin(theta_h) * (squared ? 2 * u : 1.0);
      break;
    }
    case ExrAxes::kHemisphere:
      *wi = FromSpherical(theta_i, phi_i);
      if (!OnHemisphere(projection, 2 * u - 1, 1 - 2 * down, wo, measure)) return false;
      break;
    case ExrAxes::kUtia:
      *wi = kUtiaGrid.Direction(row);
      *wo = kUtiaGrid.Direction(column);
      *measure = 1;
      break;
  }
  return wi->z > kHorizon && wo->z > kHorizon;
}

double ExrMap::DistanceTo(const Vec3& wi, const Vec3& wo) const {
  if (axes == ExrAxes::kUtia) return 0;
  if (axes == ExrAxes::kHemisphere) return std::acos(std::clamp(Dot(wi, FromSpherical(theta_i, phi_i)), -1.0, 1.0));
  const HalfDifference angles = ToFoldedHalfDifference(wi, wo);
  const double folded = std::acos(std::fabs(std::cos(phi_d)));
  return std::asin(std::sin(angles.theta_d) * std::sin(std::fabs(angles.phi_d - folded)));
}

}  // namespace lobefit

#include "lobefit/core/instrument/misalignment.h"

#include <algorithm>
#include <cmath>

namespace lobefit {

std::array<Vec3, 3> MisalignmentAxes(const Misalignment& e) {
  const double cx = std::cos(e.e_x), sx = std::sin(e.e_x), cy = std::cos(e.e_y), sy = std::sin(e.e_y);
  return {{{1, 0, 0}, {0, cx, -sx}, {-sy, sx * cy, cx * cy}}};
}

double MisalignedConductorBrdf(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi,
                               const Misalignment& misalignment, ValueKind kind, double gradient[8],
                               BrdfFactors* factors) {
  const Vec3 turned_o = InSampleFrame(misalignment, wo), turned_i = InSampleFrame(misalignment, wi);
  double by_shape[7];
  BrdfDirectionGradient by_direction;
  const bool derivatives = gradient != nullptr;
  const double f =
      EllipsoidConductorBrdf(ellipsoid, index, turned_o, turned_i, Masking::kSmithSeparable,
                             derivatives ? by_shape : nullptr, factors, derivatives ? &by_direction : nullptr);
  const double scale = kind == ValueKind::kBrdf       ? 1.0
                       : kind == ValueKind::kRadiance ? turned_i.z / wi.z
                                                      : turned_o.z / wo.z;
  if (!derivatives) return scale * f;
  if (f == 0) {
    std::fill(gradient, gradient + 8, 0.0);
    return 0;
  }
  const std::array<Vec3, 3> axes = MisalignmentAxes(misalignment);
  const Vec3 turning = Cross(turned_i, by_direction.wi) + Cross(turned_o, by_direction.wo);
  for (std::size_t k = 0; k < 3; ++k) {
    gradient[k] = -scale * Dot(axes[k], turning);
    if (kind == ValueKind::kRadiance) gradient[k] -= f * Cross(axes[k], turned_i).z / wi.z;
    if (kind == ValueKind::kFlux) gradient[k] -= f * Cross(axes[k], turned_o).z / wo.z;
  }
  for (std::size_t k = 0; k < kEllipsoidParameters; ++k) gradient[3 + k] = scale * by_shape[k];
  return scale * f;
}

}  // namespace lobefit

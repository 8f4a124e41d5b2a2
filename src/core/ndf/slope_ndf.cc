#include "lobefit/core/ndf/slope_ndf.h"

#include <algorithm>

namespace lobefit {

SlopeFrame::SlopeFrame(const SlopeCoordinates& coordinates)
    : slope_x(coordinates.v[0]),
      slope_y(coordinates.v[1]),
      a(std::exp(coordinates.v[2])),
      b(coordinates.v[3]),
      c(std::exp(coordinates.v[4])) {}

// dD = -(4 D / t) (y.dy + h_z dh_z) - D (dln a + dln c), t = h_z^2 + |y|^2; z = L^-T y carries dy back to slopes.
double SlopeD(const SlopeFrame& frame, const Vec3& wm, double* gradient, Vec3* dD_dwm) {
  if (wm.z < 0) {
    if (gradient != nullptr) std::fill(gradient, gradient + 5, 0.0);
    if (dD_dwm != nullptr) *dD_dwm = {0.0, 0.0, 0.0};
    return 0.0;
  }
  const double y1 = (-wm.x - frame.slope_x * wm.z) / frame.a;
  const double y2 = (-wm.y - frame.slope_y * wm.z - frame.b * y1) / frame.c;
  const double t = wm.z * wm.z + y1 * y1 + y2 * y2;
  const double value = kInvPi / (frame.a * frame.c * t * t);
  if (gradient != nullptr || dD_dwm != nullptr) {
    const double scale = 4.0 * value / t;
    const double z2 = y2 / frame.c;
    const double z1 = (y1 - frame.b * z2) / frame.a;
    if (gradient != nullptr) {
      gradient[0] = scale * wm.z * z1;
      gradient[1] = scale * wm.z * z2;
      gradient[2] = scale * frame.a * y1 * z1 - value;
      gradient[3] = scale * y1 * z2;
      gradient[4] = scale * y2 * y2 - value;
    }
    if (dD_dwm != nullptr) {
      *dD_dwm = {scale * z1, scale * z2, scale * (frame.slope_x * z1 + frame.slope_y * z2 - wm.z)};
    }
  }
  return value;
}

// With N = c_u + s = 2 sigma: dN = (N dc_u + dq / 2) / s.
double SlopeSigma(const SlopeFrame& frame, const Vec3& u, double* gradient, Vec3* dsigma_du) {
  const double c = u.z - frame.slope_x * u.x - frame.slope_y * u.y;
  const double l1 = frame.a * u.x + frame.b * u.y, l2 = frame.c * u.y;
  const double q = l1 * l1 + l2 * l2;
  const double s = std::sqrt(c * c + q);
  const double sum = c >= 0 ? c + s : q / (s - c);
  if (gradient != nullptr || dsigma_du != nullptr) {
    const double scale = 0.5 / s;
    if (gradient != nullptr) {
      gradient[0] = -scale * sum * u.x;
      gradient[1] = -scale * sum * u.y;
      gradient[2] = scale * l1 * frame.a * u.x;
      gradient[3] = scale * l1 * u.y;
      gradient[4] = scale * l2 * l2;
    }
    if (dsigma_du != nullptr) {
      *dsigma_du = {scale * (l1 * frame.a - sum * frame.slope_x),
                    scale * (l1 * frame.b + l2 * frame.c - sum * frame.slope_y), scale * sum};
    }
  }
  return 0.5 * sum;
}

double SlopeG1Unclamped(const SlopeFrame& frame, const Vec3& u, double* gradient, Vec3* dG1_du) {
  const double sigma = SlopeSigma(frame, u, gradient, dG1_du);
  const double value = std::abs(u.z) / sigma;
  if (gradient != nullptr) {
    for (int k = 0; k < 5; ++k) gradient[k] *= -value / sigma;
  }
  if (dG1_du != nullptr) {
    *dG1_du = (-value / sigma) * *dG1_du;
    dG1_du->z += std::copysign(1.0, u.z) / sigma;
  }
  return value;
}

double SlopeG1(const SlopeFrame& frame, const Vec3& u, double* gradient, Vec3* dG1_du, bool* clamped) {
  const double value = SlopeG1Unclamped(frame, u, gradient, dG1_du);
  const bool is_clamped = value > 1.0;
  if (clamped != nullptr) *clamped = is_clamped;
  if (!is_clamped) return value;
  if (gradient != nullptr) std::fill(gradient, gradient + 5, 0.0);
  if (dG1_du != nullptr) *dG1_du = {0.0, 0.0, 0.0};
  return 1.0;
}

}  // namespace lobefit

#include "lobefit/core/radial/slope_distribution.h"

#include <algorithm>

namespace lobefit {

SlopeQuadratic EvaluateSlopeQuadratic(const SlopeDistribution& s, double X, double Y) {
  const double x = X / s.alpha_x, y = Y / s.alpha_y;
  const double difference = (x - y) / (1.0 - s.r), sum = (x + y) / (1.0 + s.r);
  return {X,
          Y,
          0.5 * ((x - y) * difference + (x + y) * sum),
          (sum + difference) / s.alpha_x,
          (sum - difference) / s.alpha_y,
          0.5 * (difference * difference - sum * sum)};
}

double SlopeNormalisation(const SlopeDistribution& s) {
  return kInvPi / (s.alpha_x * s.alpha_y * std::sqrt((1.0 - s.r) * (1.0 + s.r)));
}

void FillSlopeGradient(const SlopeDistribution& s, const SlopeQuadratic& q, double value, double slope, double weight,
                       double* gradient) {
  gradient[0] = -value / s.alpha_x - slope * q.dX * q.X / s.alpha_x;
  gradient[1] = -value / s.alpha_y - slope * q.dY * q.Y / s.alpha_y;
  gradient[2] = value * s.r / ((1.0 - s.r) * (1.0 + s.r)) + slope * q.dr;
  gradient[3] = slope * q.dX * weight;
  gradient[4] = slope * q.dY * weight;
}

OffCenter OffCenterFromSlopes(const SlopeDistribution& s, double jacobian[25]) {
  if (jacobian != nullptr) {
    std::fill(jacobian, jacobian + 25, 0.0);
    jacobian[3] = jacobian[9] = 1.0;
    jacobian[10] = 2.0 * s.alpha_x;
    jacobian[15] = s.r * s.alpha_y;
    jacobian[16] = s.r * s.alpha_x;
    jacobian[17] = s.alpha_x * s.alpha_y;
    jacobian[21] = 2.0 * s.alpha_y;
  }
  return {s.slope_x, s.slope_y, s.alpha_x * s.alpha_x, s.r * s.alpha_x * s.alpha_y, s.alpha_y * s.alpha_y};
}

SlopeDistribution SlopesFromOffCenter(Family family, const OffCenter& o) {
  const double alpha_x = std::sqrt(o.q11), alpha_y = std::sqrt(o.q22);
  return {family, alpha_x, alpha_y, o.q12 / (alpha_x * alpha_y), o.slope_x, o.slope_y};
}

double SlopeP22(const SlopeDistribution& s, double x, double y, double* gradient) {
  const double X = x - s.slope_x, Y = y - s.slope_y;
  const SlopeQuadratic q = EvaluateSlopeQuadratic(s, X, Y);
  double value = SlopeNormalisation(s), slope;
  if (s.family == Family::kBeckmann) {
    value *= std::exp(-q.value);
    slope = -value;
  } else {
    value /= (1.0 + q.value) * (1.0 + q.value);
    slope = -2.0 * value / (1.0 + q.value);
  }
  if (gradient != nullptr) FillSlopeGradient(s, q, value, slope, -1.0, gradient);
  return value;
}

double SlopeDistributionD(const SlopeDistribution& s, const Vec3& wm, double* gradient, Vec3* dD_dwm) {
  if (!(wm.z > 0)) {
    if (gradient != nullptr) std::fill(gradient, gradient + kSlopeParameters, 0.0);
    if (dD_dwm != nullptr) *dD_dwm = {0.0, 0.0, 0.0};
    return 0.0;
  }
  // X m_z, Y m_z; GGX then needs no division by m_z and is finite at the horizon: P22 / m_z^4 = 1 / (pi ... (m_z^2 +
  // Q)^2).
  const double X = wm.x + s.slope_x * wm.z, Y = wm.y + s.slope_y * wm.z;
  const SlopeQuadratic q = EvaluateSlopeQuadratic(s, X, Y);
  const double zz = wm.z * wm.z;
  double value = SlopeNormalisation(s), slope, dz;
  if (s.family == Family::kBeckmann) {
    value *= std::exp(-q.value / zz) / (zz * zz);
    slope = -value / zz;
    dz = 2.0 * value * (q.value / zz - 2.0) / wm.z;
  } else {
    const double t = zz + q.value;
    value /= t * t;
    slope = -2.0 * value / t;
    dz = 2.0 * wm.z * slope;
  }
  if (gradient != nullptr) FillSlopeGradient(s, q, value, slope, wm.z, gradient);
  if (dD_dwm != nullptr) *dD_dwm = {slope * q.dX, slope * q.dY, dz + slope * (q.dX * s.slope_x + q.dY * s.slope_y)};
  return value;
}

}  // namespace lobefit

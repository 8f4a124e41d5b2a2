#include "lobefit/core/slopes/slope_sampling.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/slopes/slope_vector.h"

namespace lobefit {

double TruncatedRadius(double alpha, double r_min, double r_max, double v, TruncatedRadiusGradient* gradient) {
  const double alpha2 = alpha * alpha;
  const double a = alpha2 + r_min * r_min, b = alpha2 + r_max * r_max;
  // Numerator and denominator divided by B, so that r_max may be infinite.
  const double ratio = a / b, upper = r_max > 0 ? 1 / (1 + alpha2 / (r_max * r_max)) : 0;
  const double den = (1 - v) + v * ratio;
  const double s = std::sqrt(((1 - v) * r_min * r_min + v * upper * a) / den);
  if (gradient != nullptr) {
    // 1 / (alpha^2 + s^2) = w = (1 - v) / A + v / B; `den` = A w.
    const double gap = 1 - ratio > 0.5 ? 1 - ratio : (r_max - r_min) * (r_max + r_min) / b;  // A (1/A - 1/B)
    gradient->dalpha = alpha * v * (1 - v) * gap * gap / (s * den * den);
    gradient->dr_min = (1 - v) * (r_min / s) / (den * den);
    gradient->dr_max = std::isinf(r_max) ? 0 : v * (r_max / s) * ratio * ratio / (den * den);
    gradient->dv = gap * a / (2 * s * den * den);
  }
  return s;
}

double TruncatedRadiusMass(double alpha, double r_min, double r_max) {
  const double a = alpha * alpha + r_min * r_min;
  if (std::isinf(r_max)) return alpha * alpha / (2 * kPi * a);
  return alpha * alpha / (2 * kPi) * ((r_max - r_min) / a) * ((r_max + r_min) / (alpha * alpha + r_max * r_max));
}

GgxTriangleSampler::GgxTriangleSampler(const std::array<Vec2, 3>& vertices, double alpha_x, double alpha_y)
    : alpha_x_(alpha_x), alpha_y_(alpha_y), integral_(GgxTriangleIntegral(vertices, alpha_x, alpha_y)) {
  std::array<Vec2, 3> p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = {vertices[i].x / alpha_x, vertices[i].y / alpha_y};
  if (Cross2(p[1] - p[0], p[2] - p[0]) < 0) std::swap(p[1], p[2]);
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) inside = inside && Cross2(p[i], p[(i + 1) % 3]) >= 0;
  if (inside) {
    for (std::size_t i = 0; i < 3; ++i) AddSector(p[i], p[(i + 1) % 3], {0, 0});
    return;
  }
  // Seen from outside, the azimuths span less than pi: order the vertices, cut along the ray through the middle one.
  std::sort(p.begin(), p.end(), [](const Vec2& a, const Vec2& b) { return Cross2(a, b) > 0; });
  const Vec2 first = p[0], middle = p[1], last = p[2], side = last - first;
  const double along = Cross2(middle, first), den = along - Cross2(middle, last);
  const Vec2 opposite = den != 0 ? first + (along / den) * side : first;
  const bool middle_is_far = Dot2(middle, middle) > Dot2(opposite, opposite);
  for (const Vec2& corner : {first, last}) {
    AddSector(corner, middle_is_far ? middle : opposite, middle_is_far ? opposite : middle);
  }
}

void GgxTriangleSampler::AddSector(const Vec2& corner, const Vec2& far_end, const Vec2& near_end) {
  const double integral = GgxTriangleIntegral({corner, far_end, near_end}, 1, 1);
  sectors_[sector_count_++] = {corner, far_end - corner, near_end - corner, integral};
  sector_sum_ += integral;
}

Vec2 GgxTriangleSampler::Sample(double u, double v) const {
  double target = u * sector_sum_;
  std::size_t index = 0;
  while (index + 1 < sector_count_ && target > sectors_[index].integral) target -= sectors_[index++].integral;
  const Sector& sector = sectors_[index];
  target = std::fmin(target, sector.integral);
  // The ray at t meets the far side at F = corner + t far and the near one at (1 - gap) F.
  const double far_cross = Cross2(sector.corner, sector.far_side), near_cross = Cross2(sector.corner, sector.near_side);
  const double sides = Cross2(sector.far_side, sector.near_side);
  const bool from_origin =
      near_cross == 0 && sector.near_side.x == -sector.corner.x && sector.near_side.y == -sector.corner.y;
  const auto gap = [&](double t) { return from_origin ? 1.0 : t * sides / (near_cross + t * sides); };
  // Far beyond what a sample needs, and above the rounding of the integrals of thin far-away parts.
  constexpr double kSampleTolerance = 1e-12;
  double low = 0, high = 1, t = sector.integral > 0 ? target / sector.integral : 0.5;
  for (int step = 0; step < 60; ++step) {
    const Vec2 far_point = sector.corner + t * sector.far_side;
    const double g = gap(t), r2 = Dot2(far_point, far_point), near_r2 = (1 - g) * (1 - g) * r2;
    const Vec2 near_side =
        from_origin ? -1.0 * sector.corner : (t * far_cross / (near_cross + t * sides)) * sector.near_side;
    const double passed = GgxTriangleIntegral({sector.corner, far_point, sector.corner + near_side}, 1, 1);
    const double error = passed - target;
    (error > 0 ? high : low) = t;
    // d passed / dt = (1 / 2 pi) (R^2 / (1 + R^2) between the two sides) dtheta/dt
    const double slope = g * (2 - g) * std::fabs(far_cross) / (2 * kPi * (1 + r2) * (1 + near_r2));
    double next = t - error / slope;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    const bool done =
        std::fabs(next - t) <= kSampleTolerance * t || std::fabs(error) <= kSampleTolerance * sector.integral;
    t = next;
    if (done) break;
  }
  const Vec2 far_point = sector.corner + t * sector.far_side;
  const double r = std::sqrt(Dot2(far_point, far_point));
  const double g = std::clamp(gap(t), 0.0, 1.0);
  const double s = TruncatedRadius(1, (1 - g) * r, r, v);
  const double scale = r > 0 ? s / r : 0;
  return {scale * far_point.x * alpha_x_, scale * far_point.y * alpha_y_};
}

}  // namespace lobefit

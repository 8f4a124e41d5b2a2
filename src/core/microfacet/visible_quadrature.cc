#include "lobefit/core/microfacet/visible_quadrature.h"

#include <algorithm>
#include <utility>

namespace lobefit {

// Breaks in psi: towards the corners of the set, where one bound takes over from another, and at right angles to each
// bounding arc. There the bound on beta turns, within `width` = distance of the centre from the arc; geometric steps
// away from it resolve any width.
VisiblePolar::VisiblePolar(const Ellipsoid& outline, const Vec3& wo, VisibleNormals normals, const Vec3& second)
    : outline_(outline),
      rotation_(EllipsoidRotation(outline)),
      to_world_(Transposed(rotation_)),
      normals_(normals),
      wo_(wo) {
  const Vec3 n = {0, 0, 1};
  center_ = wo;
  facing_ = {n, wo};
  if (normals == VisibleNormals::kFacing) {
    center_ = Normalized(wo + second);
    facing_.push_back(second);
  }
  const Vec3 r = rotation_ * center_;
  const Vec3 x = {r.x / outline.alpha_x, r.y / outline.alpha_y, r.z};  // A^-T center
  center_scale_ = 1.0 / Norm(x);
  x0_ = center_scale_ * x;
  const Vec3 helper = std::abs(x0_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  e1_ = Normalized(helper - Dot(helper, x0_) * x0_);
  e2_ = Cross(x0_, e1_);

  std::vector<double> at;
  const auto add = [&](const Vec3& direction) {  // direction in the space of x
    const double c = Dot(direction, e1_), s = Dot(direction, e2_);
    if (std::hypot(c, s) > 0) at.push_back(std::atan2(s, c));
  };
  const auto add_bound = [&](const Vec3& v, const auto& distance) {
    const Vec3 av = Stretched(v);
    const double c = Dot(av, e1_), s = Dot(av, e2_), length = std::hypot(c, s);
    if (!(length > 0)) return;
    for (const double side : {-0.5 * kPi, 0.5 * kPi}) {
      const double center = std::atan2(s, c) + side, width = distance(center) / length;
      at.push_back(std::remainder(center, 2 * kPi));
      for (double step = width; step < 0.3; step *= 8) {
        at.push_back(std::remainder(center - step, 2 * kPi));
        at.push_back(std::remainder(center + step, 2 * kPi));
        if (!(step > 0)) break;
      }
    }
  };
  if (normals == VisibleNormals::kReflectUp) {
    add_bound(n - wo.z * wo, [&](double psi) {
      const Vec3 back = Back(Axis(psi));
      return wo.z * Norm(back - Dot(back, wo) * wo);
    });
  } else {
    for (std::size_t i = 0; i < facing_.size(); ++i) {
      const double distance = Dot(x0_, Stretched(facing_[i]));
      add_bound(facing_[i], [distance](double) { return distance; });
      for (std::size_t j = 0; j < i; ++j) {
        const Vec3 corner = rotation_ * Cross(facing_[i], facing_[j]);
        const Vec3 back = {corner.x / outline.alpha_x, corner.y / outline.alpha_y, corner.z};
        add(back);
        add(-back);
      }
    }
  }
  std::sort(at.begin(), at.end());
  azimuth_breaks_ = {-kPi};
  for (const double psi : at) {
    if (psi > azimuth_breaks_.back() + 1e-12 && psi < kPi - 1e-12) azimuth_breaks_.push_back(psi);
  }
  azimuth_breaks_.push_back(kPi);
}

Vec3 VisiblePolar::Stretched(const Vec3& m) const {
  const Vec3 v = rotation_ * m;
  return {outline_.alpha_x * v.x, outline_.alpha_y * v.y, v.z};
}

Vec3 VisiblePolar::Back(const Vec3& x) const {
  return to_world_ * Vec3{outline_.alpha_x * x.x, outline_.alpha_y * x.y, x.z};
}

double VisiblePolar::Sample(double beta, double psi, Vec3* m) const {
  const double sin_beta = std::sin(beta);
  const Vec3 v = Back(std::cos(beta) * x0_ + sin_beta * Axis(psi));
  const double length = Norm(v);
  *m = (1.0 / length) * v;
  return outline_.alpha_x * outline_.alpha_y / (length * length * length) * sin_beta;
}

void VisiblePolar::PolarBreaks(double psi, std::vector<double>* breaks) const {
  // The arc in the space of normals: cos(beta) scale center + sin(beta) (along center + across axis).
  const Vec3 e = Axis(psi), back = Back(e);
  const double along = Dot(back, center_);
  const Vec3 perpendicular = back - along * center_;
  const double across = Norm(perpendicular);
  const Vec3 axis = (1.0 / across) * perpendicular;
  double high = kPi;  // angle between the centre and m
  if (normals_ == VisibleNormals::kReflectUp) {
    high = 0.5 * std::atan2(wo_.z, -axis.z);
  } else {
    for (const Vec3& v : facing_) high = std::min(high, std::atan2(Dot(center_, v), -Dot(axis, v)));
  }
  const double end = std::atan2(center_scale_ * std::sin(high), across * std::cos(high) - along * std::sin(high));
  breaks->clear();
  breaks->push_back(0.0);
  // Where the arc crosses the equator of x, normals turn by nearly 180 degrees within an angle of alpha.
  const double equator = std::atan2(std::abs(x0_.z), x0_.z > 0 ? -e.z : e.z);
  const double width = std::min(1.0, std::max(outline_.alpha_x, outline_.alpha_y));
  for (const double step : {-4.0, -1.0, 0.0, 1.0, 4.0}) {
    const double beta = equator + step * width;
    if (beta > breaks->back() && beta < end) breaks->push_back(beta);
  }
  if (end > breaks->back()) breaks->push_back(end);
}

}  // namespace lobefit

#include "lobefit/core/sel/sel_cosine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "lobefit/math/rotation.h"

namespace lobefit {
namespace {

// Integrals over part of the sphere of K v (three components) and of dK/dalpha_x, dK/dalpha_y times the cosine.
using Moments = std::array<double, 5>;

class HalfCircle {
 public:
  HalfCircle(double alpha_x, double alpha_y, const Vec3& normal, SelKink kink, double psi)
      : alpha_x_(alpha_x), alpha_y_(alpha_y), normal_(normal), kink_(kink) {
    const double x = alpha_x * std::cos(psi), y = alpha_y * std::sin(psi);
    rho_ = std::hypot(x, y);
    cos_phi_ = x / rho_;
    sin_phi_ = y / rho_;
    jacobian_ = alpha_x * alpha_y / (rho_ * rho_);  // dphi/dpsi
  }

  Moments At(double tau) const {
    const double s = rho_ * std::sin(0.5 * tau), c = std::cos(0.5 * tau);
    const double den = c * c + s * s;
    const double sin_theta = 2 * s * c / den;
    const Vec3 v = {sin_theta * cos_phi_, sin_theta * sin_phi_, (c - s) * (c + s) / den};
    SelLobeGradient lobe;
    const double k = SelLobe(alpha_x_, alpha_y_, v, &lobe, kink_);
    const double weight = jacobian_ * sin_theta * rho_ / den;  // times dtheta/dtau
    const double cosine = weight * Dot(normal_, v);
    return {weight * k * v.x, weight * k * v.y, weight * k * v.z, cosine * lobe.dalpha_x, cosine * lobe.dalpha_y};
  }

  // Where normal . v > 0 on this half circle.
  Moments Integrate(const QuadratureOptions& options) const {
    const double across = normal_.x * cos_phi_ + normal_.y * sin_phi_;
    double from = 0, to = kPi;
    if (normal_.z > 0) {
      to = TauOf(std::atan2(normal_.z, -across));
    } else if (normal_.z < 0) {
      from = TauOf(std::atan2(-normal_.z, across));
    } else if (across <= 0) {
      return {};
    }
    // Near tau = pi the whole lower part of the sphere passes within a width of rho.
    std::vector<double> breaks = {from};
    for (const double b : {0.5 * kPi, kPi - std::min(1.0, 4 * rho_)}) {
      if (b > breaks.back() && b < to) breaks.push_back(b);
    }
    breaks.push_back(to);
    return IntegrateAdaptive<5>([this](double tau) { return At(tau); }, breaks, options).value;
  }

 private:
  double TauOf(double theta) const { return 2 * std::atan2(std::sin(0.5 * theta), rho_ * std::cos(0.5 * theta)); }

  double alpha_x_, alpha_y_;
  Vec3 normal_;
  SelKink kink_;
  double rho_, cos_phi_, sin_phi_, jacobian_;
};

}  // namespace

double SelCosineIntegral(double alpha_x, double alpha_y, const Vec3& rotation, const Vec3& normal,
                         SelGradient* gradient, SelKink kink, const QuadratureOptions& options) {
  const Mat3 r = RotationMatrix(rotation);
  const Vec3 n = r * normal;
  // The integrand needs finite derivatives for the error estimate; NaN is given back at the end if it was asked for.
  const bool undefined = alpha_x == alpha_y && kink == SelKink::kNone;
  const SelKink side = undefined ? SelKink::kAlphaXLarger : kink;
  QuadratureOptions inner = options;
  inner.relative = 0.1 * options.relative;
  // The half circles at right angles to the normal's azimuth, where the clamp's place moves fastest when the normal is
  // near the equator.
  const double right = std::atan2(-n.x * alpha_x, n.y * alpha_y);
  std::vector<double> breaks;
  for (int i = -3; i <= 3; ++i) {
    for (const double angle : {right + i * kPi, i * 0.5 * kPi}) {
      if (angle >= 0 && angle <= 2 * kPi) breaks.push_back(angle);
    }
  }
  breaks.push_back(0);
  breaks.push_back(2 * kPi);
  std::sort(breaks.begin(), breaks.end());
  const Moments moments =
      IntegrateAdaptive<5>([&](double psi) { return HalfCircle(alpha_x, alpha_y, n, side, psi).Integrate(inner); },
                           breaks, options)
          .value;
  const Vec3 irradiance = {moments[0], moments[1], moments[2]};
  if (gradient != nullptr) {
    gradient->dalpha_x = undefined ? std::nan("") : moments[3];
    gradient->dalpha_y = undefined ? std::nan("") : moments[4];
    gradient->drotation = Transposed(RotationLeftJacobian(rotation)) * Cross(n, irradiance);
    gradient->ddirection = Transposed(r) * irradiance;
  }
  return Dot(n, irradiance);
}

}  // namespace lobefit

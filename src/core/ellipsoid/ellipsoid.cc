#include "lobefit/core/ellipsoid/ellipsoid.h"

#include <algorithm>

#include "lobefit/core/ellipsoid/weighted_form.h"

namespace lobefit {

Mat3 EllipsoidRotation(const Ellipsoid& ellipsoid) {
  const double p[5] = {ellipsoid.alpha_x, ellipsoid.alpha_y, ellipsoid.theta_x, ellipsoid.theta_y, ellipsoid.theta_z};
  return EllipsoidRotation(p);
}

EllipsoidFrame::EllipsoidFrame(const Ellipsoid& ellipsoid)
    : alpha_x_(ellipsoid.alpha_x), alpha_y_(ellipsoid.alpha_y), rotation_(EllipsoidRotation(ellipsoid)) {
  const Vec3 n = {rotation_.row[0].z, rotation_.row[1].z,
                  rotation_.row[2].z};  // the macro normal in the ellipsoid's frame
  turn_axis_ = {{{1.0, 0.0, 0.0}, {0.0, std::cos(ellipsoid.theta_x), std::sin(ellipsoid.theta_x)}, n}};
  const FormWeights weights = ShapeWeights(alpha_x_, alpha_y_);
  norm2_an_ = Form(weights, n, n);
  dnorm2_an_ = {2.0 * alpha_x_ * n.x * n.x, 2.0 * alpha_y_ * n.y * n.y, FormTurned(weights, n, n, turn_axis_[0]),
                FormTurned(weights, n, n, turn_axis_[1]), 0.0};
}

// ln D = -ln(pi ax ay) - ln|An| - 2 ln W, W = |S^-1 R m|^2.
double EllipsoidFrame::D(const Vec3& wm, double* gradient, Vec3* dD_dwm) const {
  if (wm.z < 0) {
    if (gradient != nullptr) std::fill(gradient, gradient + kEllipsoidParameters, 0.0);
    if (dD_dwm != nullptr) *dD_dwm = {0.0, 0.0, 0.0};
    return 0.0;
  }
  const Vec3 v = rotation_ * wm;
  const double wx = v.x / alpha_x_, wy = v.y / alpha_y_;
  const double ww = wx * wx + wy * wy + v.z * v.z;
  const double value = kInvPi / (alpha_x_ * alpha_y_ * std::sqrt(norm2_an_) * ww * ww);
  if (gradient != nullptr) {
    const FormWeights weights = InverseWeights(alpha_x_, alpha_y_);
    gradient[0] = value * (-(1.0 - 4.0 * wx * wx / ww) / alpha_x_ - 0.5 * dnorm2_an_[0] / norm2_an_);
    gradient[1] = value * (-(1.0 - 4.0 * wy * wy / ww) / alpha_y_ - 0.5 * dnorm2_an_[1] / norm2_an_);
    for (std::size_t k = 0; k < 3; ++k) {
      gradient[2 + k] =
          value * (-0.5 * dnorm2_an_[2 + k] / norm2_an_ - 2.0 * FormTurned(weights, v, v, turn_axis_[k]) / ww);
    }
  }
  if (dD_dwm != nullptr) {
    const Vec3 t = {wx / alpha_x_, wy / alpha_y_, v.z};
    *dD_dwm = (-4.0 * value / ww) * (Transposed(rotation_) * t);
  }
  return value;
}

// sigma = N / (2 nn), N = s + d, d = Au.An, s = sqrt(d^2 + cc), cc = |Au x An|^2; N s' = ... so dN = (N dd + dcc / 2) /
// s.
double EllipsoidFrame::Sigma(const Vec3& u, double* gradient, Vec3* dsigma_du) const {
  const Vec3 p = rotation_ * u;
  const Vec3& n = turn_axis_[2];
  const Vec3 e = rotation_ * Vec3{u.y, -u.x, 0.0};  // u x n
  const FormWeights shape = ShapeWeights(alpha_x_, alpha_y_);
  const FormWeights cofactor = CofactorWeights(alpha_x_, alpha_y_);
  const double d = Form(shape, p, n);
  const double cc = Form(cofactor, e, e);
  const double s = std::sqrt(d * d + cc);
  const double sum = d >= 0 ? s + d : cc / (s - d);
  const double value = sum / (2.0 * norm2_an_);
  if (gradient != nullptr) {
    double dd[5], dcc[5];
    dd[0] = 2.0 * alpha_x_ * p.x * n.x;
    dd[1] = 2.0 * alpha_y_ * p.y * n.y;
    dcc[0] = 2.0 * alpha_x_ * (e.y * e.y + alpha_y_ * alpha_y_ * e.z * e.z);
    dcc[1] = 2.0 * alpha_y_ * (e.x * e.x + alpha_x_ * alpha_x_ * e.z * e.z);
    for (std::size_t k = 0; k < 3; ++k) {
      dd[2 + k] = FormTurned(shape, p, n, turn_axis_[k]);
      dcc[2 + k] = FormTurned(cofactor, e, e, turn_axis_[k]);
    }
    for (std::size_t k = 0; k < kEllipsoidParameters; ++k) {
      gradient[k] = (0.5 * (sum * dd[k] + 0.5 * dcc[k]) / s - value * dnorm2_an_[k]) / norm2_an_;
    }
  }
  if (dsigma_du != nullptr) {
    const Mat3 to_world = Transposed(rotation_);
    const Vec3 dd = to_world * Vec3{shape.x * n.x, shape.y * n.y, shape.z * n.z};
    const Vec3 half_dcc_de = to_world * Vec3{cofactor.x * e.x, cofactor.y * e.y, cofactor.z * e.z};
    const Vec3 half_dcc = {-half_dcc_de.y, half_dcc_de.x, 0.0};
    *dsigma_du = (0.5 / (norm2_an_ * s)) * (sum * dd + half_dcc);
  }
  return value;
}

// sigma - u_z = (sigma - c) + (c - u_z), c = d / nn: the first is cc / (2 nn (s + d)), the second (A n . A (u - u_z n))
// / nn.
double EllipsoidFrame::Lambda(const Vec3& u, double* gradient) const {
  const double sigma = Sigma(u, gradient);
  if (gradient != nullptr) {
    for (int k = 0; k < kEllipsoidParameters; ++k) gradient[k] /= u.z;
  }
  const Vec3& n = turn_axis_[2];
  const FormWeights shape = ShapeWeights(alpha_x_, alpha_y_);
  const double d = Form(shape, rotation_ * u, n);
  if (d < 0) return sigma / u.z - 1.0;
  const Vec3 e = rotation_ * Vec3{u.y, -u.x, 0.0};
  const double cc = Form(CofactorWeights(alpha_x_, alpha_y_), e, e);
  const double level = FormOfPerpendicular(shape, rotation_ * Vec3{u.x, u.y, 0.0}, n);
  return (0.5 * cc / (std::sqrt(d * d + cc) + d) + level) / (norm2_an_ * u.z);
}

// u.z > sigma  <=>  s < d + 2 e, e = nn u.z - d = -An.A(u_x, u_y, 0)  <=>  e > 0 and cc < 4 e nn u.z.
bool EllipsoidFrame::Clamped(const Vec3& u) const {
  const Vec3 across = rotation_ * Vec3{u.x, u.y, 0.0};
  const double e = -FormOfPerpendicular(ShapeWeights(alpha_x_, alpha_y_), across, turn_axis_[2]);
  if (!(e > 0)) return false;
  const Vec3 c = rotation_ * Vec3{u.y, -u.x, 0.0};
  return Form(CofactorWeights(alpha_x_, alpha_y_), c, c) < 4.0 * e * norm2_an_ * u.z;
}

double EllipsoidD(const Ellipsoid& ellipsoid, const Vec3& wm, double* gradient, Vec3* dD_dwm) {
  return EllipsoidFrame(ellipsoid).D(wm, gradient, dD_dwm);
}

double EllipsoidSigma(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient, Vec3* dsigma_du) {
  return EllipsoidFrame(ellipsoid).Sigma(u, gradient, dsigma_du);
}

double EllipsoidG1Unclamped(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient) {
  const double sigma = EllipsoidSigma(ellipsoid, u, gradient);
  const double value = std::abs(u.z) / sigma;
  if (gradient != nullptr) {
    for (int k = 0; k < kEllipsoidParameters; ++k) gradient[k] *= -value / sigma;
  }
  return value;
}

double EllipsoidG1(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient, bool* clamped) {
  const double value = EllipsoidG1Unclamped(ellipsoid, u, gradient);
  const bool is_clamped = u.z > 0 ? EllipsoidFrame(ellipsoid).Clamped(u) : value > 1.0;
  if (clamped != nullptr) *clamped = is_clamped;
  if (!is_clamped) return std::min(1.0, value);
  if (gradient != nullptr) std::fill(gradient, gradient + kEllipsoidParameters, 0.0);
  return 1.0;
}

}  // namespace lobefit

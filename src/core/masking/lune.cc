#include "lobefit/core/masking/lune.h"

#include "lobefit/core/ellipsoid/weighted_form.h"

namespace lobefit {
namespace {

constexpr std::size_t kCount = kEllipsoidParameters;

// |A p|^2 and its gradient, p in the ellipsoid's frame.
double NormSquared(const Ellipsoid& e, const EllipsoidFrame& frame, const FormWeights& shape, const Vec3& p,
                   std::array<double, kCount>* gradient) {
  if (gradient != nullptr) {
    (*gradient)[0] = 2.0 * e.alpha_x * p.x * p.x;
    (*gradient)[1] = 2.0 * e.alpha_y * p.y * p.y;
    for (std::size_t k = 0; k < 3; ++k)
      (*gradient)[2 + k] = FormTurned(shape, p, p, frame.turn_axis(static_cast<int>(k)));
  }
  return Form(shape, p, p);
}

}  // namespace

double EllipsoidProjectedArea(const Ellipsoid& ellipsoid, const Vec3& u, double* gradient) {
  const EllipsoidFrame frame(ellipsoid);
  const FormWeights shape = ShapeWeights(ellipsoid.alpha_x, ellipsoid.alpha_y);
  std::array<double, kCount> duu;
  const double uu = NormSquared(ellipsoid, frame, shape, frame.rotation() * u, gradient != nullptr ? &duu : nullptr);
  const double nn = frame.norm2_an();
  const double value = std::sqrt(uu / nn);
  if (gradient != nullptr) {
    for (std::size_t k = 0; k < kCount; ++k) gradient[k] = 0.5 * value * (duu[k] / uu - frame.dnorm2_an()[k] / nn);
  }
  return value;
}

// A_l = N / (2 |An| |Av|), N = s + d, s = sqrt(d^2 + cc), d = Au.Av, cc = |Au x Av|^2 = |S* R (u x v)|^2; dN = (N dd +
// dcc / 2) / s.
double EllipsoidLuneArea(const Ellipsoid& ellipsoid, const Vec3& u, const Vec3& v, double* gradient, Vec3* dA_du,
                         Vec3* dA_dv) {
  const double ax = ellipsoid.alpha_x, ay = ellipsoid.alpha_y;
  const EllipsoidFrame frame(ellipsoid);
  const FormWeights shape = ShapeWeights(ax, ay), cofactor = CofactorWeights(ax, ay);
  const Vec3 p = frame.rotation() * u, q = frame.rotation() * v, e = frame.rotation() * Cross(u, v);
  std::array<double, kCount> dvv;
  const double vv = NormSquared(ellipsoid, frame, shape, q, gradient != nullptr ? &dvv : nullptr);
  const double nn = frame.norm2_an();
  const double d = Form(shape, p, q), cc = Form(cofactor, e, e);
  const double s = std::sqrt(d * d + cc);
  const double sum = d >= 0 ? s + d : cc / (s - d);
  const double scale = 0.5 / (std::sqrt(nn) * std::sqrt(vv));
  const double value = sum * scale;
  if (gradient != nullptr) {
    double dd[kCount] = {2.0 * ax * p.x * q.x, 2.0 * ay * p.y * q.y};
    double dcc[kCount] = {2.0 * ax * (e.y * e.y + ay * ay * e.z * e.z), 2.0 * ay * (e.x * e.x + ax * ax * e.z * e.z)};
    for (int k = 0; k < 3; ++k) {
      dd[2 + k] = FormTurned(shape, p, q, frame.turn_axis(k));
      dcc[2 + k] = FormTurned(cofactor, e, e, frame.turn_axis(k));
    }
    for (std::size_t k = 0; k < kCount; ++k) {
      gradient[k] = scale * (sum * dd[k] + 0.5 * dcc[k]) / s - 0.5 * value * (dvv[k] / vv + frame.dnorm2_an()[k] / nn);
    }
  }
  if (dA_du != nullptr || dA_dv != nullptr) {
    const Mat3 to_world = Transposed(frame.rotation());
    const auto weighted = [&](const FormWeights& w, const Vec3& x) {
      return to_world * Vec3{w.x * x.x, w.y * x.y, w.z * x.z};
    };
    const Vec3 mu = weighted(shape, p), mv = weighted(shape, q), ke = weighted(cofactor, e);
    if (dA_du != nullptr) *dA_du = (scale / s) * (sum * mv + Cross(v, ke));
    if (dA_dv != nullptr) *dA_dv = (scale / s) * (sum * mu - Cross(u, ke)) - (value / vv) * mv;
  }
  return value;
}

}  // namespace lobefit

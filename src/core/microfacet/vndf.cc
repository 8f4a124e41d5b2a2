#include "lobefit/core/microfacet/vndf.h"

#include <algorithm>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Unit vectors a = A psi, b = A n and a frame about a, in the space where the ellipsoid is the unit sphere.
struct LuneFrame {
  LuneFrame(const Ellipsoid& ellipsoid, const Mat3& rotation, const Vec3& psi) {
    const double ax = ellipsoid.alpha_x, ay = ellipsoid.alpha_y;
    const Vec3 v = rotation * psi, n = {rotation.row[0].z, rotation.row[1].z, rotation.row[2].z};
    const Vec3 a_psi = {ax * v.x, ay * v.y, v.z}, a_n = {ax * n.x, ay * n.y, n.z};
    const double norms = Norm(a_psi) * Norm(a_n);
    a = Normalized(a_psi);
    b = Normalized(a_n);
    // (A psi) x (A n) = |A| A^-T (psi x n): no cancellation where the two are nearly parallel.
    const Vec3 w = rotation * Vec3{psi.y, -psi.x, 0};
    const Vec3 cross = {ay * w.x, ax * w.y, ax * ay * w.z};
    const double sine = Norm(cross) / norms, cosine = Dot(a, b);
    one_plus_cos = cosine < 0 ? sine * sine / (1 - cosine) : 1 + cosine;
    one_minus_cos = cosine > 0 ? sine * sine / (1 + cosine) : 1 - cosine;
    if (sine > 0) {
      e2 = (1 / Norm(cross)) * cross;
      e2 = Normalized(e2 - Dot(e2, a) * a);
    } else {
      e2 = Normalized(Cross(a, std::fabs(a.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    }
    e1 = Cross(e2, a);
  }
  Vec3 a, b, e1, e2;
  double one_plus_cos, one_minus_cos;
};

}  // namespace

double EllipsoidVndfPdf(const Ellipsoid& ellipsoid, const Vec3& psi, const Vec3& m, double* gradient, Vec3* dpdf_dpsi,
                        Vec3* dpdf_dm) {
  const EllipsoidFrame frame(ellipsoid);
  const double cosine = Dot(m, psi);
  std::array<double, kEllipsoidParameters> dd{}, dsigma{};
  Vec3 dd_dm{}, dsigma_dpsi{};
  const double d = frame.D(m, gradient != nullptr ? dd.data() : nullptr, dpdf_dm != nullptr ? &dd_dm : nullptr);
  const double sigma =
      frame.Sigma(psi, gradient != nullptr ? dsigma.data() : nullptr, dpdf_dpsi != nullptr ? &dsigma_dpsi : nullptr);
  const bool visible = cosine > 0 && d > 0;
  const double pdf = visible ? d * cosine / sigma : 0;
  if (gradient != nullptr) {
    for (int i = 0; i < kEllipsoidParameters; ++i)
      gradient[i] = visible ? (dd[i] * cosine - pdf * dsigma[i]) / sigma : 0;
  }
  if (dpdf_dpsi != nullptr) *dpdf_dpsi = visible ? (1 / sigma) * (d * m - pdf * dsigma_dpsi) : Vec3{0, 0, 0};
  if (dpdf_dm != nullptr) *dpdf_dm = visible ? (1 / sigma) * (cosine * dd_dm + d * psi) : Vec3{0, 0, 0};
  return pdf;
}

double EllipsoidReflectionPdf(const Ellipsoid& ellipsoid, const Vec3& psi, const Vec3& omega) {
  // The visible normals' D / (4 sigma): the cosine with the half vector is in pdf and Jacobian alike.
  const Vec3 half = HalfVector(psi, omega);
  const EllipsoidFrame frame(ellipsoid);
  return frame.D(half) / (4 * frame.Sigma(psi));
}

double EllipsoidReflectionWeight(const Ellipsoid& ellipsoid, const Vec3& psi, const Vec3& omega) {
  if (omega.z <= 0) return 0;
  const EllipsoidFrame frame(ellipsoid);
  return std::fmin(1.0, omega.z / frame.Sigma(omega)) * std::fmin(1.0, frame.Sigma(psi) / psi.z);
}

Vec3 EllipsoidMeanVisibleNormal(const Ellipsoid& ellipsoid, const Vec3& psi,
                                std::array<Vec3, kEllipsoidParameters>* gradient, const QuadratureOptions& options) {
  const EllipsoidFrame frame(ellipsoid);
  const Mat3& rotation = frame.rotation();
  const LuneFrame lune(ellipsoid, rotation, psi);
  const double width =
      std::atan2(std::sqrt(lune.one_plus_cos * lune.one_minus_cos), 1 - lune.one_plus_cos);  // pi - angle(a, b)
  std::array<double, kEllipsoidParameters> dsigma{};
  const double sigma = frame.Sigma(psi, dsigma.data());
  constexpr std::size_t kTotal = 3 * (1 + kEllipsoidParameters);
  // x = cos t cos s e1 + sin t e2 + cos t sin s a over |t| < pi/2, 0 < s < width; density 2/pi cos^2 t sin s / (1 +
  // cos).
  const auto at = [&](double t, double s) {
    const double c = std::cos(t);
    const Vec3 x = (c * std::cos(s)) * lune.e1 + std::sin(t) * lune.e2 + (c * std::sin(s)) * lune.a;
    const Vec3 m = Normalized(Transposed(rotation) * Vec3{ellipsoid.alpha_x * x.x, ellipsoid.alpha_y * x.y, x.z});
    const double weight = 2 * kInvPi * c * c * std::sin(s) / lune.one_plus_cos;
    std::array<double, kTotal> result{};
    const auto store = [&](std::size_t index, double factor) {
      result[3 * index] = factor * m.x;
      result[3 * index + 1] = factor * m.y;
      result[3 * index + 2] = factor * m.z;
    };
    store(0, weight);
    if (gradient == nullptr) return result;
    std::array<double, kEllipsoidParameters> dd{};
    const double d = frame.D({m.x, m.y, std::fmax(m.z, 0.0)}, dd.data());
    for (std::size_t i = 0; i < kEllipsoidParameters; ++i) store(i + 1, weight * (dd[i] / d - dsigma[i] / sigma));
    return result;
  };
  QuadratureOptions inner = options;
  inner.relative = 0.1 * options.relative;
  inner.absolute = 0.1 * options.absolute;
  const auto outer = [&](double t) {
    return IntegrateAdaptive<kTotal>([&](double s) { return at(t, s); }, {0, width}, inner).value;
  };
  const std::array<double, kTotal> total = IntegrateAdaptive<kTotal>(outer, {-0.5 * kPi, 0, 0.5 * kPi}, options).value;
  const auto mean = [&](std::size_t index) {
    return Vec3{total[3 * index], total[3 * index + 1], total[3 * index + 2]};
  };
  if (gradient != nullptr) {
    for (std::size_t i = 0; i < kEllipsoidParameters; ++i) (*gradient)[i] = mean(i + 1);
  }
  return mean(0);
}

EllipsoidVndfSampler::EllipsoidVndfSampler(const Ellipsoid& ellipsoid, const Vec3& psi)
    : alpha_x_(ellipsoid.alpha_x), alpha_y_(ellipsoid.alpha_y), rotation_(EllipsoidRotation(ellipsoid)), psi_(psi) {
  const LuneFrame lune(ellipsoid, rotation_, psi);
  a_ = lune.a;
  b_ = lune.b;
  e1_ = lune.e1;
  e2_ = lune.e2;
  one_plus_cos_ = lune.one_plus_cos;
  one_minus_cos_ = lune.one_minus_cos;
}

Vec3 EllipsoidVndfSampler::NormalAt(const Vec3& x) const {
  return Normalized(Transposed(rotation_) * Vec3{alpha_x_ * x.x, alpha_y_ * x.y, x.z});
}

Vec3 EllipsoidVndfSampler::Sample(double u1, double u2) const {
  const double r = std::sqrt(u1), phi = 2 * kPi * u2;
  const double d1 = r * std::cos(phi), d2 = r * std::sin(phi);
  const double h = std::sqrt(std::fmax(0.0, (1 - d2) * (1 + d2)));
  const double x1 = 0.5 * (one_plus_cos_ * d1 + one_minus_cos_ * h);
  // h - x1 and h + x1 without their cancellation for narrow lunes.
  const double x3 =
      0.5 * std::sqrt(std::fmax(0.0, one_plus_cos_ * (h - d1) * (one_plus_cos_ * d1 + (2 + one_minus_cos_) * h)));
  Vec3 m = NormalAt(x1 * e1_ + d2 * e2_ + x3 * a_);
  m.z = std::fmax(m.z, 0.0);  // rounding alone can put the rim of the lune below the horizon
  return m;
}

Vec3 EllipsoidVndfSampler::OnSphere(double u1, double u2) const {
  const double r = std::sqrt(u1), phi = 2 * kPi * u2;
  return (r * std::cos(phi)) * e1_ + (r * std::sin(phi)) * e2_ + std::sqrt(1 - u1) * a_;
}

bool EllipsoidVndfSampler::HitFromSphere(double u1, double u2, Vec3* m) const {
  // The ellipsoid |A p| = 1 has semi-axes 1/alpha_x, 1/alpha_y, 1.
  const double radius = 1 / std::min({alpha_x_, alpha_y_, 1.0});
  const Vec3 across = Normalized(Cross(psi_, std::fabs(psi_.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const double r = radius * std::sqrt(u1), phi = 2 * kPi * u2;
  const Vec3 q = (r * std::cos(phi)) * across + (r * std::sin(phi)) * Cross(psi_, across);
  const auto scaled = [&](const Vec3& w) {
    const Vec3 v = rotation_ * w;
    return Vec3{alpha_x_ * v.x, alpha_y_ * v.y, v.z};
  };
  const Vec3 o = scaled(q), d = scaled(psi_);
  // The hit nearest to the viewer is the larger root of |o + t d| = 1.
  const double dd = Dot(d, d), od = Dot(o, d);
  const Vec3 moment = Cross(o, d);
  const double discriminant = dd - Dot(moment, moment);
  if (discriminant < 0) return false;
  const Vec3 x = o + ((std::sqrt(discriminant) - od) / dd) * d;
  *m = NormalAt(x);
  return m->z >= 0;
}

}  // namespace lobefit

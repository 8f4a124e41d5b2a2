#include "lobefit/maps/engine/shape.h"

#include <cmath>

#include "lobefit/maps/engine/kernels.h"

namespace lobefit {
namespace {

// Derivatives of the frame's axes t and b where n moves by dn.
MapFrame FrameDerivative(const Vec3& n, const Vec3& dn) {
  const double q = 1 / (1 + n.z), dq = -q * q * dn.z;
  const double dxy = -(dn.x * n.y * q + n.x * dn.y * q + n.x * n.y * dq);
  return {
      {-(2 * n.x * dn.x * q + n.x * n.x * dq), dxy, -dn.x}, {dxy, -(2 * n.y * dn.y * q + n.y * n.y * dq), -dn.y}, dn};
}

Vec3 Local(const MapFrame& f, double x, double y, double z) {
  return {f.t.x * x + f.t.y * y + f.t.z * z, f.b.x * x + f.b.y * y + f.b.z * z, f.n.x * x + f.n.y * y + f.n.z * z};
}

// Two widths and a direction, core/brdf/ggx_lobe-inl.h with a mean slope of 0, in the frame of the normal:
//   specular = |h|^4 i_z / (pi a c K^2 (i_z + s_i) (o_z + s_o)), s(u)^2 = u_z^2 + q1^2 + q2^2, q1 = a u_x + b u_y, q2 =
//   c u_y.
struct Widths {
  double a, b, c;
};

// ln (u_z + s) and its derivatives by u and by (ln a, b, ln c).
struct LogSum {
  double value, s;
  Vec3 by_u;
  double by_width[3];
};
LogSum LogSumOf(const Widths& w, const Vec3& u) {
  const double q1 = w.a * u.x + w.b * u.y, q2 = w.c * u.y, s = std::sqrt(u.z * u.z + q1 * q1 + q2 * q2);
  const double sum = u.z + s, f = 1 / (s * sum);
  return {sum,
          s,
          {f * q1 * w.a, f * (q1 * w.b + q2 * w.c), f * (s + u.z)},
          {f * q1 * w.a * u.x, f * q1 * u.y, f * q2 * q2}};
}

void Anisotropic(const MapPoint& point, const MapFrame& frame, const LightArrays& lights, bool gradient,
                 ShapeArrays* out) {
  const Widths w = {std::exp(point.width[0]), point.width[1], std::exp(point.width[2])};
  const MapFrame turned[2] = {FrameDerivative(frame.n, frame.t), FrameDerivative(frame.n, frame.b)};
  const Vec3 o = Local(frame, 0, 0, 1);
  const LogSum sum_o = LogSumOf(w, o);
  for (std::size_t l = 0; l < lights.padded; ++l) {
    const Vec3 i = Local(frame, lights.x[l], lights.y[l], lights.z[l]);
    const bool lit = i.z > 0;
    const Vec3 h = i + o;
    const double square = lights.square[l];
    const double y1 = -h.x / w.a, y2 = (-h.y - w.b * y1) / w.c, K = h.z * h.z + y1 * y1 + y2 * y2;
    const LogSum sum_i = LogSumOf(w, i);
    const double rest = kInvPi * square * square / (w.a * w.c * K * K * sum_i.value * sum_o.value);
    const double value = lit ? rest * i.z : 0;
    out->specular[l] = value;
    if (!gradient) continue;
    // dK by h and by the widths: y2 moves with b and y1.
    const double z2 = y2 / w.c, z1 = (y1 - w.b * z2) / w.a, f = 2 / K;
    const Vec3 by_h = {-2 * f * -z1, -2 * f * -z2, -2 * f * h.z};  // d ln K^-2
    const double by_width[3] = {2 * f * w.a * z1 * y1 - 1, 2 * f * z2 * y1, 2 * f * w.c * z2 * y2 - 1};
    for (int j = 0; j < 3; ++j) {
      out->dspecular[2 + j][l] = value * (by_width[j] - sum_i.by_width[j] - sum_o.by_width[j]);
    }
    for (int j = 0; j < 2; ++j) {
      const Vec3 di = Local(turned[j], lights.x[l], lights.y[l], lights.z[l]), dout = Local(turned[j], 0, 0, 1);
      const double dlog = Dot(by_h, di + dout) - Dot(sum_i.by_u, di) - Dot(sum_o.by_u, dout);
      out->dspecular[j][l] = lit ? value * dlog + rest * di.z : 0;
    }
  }
}

}  // namespace

void ShapeArrays::Resize(std::size_t padded) {
  cosine.resize(padded), specular.resize(padded);
  for (LightVector& d : dcosine) d.resize(padded);
  for (LightVector& d : dspecular) d.resize(padded);
}

void EvaluateShape(MapLobe lobe, const MapPoint& point, const LightArrays& lights, bool gradient, ShapeArrays* out) {
  const MapFrame frame = FrameOf(point.normal);
  double* const dcosine[2] = {out->dcosine[0].data(), out->dcosine[1].data()};
  if (lobe == MapLobe::kGgx) {
    // One width: D and G1 depend on the cosines with the normal alone. With s(c) = sqrt(c^2 + alpha^2 (1 - c^2)) and K =
    // h_z^2 + (|h|^2 - h_z^2) / alpha^2:
    //   specular = |h|^4 i_z / (pi alpha^2 K^2 (i_z + s_i) (o_z + s_o)).
    double* const dspecular[3] = {out->dspecular[0].data(), out->dspecular[1].data(), out->dspecular[2].data()};
    const double alpha = std::exp(point.width[0]);
    double *cosine = out->cosine.data(), *specular = out->specular.data();
    if (gradient) IsotropicGradient(alpha, frame, lights, cosine, specular, dcosine, dspecular);
    if (!gradient) IsotropicValue(alpha, frame.n, lights, cosine, specular);
    return;
  }
  Cosines(frame.n, lights, out->cosine.data());
  if (gradient) CosineDerivatives(frame, lights, dcosine[0], dcosine[1]);
  if (lobe == MapLobe::kGgxAnisotropic) Anisotropic(point, frame, lights, gradient, out);
}

}  // namespace lobefit

#include "lobefit/core/ellipsoid/off_center.h"

#include <algorithm>
#include <limits>
#include <string>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/ellipsoid/canonical_axes.h"
#include "lobefit/core/ellipsoid/principal_axes.h"
#include "lobefit/core/ellipsoid/weighted_form.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// M = A^T A and its cofactors [[k11, -k12], [-k12, k22]] of the slope part, with gradients in the ellipsoid's
// parameters.
struct MatrixForms {
  double m33, m13, m23, k11, k12, k22;
  std::array<double, 5> dm33, dm13, dm23, dk11, dk12, dk22;
};

MatrixForms FormsOf(const Ellipsoid& e, bool with_gradient) {
  const EllipsoidFrame frame(e);
  const Mat3 columns = Transposed(frame.rotation());
  const Vec3 &r1 = columns.row[0], &r2 = columns.row[1], &n = columns.row[2];
  const double ax = e.alpha_x, ay = e.alpha_y;
  const FormWeights shape = ShapeWeights(ax, ay), cofactor = CofactorWeights(ax, ay);
  MatrixForms f;
  f.m33 = frame.norm2_an();
  f.m13 = FormOfPerpendicular(shape, r1, n);
  f.m23 = FormOfPerpendicular(shape, r2, n);
  f.k11 = Form(cofactor, r2, r2);
  f.k12 = -FormOfPerpendicular(cofactor, r1, r2);
  f.k22 = Form(cofactor, r1, r1);
  if (!with_gradient) return f;
  f.dm33 = frame.dnorm2_an();
  f.dm13 = {2 * ax * r1.x * n.x, 2 * ay * r1.y * n.y};
  f.dm23 = {2 * ax * r2.x * n.x, 2 * ay * r2.y * n.y};
  const auto dcofactor_dax = [&](const Vec3& p, const Vec3& q) { return 2 * ax * (p.y * q.y + ay * ay * p.z * q.z); };
  const auto dcofactor_day = [&](const Vec3& p, const Vec3& q) { return 2 * ay * (p.x * q.x + ax * ax * p.z * q.z); };
  f.dk11 = {dcofactor_dax(r2, r2), dcofactor_day(r2, r2)};
  f.dk12 = {-dcofactor_dax(r1, r2), -dcofactor_day(r1, r2)};
  f.dk22 = {dcofactor_dax(r1, r1), dcofactor_day(r1, r1)};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& axis = frame.turn_axis(static_cast<int>(k));
    f.dm13[2 + k] = FormTurned(shape, r1, n, axis);
    f.dm23[2 + k] = FormTurned(shape, r2, n, axis);
    f.dk11[2 + k] = FormTurned(cofactor, r2, r2, axis);
    f.dk12[2 + k] = -FormTurned(cofactor, r1, r2, axis);
    f.dk22[2 + k] = FormTurned(cofactor, r1, r1, axis);
  }
  return f;
}

// Rows of a square root of M (up to scale): A0 = [[a, b, 0], [0, c, 0], [-slope_x, -slope_y, 1]].
struct SlopeRoot {
  double slope_x, slope_y, a, b, c;
};

CanonicalAxes FindCanonicalAxes(const SlopeRoot& root) {
  // The longer of the two slope rows first, made by a Givens turn that subtracts nothing: then the rows, scaled to unit
  // length, are well conditioned for any correlation.
  Mat3 rows = {{{{root.a, root.b, 0}, {0, root.c, 0}, {-root.slope_x, -root.slope_y, 1}}}};
  Mat3 first_turn = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  const double h = std::hypot(root.b, root.c);
  if (h > root.a) {
    const double cos = root.b / h, sin = root.c / h;
    rows.row[0] = {root.a * cos, h, 0};
    rows.row[1] = {root.a * sin, 0, 0};
    first_turn = {{{{cos, sin, 0}, {sin, -cos, 0}, {0, 0, 1}}}};
  }
  const PrincipalAxes found = FindPrincipalAxes(rows);
  return ToCanonicalAxes({found.length, found.axes, found.rotation * first_turn});
}

// One column of the Jacobian from E = R dM R^T (elements xx, yy, zz, yz, xz, xy): M = R^T diag(length^2) R moves by
// d ln length_k = E_kk / (2 length_k^2), and R by a turn g with E_ij = (length_i^2 - length_j^2) [g]_ij.
void FillColumn(const CanonicalAxes& axes, const Ellipsoid& e, const double (&form)[6], int column, double* jacobian) {
  const auto& [lx, ly, lz] = axes.length;
  const double gx = -form[3] / ((ly - lz) * (ly + lz));
  const double gy = form[4] / ((lx - lz) * (lx + lz));
  const double gz = -form[5] / ((lx - ly) * (lx + ly));
  const double dlog_lz = form[2] / (2 * lz * lz);
  const double cx = std::cos(e.theta_x), sx = std::sin(e.theta_x);
  const double dtheta_z = (cx * gz - sx * gy) / std::cos(e.theta_y);
  const double out[5] = {e.alpha_x * (form[0] / (2 * lx * lx) - dlog_lz),
                         e.alpha_y * (form[1] / (2 * ly * ly) - dlog_lz), gx - std::sin(e.theta_y) * dtheta_z,
                         cx * gy + sx * gz, dtheta_z};
  for (int row = 0; row < 5; ++row) jacobian[5 * row + column] = out[row];
}

constexpr std::array<std::array<std::size_t, 2>, 6> kPairs = {{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};

}  // namespace

OffCenter OffCenterFromEllipsoid(const Ellipsoid& ellipsoid, double jacobian[25]) {
  const MatrixForms f = FormsOf(ellipsoid, jacobian != nullptr);
  const double m33_squared = f.m33 * f.m33;
  const OffCenter o = {-f.m13 / f.m33, -f.m23 / f.m33, f.k11 / m33_squared, f.k12 / m33_squared, f.k22 / m33_squared};
  if (jacobian != nullptr) {
    for (std::size_t k = 0; k < 5; ++k) {
      jacobian[k] = -(f.dm13[k] + o.slope_x * f.dm33[k]) / f.m33;
      jacobian[5 + k] = -(f.dm23[k] + o.slope_y * f.dm33[k]) / f.m33;
      jacobian[10 + k] = f.dk11[k] / m33_squared - 2 * o.q11 * f.dm33[k] / f.m33;
      jacobian[15 + k] = f.dk12[k] / m33_squared - 2 * o.q12 * f.dm33[k] / f.m33;
      jacobian[20 + k] = f.dk22[k] / m33_squared - 2 * o.q22 * f.dm33[k] / f.m33;
    }
  }
  return o;
}

// a = sqrt(k11) / m33, b = k12 / (m33 sqrt(k11)), c = alpha_x alpha_y / (m33^(3/2) a) by det Q^-1 = (alpha_x alpha_y)^2
// / m33^3.
SlopeCoordinates SlopeCoordinatesFromEllipsoid(const Ellipsoid& ellipsoid, double jacobian[25]) {
  const MatrixForms f = FormsOf(ellipsoid, jacobian != nullptr);
  const double root = std::sqrt(f.k11), log_m33 = std::log(f.m33);
  const double log_a = 0.5 * std::log(f.k11) - log_m33, b = f.k12 / (f.m33 * root);
  const double log_c = std::log(ellipsoid.alpha_x) + std::log(ellipsoid.alpha_y) - 1.5 * log_m33 - log_a;
  const SlopeCoordinates s = {{-f.m13 / f.m33, -f.m23 / f.m33, log_a, b, log_c}};
  if (jacobian != nullptr) {
    const double dlog_alphas[5] = {1 / ellipsoid.alpha_x, 1 / ellipsoid.alpha_y, 0, 0, 0};
    for (std::size_t k = 0; k < 5; ++k) {
      const double dlog_m33 = f.dm33[k] / f.m33, dlog_root = 0.5 * f.dk11[k] / f.k11;
      jacobian[k] = -(f.dm13[k] + s.v[0] * f.dm33[k]) / f.m33;
      jacobian[5 + k] = -(f.dm23[k] + s.v[1] * f.dm33[k]) / f.m33;
      jacobian[10 + k] = dlog_root - dlog_m33;
      jacobian[15 + k] = f.dk12[k] / (f.m33 * root) - b * (dlog_m33 + dlog_root);
      jacobian[20 + k] = dlog_alphas[k] - 1.5 * dlog_m33 - jacobian[10 + k];
    }
  }
  return s;
}

namespace {

// Lower triangular root of Q^-1; the determinant by Kahan's product difference, exact to rounding.
SlopeRoot RootOf(const OffCenter& o) {
  const double square = o.q12 * o.q12;
  const double determinant = std::fma(o.q11, o.q22, -square) - std::fma(o.q12, o.q12, -square);
  if (!std::isfinite(o.slope_x + o.slope_y) || !(o.q11 > 0) || !(determinant > 0) || !std::isfinite(determinant)) {
    throw InputError("Q^-1 = [[" + FormatDouble(o.q11) + ", " + FormatDouble(o.q12) + "], [" + FormatDouble(o.q12) +
                     ", " + FormatDouble(o.q22) + "]] with mean slope (" + FormatDouble(o.slope_x) + ", " +
                     FormatDouble(o.slope_y) +
                     ") is no slope distribution: all must be finite, q11 > 0 and q11 q22 > q12^2");
  }
  const double a = std::sqrt(o.q11);
  return {o.slope_x, o.slope_y, a, o.q12 / a, std::sqrt(determinant) / a};
}

}  // namespace

Ellipsoid EllipsoidFromOffCenter(const OffCenter& off_center, double jacobian[25]) {
  const CanonicalAxes axes = FindCanonicalAxes(RootOf(off_center));
  const Ellipsoid e = EllipsoidFromAxes(axes);
  if (jacobian == nullptr) return e;
  if (axes.degenerate) {
    std::fill(jacobian, jacobian + 25, kNan);
    return e;
  }
  double form[5][6];
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = kPairs[k];
    const Vec3 &p = axes.axis[i], &q = axes.axis[j];
    const double mean_p = axes.length[i] * axes.turn[i].z, mean_q = axes.length[j] * axes.turn[j].z;
    form[0][k] = -(mean_q * p.x + mean_p * q.x);
    form[1][k] = -(mean_q * p.y + mean_p * q.y);
    form[2][k] = p.x * q.x;
    form[3][k] = p.x * q.y + p.y * q.x;
    form[4][k] = p.y * q.y;
  }
  for (int column = 0; column < 5; ++column) FillColumn(axes, e, form[column], column, jacobian);
  return e;
}

Ellipsoid EllipsoidFromSlopeCoordinates(const SlopeCoordinates& coordinates, double jacobian[25]) {
  const double* v = coordinates.v;
  const SlopeRoot root = {v[0], v[1], std::exp(v[2]), v[3], std::exp(v[4])};
  const CanonicalAxes axes = FindCanonicalAxes(root);
  const Ellipsoid e = EllipsoidFromAxes(axes);
  if (jacobian == nullptr) return e;
  if (axes.degenerate) {
    std::fill(jacobian, jacobian + 25, kNan);
    return e;
  }
  // dM = dA0^T A0 + A0^T dA0, and A0 axis_i = length_i turn_i.
  double form[5][6];
  for (std::size_t k = 0; k < 6; ++k) {
    const auto [i, j] = kPairs[k];
    const Vec3 &p = axes.axis[i], &q = axes.axis[j];
    const Vec3 s = axes.length[i] * axes.turn[i], t = axes.length[j] * axes.turn[j];
    form[0][k] = -(t.z * p.x + s.z * q.x);
    form[1][k] = -(t.z * p.y + s.z * q.y);
    form[2][k] = root.a * (t.x * p.x + s.x * q.x);
    form[3][k] = t.x * p.y + s.x * q.y;
    form[4][k] = root.c * (t.y * p.y + s.y * q.y);
  }
  for (int column = 0; column < 5; ++column) FillColumn(axes, e, form[column], column, jacobian);
  return e;
}

SlopeCoordinates SlopeCoordinatesFromOffCenter(const OffCenter& off_center, double jacobian[25]) {
  const SlopeRoot root = RootOf(off_center);
  if (jacobian != nullptr) {
    const double aa = root.a * root.a, cc = root.c * root.c, ratio = root.b / root.a;
    std::fill(jacobian, jacobian + 25, 0.0);
    jacobian[0] = jacobian[6] = 1.0;
    jacobian[12] = 0.5 / aa;
    jacobian[17] = -0.5 * root.b / aa;
    jacobian[18] = 1.0 / root.a;
    jacobian[22] = 0.5 * ratio * ratio / cc;  // c^2 = q22 - q12^2 / q11
    jacobian[23] = -ratio / cc;
    jacobian[24] = 0.5 / cc;
  }
  return {{root.slope_x, root.slope_y, std::log(root.a), root.b, std::log(root.c)}};
}

OffCenter OffCenterFromSlopeCoordinates(const SlopeCoordinates& coordinates, double jacobian[25]) {
  const double* v = coordinates.v;
  const double a = std::exp(v[2]), b = v[3], c = std::exp(v[4]);
  if (jacobian != nullptr) {
    std::fill(jacobian, jacobian + 25, 0.0);
    jacobian[0] = jacobian[6] = 1.0;
    jacobian[12] = 2 * a * a;
    jacobian[17] = a * b;
    jacobian[18] = a;
    jacobian[23] = 2 * b;
    jacobian[24] = 2 * c * c;
  }
  return {v[0], v[1], a * a, a * b, b * b + c * c};
}

double NarrowestWidth(const SlopeCoordinates& coordinates) {
  const OffCenter o = OffCenterFromSlopeCoordinates(coordinates);
  const double mean = 0.5 * (o.q11 + o.q22), off = std::hypot(0.5 * (o.q11 - o.q22), o.q12);
  // The smaller eigenvalue as det over the larger one: no cancellation.
  return std::exp(coordinates.v[2] + coordinates.v[4]) / std::sqrt(mean + off);
}

}  // namespace lobefit

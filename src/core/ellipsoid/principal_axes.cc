#include "lobefit/core/ellipsoid/principal_axes.h"

#include <limits>
#include <utility>

namespace lobefit {
namespace {

// Turns rows i and j of both matrices by the angle that makes the rows of `b` perpendicular. False if they already are.
bool MakePerpendicular(std::size_t i, std::size_t j, Mat3* b, Mat3* rotation) {
  const Vec3 p = b->row[i], q = b->row[j];
  const double pp = Dot(p, p), qq = Dot(q, q), pq = Dot(p, q);
  if (std::abs(pq) <= 0.25 * std::numeric_limits<double>::epsilon() * std::sqrt(pp) * std::sqrt(qq)) return false;
  const double zeta = (qq - pp) / (2.0 * pq);
  const double t = std::copysign(1.0, zeta) / (std::abs(zeta) + std::sqrt(1.0 + zeta * zeta));
  const double c = 1.0 / std::sqrt(1.0 + t * t), s = c * t;
  const Vec3 u = rotation->row[i], v = rotation->row[j];
  b->row[i] = c * p - s * q;
  b->row[j] = s * p + c * q;
  rotation->row[i] = c * u - s * v;
  rotation->row[j] = s * u + c * v;
  return true;
}

}  // namespace

PrincipalAxes FindPrincipalAxes(const Mat3& b) {
  Mat3 rows = b;
  Mat3 rotation = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  const auto sort = [&] {
    for (const auto& [i, j] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {0, 1}}) {
      if (Dot(rows.row[i], rows.row[i]) < Dot(rows.row[j], rows.row[j])) {
        std::swap(rows.row[i], rows.row[j]);
        std::swap(rotation.row[i], rotation.row[j]);
      }
    }
  };
  // Convergence is quadratic: 3 to 6 sweeps; the limit only guards against inputs that are not finite.
  for (int sweep = 0; sweep < 40; ++sweep) {
    sort();
    bool turned = MakePerpendicular(0, 1, &rows, &rotation);
    turned = MakePerpendicular(0, 2, &rows, &rotation) || turned;
    turned = MakePerpendicular(1, 2, &rows, &rotation) || turned;
    if (!turned) break;
  }
  sort();
  PrincipalAxes result;
  result.rotation = rotation;
  for (std::size_t k = 0; k < 3; ++k) {
    result.length[k] = Norm(rows.row[k]);
    result.axes.row[k] = (1.0 / result.length[k]) * rows.row[k];
  }
  return result;
}

}  // namespace lobefit

#include "lobefit/maps/engine/starts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobefit {
namespace {

// More of them do not lower the costs that the descents from here reach.
constexpr int kRounds = 2;

Vec3 AboveHorizon(const Vec3& n, double least_z) {
  const double length = Norm(n);
  if (!(length > 0) || !std::isfinite(length)) return {0, 0, 1};
  const Vec3 unit = (1 / length) * n;
  if (unit.z >= least_z) return unit;
  const double flat = std::hypot(unit.x, unit.y), keep = std::sqrt(1 - least_z * least_z) / std::max(flat, 1e-12);
  return {keep * unit.x, keep * unit.y, least_z};
}

// x of the symmetric system A x = b by Cramer's rule; zero where A is singular.
Vec3 Solve3(const double A[6], const Vec3& b) {  // xx xy xz yy yz zz
  const double c_xx = A[3] * A[5] - A[4] * A[4], c_xy = A[2] * A[4] - A[1] * A[5], c_xz = A[1] * A[4] - A[2] * A[3];
  const double det = A[0] * c_xx + A[1] * c_xy + A[2] * c_xz;
  const double c_yy = A[0] * A[5] - A[2] * A[2], c_yz = A[1] * A[2] - A[0] * A[4], c_zz = A[0] * A[3] - A[1] * A[1];
  if (!(std::fabs(det) > 1e-12 * std::fabs(A[0] * A[3] * A[5]))) return {0, 0, 0};
  return {(c_xx * b.x + c_xy * b.y + c_xz * b.z) / det, (c_xy * b.x + c_yy * b.y + c_yz * b.z) / det,
          (c_xz * b.x + c_yz * b.y + c_zz * b.z) / det};
}

}  // namespace

MapDescent LambertStart(const MapModel& model, const TexelData& data, const LightVector& mean, const MapBounds& bounds,
                        const MapPoint& held, double loss, TexelObjective* objective, LightVector* weight) {
  MapDescent start = {held, std::numeric_limits<double>::infinity(), false, 0};
  const LightArrays& lights = data.lights;
  for (std::size_t l = 0; l < lights.padded; ++l) (*weight)[l] = mean[l] <= 1 ? lights.live[l] : 0;
  MapPoint point = held;
  for (int round = 0; round < kRounds; ++round) {
    if (!bounds.normal_held) {
      const double* rows[4] = {lights.x.data(), lights.y.data(), lights.z.data(), mean.data()};
      MapMatrix sums = {};
      AddGram(weight->data(), rows, 4, lights.padded, &sums);
      const double A[6] = {sums[0][0], sums[1][0], sums[2][0], sums[1][1], sums[2][1], sums[2][2]};
      point.normal = AboveHorizon(Solve3(A, {sums[3][0], sums[3][1], sums[3][2]}), 0.1);
    }
    const double cost = objective->CostOfShape(model, data, *weight, loss, bounds.amplitudes, &point);
    if (cost < start.cost) start.point = point, start.cost = cost;
    objective->WeightsOfLast(weight);
  }
  return start;
}

Vec3 HighlightNormal(const TexelData& data, const LightVector& mean, const MapPoint& lambert, const MapBounds& bounds) {
  const LightArrays& lights = data.lights;
  Vec3 sum = {0, 0, 0};
  double most = 0;
  const Vec3 n = lambert.normal;
  const double diffuse = lambert.diffuse[0];
  const auto excess = [&](std::size_t l) {
    const double cosine = std::max(0.0, n.x * lights.x[l] + n.y * lights.y[l] + n.z * lights.z[l]);
    return mean[l] - cosine * diffuse;
  };
  for (std::size_t l = 0; l < lights.count; ++l) most = std::max(most, excess(l));
  for (std::size_t l = 0; l < lights.count; ++l) {
    const double e = excess(l);
    if (e < 0.5 * most) continue;
    const double weight = e * e / std::sqrt(lights.square[l]);
    sum = sum +
          weight * Vec3{lights.x[l] + lights.out_x[l], lights.y[l] + lights.out_y[l], lights.z[l] + lights.out_z[l]};
  }
  return AboveHorizon(sum, std::max(0.1, bounds.least_normal_z));
}

}  // namespace lobefit

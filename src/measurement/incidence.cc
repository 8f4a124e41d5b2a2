#include "lobefit/measurement/incidence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using GroupKey = std::pair<std::int64_t, std::int64_t>;

GroupKey KeyOf(const Vec3& wi, double resolution, bool isotropic) {
  // An isotropic table has millions of directions and bins of a degree: there the faster arc cosine is exact enough.
  const double theta = isotropic ? std::acos(std::min(1.0, wi.z)) : PolarAngle(wi);
  const std::int64_t theta_bin = std::llround(theta / resolution);
  if (isotropic || theta < resolution / 2) return {theta_bin, 0};
  // Azimuths of -pi and pi are the same direction.
  const std::int64_t turn = std::llround(2 * kPi / resolution);
  return {theta_bin, ((std::llround(Azimuth(wi) / resolution) % turn) + turn) % turn};
}

}  // namespace

Incidences GroupByIncidence(const Measurement& measurement, double resolution) {
  const Samples& samples = measurement.samples;
  if (measurement.isotropic) resolution = std::max(resolution, kPi / 180);
  std::map<GroupKey, std::uint32_t> groups;
  Incidences incidences;
  incidences.group.resize(samples.size());
  std::vector<Vec3> sum;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 wi = samples.wi(i);
    const auto [entry, is_new] =
        groups.try_emplace(KeyOf(wi, resolution, measurement.isotropic), static_cast<std::uint32_t>(sum.size()));
    if (is_new) sum.push_back({0, 0, 0});
    const std::uint32_t group = entry->second;
    incidences.group[i] = group;
    // Isotropic directions are turned into the xz plane, so that the mean is one.
    sum[group] = sum[group] + (measurement.isotropic ? Vec3{std::hypot(wi.x, wi.y), 0, wi.z} : wi);
  }
  std::vector<std::uint32_t> rank(sum.size());
  for (const auto& [key, group] : groups) {
    rank[group] = static_cast<std::uint32_t>(incidences.wi.size());
    incidences.wi.push_back(Normalized(sum[group]));
  }
  for (std::uint32_t& group : incidences.group) group = rank[group];
  return incidences;
}

std::optional<double> PlaneAzimuth(const Samples& samples) {
  constexpr double kTolerance = 1e-6;
  // The direction farthest from the normal fixes the plane.
  double best = 0, x = 1, y = 0;
  const auto consider = [&](double to_x, double to_y) {
    const double square = to_x * to_x + to_y * to_y;
    if (square <= best) return;
    best = square;
    x = to_x;
    y = to_y;
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    consider(samples.wi_x[i], samples.wi_y[i]);
    consider(samples.wo_x[i], samples.wo_y[i]);
  }
  const double length = std::hypot(x, y);
  x /= length;
  y /= length;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::fabs(x * samples.wi_y[i] - y * samples.wi_x[i]) > kTolerance) return std::nullopt;
    if (std::fabs(x * samples.wo_y[i] - y * samples.wo_x[i]) > kTolerance) return std::nullopt;
  }
  if (x == 0) return kPi / 2;
  const double azimuth = std::atan(y / x);
  return std::fabs(azimuth) < kTolerance ? 0.0 : azimuth;
}

bool IsInPlane(const Samples& samples) { return PlaneAzimuth(samples).has_value(); }

}  // namespace lobefit

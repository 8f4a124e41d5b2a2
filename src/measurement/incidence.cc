#include "lobefit/measurement/incidence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kDegree = kPi / 180;

// Joins unit directions that lie near each other, in time linear in their number. What lies within a quarter of the
// resolution of a kept direction counts as that; kept directions within the resolution of each other, and those that a
// chain of such pairs joins, are one.
//
// Kept directions stand in the cells of a grid over x and y: what is near on the sphere is near there, above the
// horizon or below. Cells are twice the resolution wide, so that what is within it lies in at most four. The grid
// repeats itself where it would have more cells than directions can fill: what a cell holds is asked for its distance
// anyway.
class DirectionMerger {
 public:
  // `most`: directions that will be added at most.
  DirectionMerger(double resolution, std::size_t most)
      : resolution_(resolution),
        near_(Chord2(resolution)),
        same_(Chord2(resolution / 4)),
        side_(SideOf(resolution, most)),
        newest_(side_ * side_, kNone) {}

  // Index of the kept direction that `w` counts as.
  std::uint32_t Add(const Vec3& w) {
    // Files list an incidence's samples together.
    if (last_ < kept_.size() && IsWithin(w, last_, same_)) return last_;
    const auto mine = static_cast<std::uint32_t>(kept_.size());
    std::uint32_t found = mine;
    ForNear(w, resolution_ / 4, [&](std::uint32_t other) {
      if (found == mine && IsWithin(w, other, same_)) found = other;
    });
    if (found == mine) {
      std::uint32_t& newest = newest_[CellOf(Line(w.x), Line(w.y))];
      kept_.push_back({w, mine, newest});
      ForNear(w, resolution_, [&](std::uint32_t other) {
        if (IsWithin(w, other, near_)) kept_[Root(other)].parent = mine;
      });
      newest = mine;
    }
    return last_ = found;
  }

  // The group of each kept direction. Chains that are longer than four resolutions are no jitter but directions that
  // fill a part of the sphere: each of theirs stays by itself.
  std::vector<std::uint32_t> Groups() {
    std::vector<std::uint32_t> groups(kept_.size());
    const double longest = Chord2(4 * resolution_);
    std::vector<std::uint8_t> fills(kept_.size(), 0);
    for (std::uint32_t k = 0; k < kept_.size(); ++k) {
      groups[k] = Root(k);
      if (!IsWithin(kept_[k].w, groups[k], longest)) fills[groups[k]] = 1;
    }
    for (std::uint32_t k = 0; k < kept_.size(); ++k) {
      if (fills[groups[k]] != 0) groups[k] = k;
    }
    return groups;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Kept {
    Vec3 w;
    std::uint32_t parent;  // itself at the root of what is one
    std::uint32_t before;  // the one that came to the cell before it, or kNone
  };

  // Cells along x: for 0.1 degree over all of x and y 1024, 4 MB; for few directions four a direction.
  static std::size_t SideOf(double resolution, std::size_t most) {
    constexpr double kMost = 1024;
    const double wanted = std::min(2 * std::sqrt(static_cast<double>(most)) + 1, 1 / resolution + 2);
    return std::bit_ceil(static_cast<std::size_t>(std::min(wanted, kMost)));
  }
  static double Chord2(double angle) { return 4 * std::pow(std::sin(angle / 2), 2); }
  bool IsWithin(const Vec3& w, std::uint32_t other, double chord2) const {
    const Vec3 d = w - kept_[other].w;
    return Dot(d, d) <= chord2;
  }
  std::int64_t Line(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / (2 * resolution_)));
  }
  std::size_t CellOf(std::int64_t x, std::int64_t y) const {
    return (static_cast<std::size_t>(x) & (side_ - 1)) * side_ + (static_cast<std::size_t>(y) & (side_ - 1));
  }
  // Visits what may lie within `reach`, at most the resolution.
  template <class Visit>
  void ForNear(const Vec3& w, double reach, const Visit& visit) const {
    for (std::int64_t x = Line(w.x - reach); x <= Line(w.x + reach); ++x) {
      for (std::int64_t y = Line(w.y - reach); y <= Line(w.y + reach); ++y) {
        for (std::uint32_t other = newest_[CellOf(x, y)]; other != kNone; other = kept_[other].before) visit(other);
      }
    }
  }
  std::uint32_t Root(std::uint32_t k) {
    while (kept_[k].parent != k) k = kept_[k].parent = kept_[kept_[k].parent].parent;
    return k;
  }

  double resolution_, near_, same_;
  std::uint32_t last_ = 0;
  std::vector<Kept> kept_;
  std::size_t side_;                   // cells along x and along y, a power of two
  std::vector<std::uint32_t> newest_;  // the kept direction that came last to a cell, or kNone
};

// Groups in the order of the means' polar angles, those within the resolution by azimuth in [0, 2 pi).
std::vector<std::uint32_t> Ranks(const std::vector<Vec3>& means, double resolution) {
  std::vector<std::uint32_t> order(means.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<double> theta(means.size()), azimuth(means.size());
  for (std::size_t g = 0; g < means.size(); ++g) {
    theta[g] = PolarAngle(means[g]);
    azimuth[g] = Azimuth(means[g]);
    if (azimuth[g] < -resolution / 2) azimuth[g] += 2 * kPi;
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return theta[a] < theta[b]; });
  for (auto ring = order.begin(); ring != order.end();) {
    auto end = ring + 1;
    while (end != order.end() && theta[*end] - theta[*(end - 1)] <= resolution / 2) ++end;
    std::stable_sort(ring, end, [&](std::uint32_t a, std::uint32_t b) { return azimuth[a] < azimuth[b]; });
    ring = end;
  }
  std::vector<std::uint32_t> ranks(means.size());
  for (std::size_t k = 0; k < order.size(); ++k) ranks[order[k]] = static_cast<std::uint32_t>(k);
  return ranks;
}

}  // namespace

Incidences GroupByIncidence(const Measurement& measurement, double resolution) {
  return GroupByDirection(measurement, measurement.listed_side, resolution);
}

Incidences GroupByDirection(const Measurement& measurement, Beam side, double resolution) {
  const Samples& samples = measurement.samples;
  Incidences incidences;
  incidences.group.resize(samples.size());
  // Group of what a sample was sorted under: a kept direction, or a bin of a degree.
  std::vector<std::uint32_t> groups;
  if (measurement.isotropic) {
    resolution = std::max(resolution, kDegree);
    groups.resize(static_cast<std::size_t>(kPi / 2 / resolution) + 2);
    std::iota(groups.begin(), groups.end(), 0U);
  }
  DirectionMerger merger(resolution, measurement.isotropic ? 0 : samples.size());
  std::vector<Vec3> sums;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 w = side == Beam::kViewer ? samples.wo(i) : samples.wi(i);
    // A table has millions of directions: there the faster arc cosine is exact enough.
    const std::uint32_t key = measurement.isotropic
                                  ? static_cast<std::uint32_t>(std::lround(std::acos(std::min(1.0, w.z)) / resolution))
                                  : merger.Add(w);
    incidences.group[i] = key;
    if (key >= sums.size()) sums.resize(key + 1, Vec3{0, 0, 0});
    // Isotropic directions are turned into the xz plane, so that the mean is one.
    sums[key] = sums[key] + (measurement.isotropic ? Vec3{std::hypot(w.x, w.y), 0, w.z} : w);
  }
  if (!measurement.isotropic) groups = merger.Groups();
  // Of the kept directions of a group the sums go to one of them.
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (groups[k] == k) continue;
    sums[groups[k]] = sums[groups[k]] + sums[k];
    sums[k] = {0, 0, 0};
  }
  std::vector<std::uint32_t> place(sums.size());
  std::vector<Vec3> means;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (groups[k] != k || Dot(sums[k], sums[k]) == 0) continue;
    place[k] = static_cast<std::uint32_t>(means.size());
    means.push_back(Normalized(sums[k]));
  }
  const std::vector<std::uint32_t> ranks = Ranks(means, resolution);
  incidences.wi.resize(means.size());
  for (std::size_t g = 0; g < means.size(); ++g) incidences.wi[ranks[g]] = means[g];
  for (std::uint32_t& group : incidences.group) group = ranks[place[groups[group]]];
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

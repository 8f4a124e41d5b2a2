#include "lobefit/report/slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <unordered_map>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kDegree = kPi / 180;
// Angles from the plane that are tried, degrees; the first one that gives enough samples is taken.
constexpr std::array<double, 5> kTolerances = {0.1, 0.5, 1, 2, 4};

struct Direction {
  double theta, phi;
};

// Whole steps of `resolution` in both angles as one key.
std::uint64_t KeyOf(const Direction& d, double resolution, bool isotropic) {
  const auto theta = static_cast<std::uint64_t>(std::llround(d.theta / resolution));
  if (isotropic || d.theta < resolution / 2) return theta << 32U;
  const auto turn = std::llround(2 * kPi / resolution);
  const auto phi = static_cast<std::uint64_t>(((std::llround(d.phi / resolution) % turn) + turn) % turn);
  return theta << 32U | phi;
}

Direction ToDirection(const Vec3& w) { return {PolarAngle(w), Azimuth(w)}; }

struct Candidate {
  double theta = 0, phi = 0;
  std::vector<SlicePoint> points;
  std::vector<float> off_plane;
};

struct Gathered {
  std::unordered_map<std::uint64_t, Candidate> groups;
  std::size_t directions = 0;
};

Gathered Gather(const Measurement& measurement, bool outgoing_stays) {
  const Samples& samples = measurement.samples;
  const double resolution = measurement.isotropic ? kDegree : 0.1 * kDegree;
  const double widest = std::sin(kTolerances.back() * kDegree);
  Gathered gathered;
  std::set<std::uint64_t> directions;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 stays = outgoing_stays ? samples.wo(i) : samples.wi(i),
               sweeps = outgoing_stays ? samples.wi(i) : samples.wo(i);
    const double length = std::hypot(stays.x, stays.y);
    const bool normal = std::atan2(length, stays.z) < resolution / 2;
    // Away from the normal the plane is that of the direction which stays; along the normal, the xz plane.
    const double ex = normal ? 1 : stays.x / length, ey = normal ? 0 : stays.y / length;
    const double off = normal && measurement.isotropic ? 0 : std::fabs(sweeps.x * -ey + sweeps.y * ex);
    if (off > widest) continue;
    const double along =
        normal && measurement.isotropic ? std::hypot(sweeps.x, sweeps.y) : sweeps.x * ex + sweeps.y * ey;
    const Direction d = ToDirection(stays);
    Candidate& group = gathered.groups[KeyOf(d, resolution, measurement.isotropic)];
    double theta = std::atan2(-along, sweeps.z);
    if (measurement.isotropic) theta += std::round(d.theta / resolution) * resolution - d.theta;
    // The first direction stands for all: they agree to the resolution.
    if (group.points.empty()) {
      group.theta = measurement.isotropic ? std::round(d.theta / resolution) * resolution : d.theta;
      group.phi = normal || measurement.isotropic ? 0 : d.phi;
    }
    group.points.push_back({theta, i});
    group.off_plane.push_back(static_cast<float>(std::asin(std::min(1.0, off))));
    // Along the normal an isotropic measurement has no side: the sample stands for both.
    if (normal && measurement.isotropic) {
      group.points.push_back({-theta, i});
      group.off_plane.push_back(0);
    }
  }
  gathered.directions = gathered.groups.size();
  return gathered;
}

// Number of samples of each group within the tolerance.
std::size_t GroupsWith(const Gathered& gathered, double tolerance, std::size_t fewest) {
  std::size_t enough = 0;
  for (const auto& [key, group] : gathered.groups) {
    const auto inside =
        std::count_if(group.off_plane.begin(), group.off_plane.end(), [&](float off) { return off <= tolerance; });
    enough += static_cast<std::size_t>(inside) >= fewest ? 1 : 0;
  }
  return enough;
}

// `count` of [0, size), evenly, first and last among them.
std::vector<std::size_t> Spread(std::size_t size, std::size_t count) {
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < std::min(size, count); ++k) {
    indices.push_back(size <= count || count == 1 ? k : (k * (size - 1) + (count - 1) / 2) / (count - 1));
  }
  return indices;
}

// `count` of slices in ascending polar angle: those nearest to evenly spaced angles.
std::vector<const Slice*> SpreadAngles(const std::vector<const Slice*>& slices, std::size_t count) {
  if (slices.size() <= count || count < 2)
    return {slices.begin(), slices.begin() + static_cast<std::ptrdiff_t>(std::min(slices.size(), count))};
  std::vector<const Slice*> chosen;
  const double low = slices.front()->theta, high = slices.back()->theta;
  std::size_t next = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double target = low + (high - low) * static_cast<double>(k) / static_cast<double>(count - 1);
    // Enough must be left for the angles that follow.
    const std::size_t last = slices.size() - (count - k);
    std::size_t best = next;
    for (std::size_t i = next; i <= last; ++i) {
      if (std::fabs(slices[i]->theta - target) < std::fabs(slices[best]->theta - target)) best = i;
    }
    chosen.push_back(slices[best]);
    next = best + 1;
  }
  return chosen;
}

}  // namespace

Slices GatherSlices(const Measurement& measurement, std::size_t fewest) {
  Slices result;
  Gathered gathered = Gather(measurement, false);
  if (!measurement.isotropic) {
    // A fixed detector and a moving source: far fewer directions of view than of light.
    Gathered swapped = Gather(measurement, true);
    if (2 * swapped.directions < gathered.directions) {
      result.outgoing_stays = true;
      std::swap(gathered, swapped);
    }
  }
  // Enough is a curve; else, in the widest plane, `fewest`.
  const std::size_t most = GroupsWith(gathered, kTolerances.back() * kDegree, fewest);
  result.tolerance = kTolerances.back() * kDegree;
  for (const double degrees : kTolerances) {
    if (2 * GroupsWith(gathered, degrees * kDegree, std::max<std::size_t>(fewest, 20)) >=
        std::max<std::size_t>(most, 1)) {
      result.tolerance = degrees * kDegree;
      break;
    }
  }
  for (auto& [key, group] : gathered.groups) {
    Slice slice;
    slice.theta = group.theta;
    slice.phi = group.phi;
    for (std::size_t i = 0; i < group.points.size(); ++i) {
      if (group.off_plane[i] <= result.tolerance) slice.points.push_back(group.points[i]);
    }
    if (slice.points.size() < fewest) continue;
    std::sort(slice.points.begin(), slice.points.end(), [](const SlicePoint& a, const SlicePoint& b) {
      return a.theta != b.theta ? a.theta < b.theta : a.sample < b.sample;
    });
    result.slices.push_back(std::move(slice));
  }
  std::sort(result.slices.begin(), result.slices.end(), [](const Slice& a, const Slice& b) {
    const auto step = [](double phi) { return std::lround(phi / (0.2 * kDegree)); };
    return step(a.phi) != step(b.phi) ? step(a.phi) < step(b.phi) : a.theta < b.theta;
  });
  return result;
}

std::vector<const Slice*> ChooseSlices(const Slices& slices, std::size_t rows, std::size_t columns,
                                       std::size_t* rows_used, std::size_t* columns_used) {
  *rows_used = *columns_used = 0;
  std::vector<std::vector<const Slice*>> azimuths;
  for (const Slice& slice : slices.slices) {
    if (azimuths.empty() || std::fabs(azimuths.back().front()->phi - slice.phi) > 0.2 * kDegree)
      azimuths.emplace_back();
    azimuths.back().push_back(&slice);
  }
  // The normal has no azimuth: with several rows it would stand in one of them by chance.
  if (azimuths.size() > 2) {
    for (auto& azimuth : azimuths) {
      if (azimuth.size() > 2) std::erase_if(azimuth, [](const Slice* s) { return s->theta < 0.5 * kDegree; });
    }
  }
  // An azimuth with a single polar angle is no row unless all are so.
  const auto alone = [](const std::vector<const Slice*>& a) { return a.size() < 2; };
  if (std::any_of(azimuths.begin(), azimuths.end(), [&](const auto& a) { return !alone(a); }))
    std::erase_if(azimuths, alone);
  std::vector<const Slice*> chosen;
  if (azimuths.empty()) return chosen;
  // Grazing slices hold half a curve and little light: only where there is nothing else.
  for (auto& azimuth : azimuths) {
    const auto grazing = [](const Slice* s) { return s->theta > 78 * kDegree; };
    if (!std::all_of(azimuth.begin(), azimuth.end(), grazing)) std::erase_if(azimuth, grazing);
  }
  if (azimuths.size() == 1 || alone(azimuths.front())) {
    std::vector<const Slice*> all;
    for (const auto& azimuth : azimuths) all.insert(all.end(), azimuth.begin(), azimuth.end());
    std::sort(all.begin(), all.end(), [](const Slice* a, const Slice* b) { return a->theta < b->theta; });
    // Two full rows say as much as three where no azimuth needs a row of its own.
    const std::size_t most = all.size() > columns ? std::min<std::size_t>(2, rows) * columns : columns;
    chosen = SpreadAngles(all, most);
    *columns_used = std::min(columns, chosen.size() == 4 ? 2 : chosen.size());
    *rows_used = (chosen.size() + *columns_used - 1) / *columns_used;
    return chosen;
  }
  for (const std::size_t r : Spread(azimuths.size(), rows))
    *columns_used = std::max(*columns_used, std::min(columns, azimuths[r].size()));
  for (const std::size_t r : Spread(azimuths.size(), rows)) {
    for (const Slice* slice : SpreadAngles(azimuths[r], *columns_used)) chosen.push_back(slice);
    while (chosen.size() % *columns_used != 0) chosen.push_back(nullptr);
    ++*rows_used;
  }
  return chosen;
}

void SliceDirections(const Slices& slices, const Slice& slice, double theta, Vec3* wi, Vec3* wo) {
  const Vec3 stays = FromSpherical(slice.theta, slice.phi);
  const Vec3 sweeps = FromSpherical(std::fabs(theta), theta > 0 ? slice.phi + kPi : slice.phi);
  *wi = slices.outgoing_stays ? sweeps : stays;
  *wo = slices.outgoing_stays ? stays : sweeps;
}

}  // namespace lobefit

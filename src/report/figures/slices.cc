#include "lobefit/report/figures/slices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr double kDegree = kPi / 180;
// Angles from the plane that are tried, degrees; the first one that gives enough samples is taken.
constexpr std::array<double, 5> kTolerances = {0.1, 0.5, 1, 2, 4};

// Whole steps of `resolution` in both angles as one key, in the order polar angle, azimuth.
std::uint64_t KeyOf(const Vec3& w, double resolution, bool isotropic) {
  const double theta = std::atan2(std::hypot(w.x, w.y), w.z);
  const auto step = static_cast<std::uint64_t>(std::llround(theta / resolution));
  if (isotropic || step == 0) return step << 32U;
  const auto turn = std::llround(2 * kPi / resolution);
  const auto phi = static_cast<std::uint64_t>(((std::llround(std::atan2(w.y, w.x) / resolution) % turn) + turn) % turn);
  return step << 32U | phi;
}

Vec3 Direction(const Samples& samples, std::size_t i, bool outgoing) {
  return outgoing ? samples.wo(i) : samples.wi(i);
}

// Number of different directions among some samples spread over the file.
std::size_t CountDirections(const Measurement& measurement, bool outgoing, double resolution) {
  constexpr std::size_t kLooked = 20000;
  std::unordered_set<std::uint64_t> keys;
  const std::size_t step = 1 + measurement.samples.size() / kLooked;
  for (std::size_t i = 0; i < measurement.samples.size(); i += step) {
    keys.insert(KeyOf(Direction(measurement.samples, i, outgoing), resolution, measurement.isotropic));
  }
  return keys.size();
}

struct Candidate {
  double theta = 0, phi = 0;
  std::vector<SlicePoint> points;
  std::vector<float> off_plane;
};

using Gathered = std::vector<Candidate>;

Gathered Gather(const Measurement& measurement, const Staying& staying) {
  const Samples& samples = measurement.samples;
  const double widest = std::sin(kTolerances.back() * kDegree);
  Gathered gathered(staying.directions.size());
  for (std::size_t g = 0; g < gathered.size(); ++g) {
    gathered[g].theta = PolarAngle(staying.directions[g]);
    gathered[g].phi = gathered[g].theta < staying.resolution / 2 ? 0 : Azimuth(staying.directions[g]);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 stays = Direction(samples, i, staying.outgoing), sweeps = Direction(samples, i, !staying.outgoing);
    Candidate& group = gathered[staying.group[i]];
    const double length = std::hypot(stays.x, stays.y);
    const bool normal = group.theta < staying.resolution / 2;
    // Away from the normal the plane is that of the direction which stays; along the normal, the xz plane, or any for
    // an isotropic sample.
    const bool any_plane = normal && measurement.isotropic;
    const double ex = normal ? 1 : stays.x / length, ey = normal ? 0 : stays.y / length;
    const double off = any_plane ? 0 : std::fabs(sweeps.x * -ey + sweeps.y * ex);
    if (off > widest) continue;
    const double along = any_plane ? std::hypot(sweeps.x, sweeps.y) : sweeps.x * ex + sweeps.y * ey;
    double theta = std::atan2(-along, sweeps.z);
    if (staying.gathered) theta += group.theta - std::atan2(length, stays.z);
    group.points.push_back({theta, i});
    group.off_plane.push_back(static_cast<float>(std::asin(std::min(1.0, off))));
    // Where any plane will do there is no side either: the sample stands for both.
    if (any_plane) {
      group.points.push_back({-theta, i});
      group.off_plane.push_back(0);
    }
  }
  return gathered;
}

// Number of groups that have `fewest` samples within the tolerance, which reach nearly as far along the slice as those
// within the widest one.
std::size_t GroupsWith(const Gathered& gathered, double tolerance, std::size_t fewest) {
  std::size_t enough = 0;
  for (const Candidate& group : gathered) {
    std::size_t inside = 0;
    double low = 10, high = -10, all_low = 10, all_high = -10;
    for (std::size_t i = 0; i < group.points.size(); ++i) {
      const double theta = group.points[i].theta;
      all_low = std::min(all_low, theta), all_high = std::max(all_high, theta);
      if (static_cast<double>(group.off_plane[i]) > tolerance) continue;
      low = std::min(low, theta), high = std::max(high, theta);
      ++inside;
    }
    if (inside >= fewest && high - low >= 0.85 * (all_high - all_low)) ++enough;
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

Staying GroupByStayingDirection(const Measurement& measurement) {
  constexpr std::size_t kMostListed = 2000;  // more directions than an instrument lists
  Staying staying;
  staying.resolution = 0.1 * kDegree;
  const std::size_t incident = CountDirections(measurement, false, staying.resolution);
  const std::size_t outgoing = CountDirections(measurement, true, staying.resolution);
  staying.outgoing = 2 * outgoing < incident;
  staying.gathered = measurement.isotropic && std::min(incident, outgoing) > 180;
  if (staying.gathered) {
    staying.outgoing = false;
    staying.resolution = kDegree;
  } else if (std::min(incident, outgoing) > kMostListed) {
    staying.resolution = kDegree;
  }
  const Samples& samples = measurement.samples;
  std::unordered_map<std::uint64_t, std::uint32_t> groups;
  std::vector<std::pair<std::uint64_t, Vec3>> found;
  staying.group.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 w = Direction(samples, i, staying.outgoing);
    const std::uint64_t key = KeyOf(w, staying.resolution, measurement.isotropic);
    const auto [entry, is_new] = groups.try_emplace(key, static_cast<std::uint32_t>(found.size()));
    if (is_new) {
      // The first direction stands for all, or the whole degree where they are gathered.
      const double theta = staying.gathered ? static_cast<double>(key >> 32U) * staying.resolution : PolarAngle(w);
      found.emplace_back(key, FromSpherical(theta, measurement.isotropic ? 0 : Azimuth(w)));
    }
    staying.group[i] = entry->second;
  }
  std::vector<std::uint32_t> order(found.size()), rank(found.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return found[a].first < found[b].first; });
  for (std::size_t k = 0; k < order.size(); ++k) {
    rank[order[k]] = static_cast<std::uint32_t>(k);
    staying.directions.push_back(found[order[k]].second);
  }
  for (std::uint32_t& group : staying.group) group = rank[group];
  return staying;
}

Slices GatherSlices(const Measurement& measurement, const Staying& staying, std::size_t fewest) {
  Slices result;
  const Gathered gathered = Gather(measurement, staying);
  result.outgoing_stays = staying.outgoing;
  result.gathered = staying.gathered;
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
  for (const Candidate& group : gathered) {
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

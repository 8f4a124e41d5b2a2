#include "lobefit/io/compare_written.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "lobefit/base/text/text.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {
namespace {

constexpr double kSameDirection = 3.5e-4;  // 0.02 degrees: what a text format rounds to

using Names = std::vector<std::string>;

// The original with the channels of `back`; nothing where they mean something else.
std::optional<Measurement> WithChannelsOf(const Measurement& back, const Measurement& original) {
  const Names &own = original.channels.names, &theirs = back.channels.names;
  Measurement same = original;
  same.channels = back.channels;
  if (own == theirs ||
      (own.size() == theirs.size() &&
       (back.channels.wavelengths_nm.empty() || original.channels.wavelengths_nm == back.channels.wavelengths_nm) &&
       own.size() != 3)) {
    return same;
  }
  if (own.size() == 1) {
    same.samples.values.assign(theirs.size(), original.samples.values[0]);
    return same;
  }
  if (own == Names{"R", "G", "B"} && theirs == Names{"X", "Y", "Z"}) {
    for (std::size_t i = 0; i < same.samples.size(); ++i) {
      const auto& v = original.samples.values;
      const std::array<double, 3> xyz = XyzFromSrgb({v[0][i], v[1][i], v[2][i]});
      for (std::size_t c = 0; c < 3; ++c) same.samples.values[c][i] = xyz[c];
    }
    return same;
  }
  if (own.size() == theirs.size() && own.size() == 3 && back.channels.wavelengths_nm.empty() &&
      original.channels.wavelengths_nm.empty())
    return same;
  return std::nullopt;
}

// Finds samples by their directions, a little apart as they may be.
class SampleFinder {
 public:
  explicit SampleFinder(const Samples& samples) : samples_(samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) cells_.emplace(CellOf(samples.wi(i), samples.wo(i), 0), i);
  }

  std::optional<std::size_t> Find(const Vec3& wi, const Vec3& wo) const {
    std::optional<std::size_t> nearest;
    double least = kSameDirection;
    // A direction near a cell's side may have its fellow on the other side of it.
    for (unsigned sides = 0; sides < 64; ++sides) {
      const std::optional<Cell> cell = Neighbour(wi, wo, sides);
      if (!cell) continue;
      const auto range = cells_.equal_range(*cell);
      for (auto entry = range.first; entry != range.second; ++entry) {
        const double distance = std::max(Norm(samples_.wi(entry->second) - wi), Norm(samples_.wo(entry->second) - wo));
        if (distance > least) continue;
        least = distance;
        nearest = entry->second;
      }
    }
    return nearest;
  }

 private:
  using Cell = std::array<int, 6>;
  static constexpr double kSide = 0.01;

  static std::array<double, 6> Coordinates(const Vec3& wi, const Vec3& wo) {
    return {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
  }

  static Cell CellOf(const Vec3& wi, const Vec3& wo, double shift) {
    Cell cell;
    const std::array<double, 6> at = Coordinates(wi, wo);
    for (std::size_t k = 0; k < 6; ++k) cell[k] = static_cast<int>(std::floor((at[k] + shift) / kSide));
    return cell;
  }

  // The cell with the coordinates of `sides` moved across their nearest side; nothing where that is too far.
  static std::optional<Cell> Neighbour(const Vec3& wi, const Vec3& wo, unsigned sides) {
    Cell cell;
    const std::array<double, 6> at = Coordinates(wi, wo);
    for (std::size_t k = 0; k < 6; ++k) {
      const double scaled = at[k] / kSide, floor = std::floor(scaled);
      cell[k] = static_cast<int>(floor);
      if (((sides >> k) & 1U) == 0) continue;
      const double within = (scaled - floor) * kSide;
      if (within < kSameDirection) {
        --cell[k];
      } else if (kSide - within < kSameDirection) {
        ++cell[k];
      } else {
        return std::nullopt;
      }
    }
    return cell;
  }

  const Samples& samples_;
  std::multimap<Cell, std::size_t> cells_;
};

// f relative to g, as CompareWith takes it: both are measured against what is about the middle of all values.
Difference Summary(std::vector<double> differences) {
  Difference summary;
  summary.compared = differences.size();
  if (differences.empty()) return summary;
  std::sort(differences.begin(), differences.end());
  summary.median = differences[differences.size() / 2];
  summary.percentile_90 = differences[differences.size() * 9 / 10];
  summary.maximum = differences.back();
  return summary;
}

WrittenDifference CompareSamples(const Measurement& original, const Measurement& back) {
  const SampleFinder finder(back.samples);
  constexpr std::size_t kMost = 200000;
  const std::size_t stride = std::max<std::size_t>(1, original.samples.size() / kMost);
  std::vector<double> differences;
  for (std::size_t i = 0; i < original.samples.size(); i += stride) {
    const std::optional<std::size_t> found = finder.Find(original.samples.wi(i), original.samples.wo(i));
    if (!found) continue;
    for (std::size_t c = 0; c < back.channels.size(); ++c) {
      const double a = original.samples.values[c][i], b = back.samples.values[c][*found];
      const double size = std::max(std::fabs(a), std::fabs(b));
      differences.push_back(size > 0 ? std::fabs(a - b) / size : 0.0);
    }
  }
  WrittenDifference written = {Summary(std::move(differences)), ""};
  if (written.difference.compared == 0)
    written.reason = "no sample of the written file has the directions of one that was to be written";
  return written;
}

}  // namespace

WrittenDifference CompareWritten(const Measurement& original, const Measurement& back, bool is_grid,
                                 const BrdfFunction& tabulated) {
  const std::optional<Measurement> same = WithChannelsOf(back, original);
  if (!same) {
    return {{},
            "the written file has the channels " + Excerpt(Join(back.channels.names), 60) + ", the measurement " +
                Excerpt(Join(original.channels.names), 60)};
  }
  if (!is_grid) return CompareSamples(*same, back);
  return {CompareWith(*same, tabulated ? tabulated : Interpolate(back), 20000), ""};
}

}  // namespace lobefit

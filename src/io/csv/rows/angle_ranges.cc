#include "lobefit/io/csv/rows/angle_ranges.h"

#include <array>
#include <limits>

#include "lobefit/math/vec.h"

namespace lobefit {

AngleRanges::AngleRanges(const CsvLayout& layout) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto& [coordinate, column] : layout.coordinates)
    ranges_.push_back({coordinate, column, kInfinity, -kInfinity});
}

StatedAngles AngleRanges::State(const CsvLayout& layout, const Coordinates& at) const {
  StatedAngles stated;
  static constexpr std::array<std::pair<Coordinate, const char*>, 5> kNames = {{{Coordinate::kThetaI, "theta_i"},
                                                                                {Coordinate::kPhiI, "phi_i"},
                                                                                {Coordinate::kThetaO, "theta_o"},
                                                                                {Coordinate::kPhiO, "phi_o"},
                                                                                {Coordinate::kDeltaPhi, "dphi"}}};
  for (const auto& [coordinate, name] : kNames) {
    if (!layout.directions.Has(coordinate)) continue;
    const double degrees = RadiansToDegrees(layout.directions.RadiansPerUnit(coordinate));
    const double number = at[static_cast<std::size_t>(coordinate)];
    std::pair<double, double> extent(number, number);
    for (const Range& range : ranges_) {
      if (range.coordinate == coordinate) extent = {range.low, range.high};
    }
    stated[name] = {degrees * extent.first, degrees * extent.second};
  }
  return stated;
}

}  // namespace lobefit

// UTIA `.bin`: float64 without a header, three colour planes of 288 x 288 pairs of directions, the viewer fastest. The
// files do not say how their numbers are encoded nor where the azimuth of the sample begins; programs that read them
// disagree on the first.
#include "lobefit/io/utia/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/io/utia/grid.h"
#include "lobefit/io/utia/value.h"

namespace lobefit {
namespace {

constexpr std::size_t kPairs = kUtiaDirections * kUtiaDirections;
constexpr std::size_t kBytes = 3 * kPairs * sizeof(double);

}  // namespace

double UtiaValue(double stored, const ReadOptions& options) {
  const double scale = options.utia_scale.value_or(1.0);
  if (options.utia_encoding == UtiaEncoding::kRaw) return scale * stored;
  const double encoded = std::max(0.0, stored) / 140;
  const double linear = encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
  return scale * 100 * linear;
}

void EchoUtiaOptions(const ReadOptions& options, Measurement* measurement) {
  measurement->conventions["utia-encoding"] = Name(options.utia_encoding);
  measurement->conventions["utia-scale"] =
      FormatDouble(options.utia_scale.value_or(1.0)) + (options.utia_scale ? " (option)" : " (default)");
}

bool IsUtia(std::string_view bytes) {
  if (bytes.size() != kBytes) return false;
  // A headerless file of the right size: reflectances of ordinary size, not text and not other binary data.
  for (std::size_t i = 0; i < kPairs; i += 997) {
    double value = 0;
    std::memcpy(&value, bytes.data() + i * sizeof(double), sizeof(double));
    if (!(std::fabs(value) < 1e9) || (value != 0 && std::fabs(value) < 1e-30)) return false;
  }
  return true;
}

Measurement ReadUtia(const InputFile& file, const ReadOptions& options) {
  return ReadUtiaGrid(file, options, kUtiaGrid);
}

Measurement ReadUtiaGrid(const InputFile& file, const ReadOptions& options, const UtiaGrid& grid) {
  const std::size_t pairs = grid.directions() * grid.directions(), bytes = 3 * pairs * sizeof(double);
  if (file.bytes.size() != bytes) {
    FailAtByte(
        file, std::min(file.bytes.size(), bytes),
        "a UTIA table has " + std::to_string(bytes) + " bytes, but the file has " + std::to_string(file.bytes.size()));
  }
  MeasurementBuilder builder({{"R", "G", "B"}, {}});
  std::array<double, 3> values = {};
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    for (std::size_t c = 0; c < 3; ++c) {
      double stored = 0;
      std::memcpy(&stored, file.bytes.data() + sizeof(double) * (pair + c * pairs), sizeof(double));
      values[c] = std::isfinite(stored) ? UtiaValue(stored, options) : stored;
    }
    builder.Add(grid.Direction(pair / grid.directions()), grid.Direction(pair % grid.directions()), values.data(),
                static_cast<std::uint32_t>(pair));
  }
  // At theta = 0 all azimuths are one direction: these are duplicates.
  Measurement measurement = builder.Finish();
  EchoUtiaOptions(options, &measurement);
  return measurement;
}

}  // namespace lobefit

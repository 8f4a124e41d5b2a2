#include "lobefit/io/merl/writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/merl/table.h"
#include "lobefit/math/directions.h"

namespace lobefit {

double AzimuthDependence(const BrdfFunction& brdf, std::size_t channels) {
  struct Pair {
    std::vector<double> straight, turned;
  };
  std::vector<Pair> pairs;
  double largest = 0;
  for (const double theta_i : {5.0, 30.0, 55.0, 70.0}) {
    for (const double theta_o : {0.0, 20.0, 30.0, 50.0, 70.0}) {
      for (const double phi : {40.0, 180.0, 150.0}) {
        const Vec3 wi = FromSpherical(DegreesToRadians(theta_i), 0);
        const Vec3 wo = FromSpherical(DegreesToRadians(theta_o), DegreesToRadians(phi));
        Pair pair = {std::vector<double>(channels), std::vector<double>(channels)};
        brdf(wi, wo, pair.straight.data());
        for (const double turn : {0.5, 1.3, 2.9, 4.0}) {
          brdf(RotateZ(wi, turn), RotateZ(wo, turn), pair.turned.data());
          for (const double value : pair.turned) largest = std::max(largest, std::fabs(value));
          pairs.push_back(pair);
        }
      }
    }
  }
  double worst = 0;
  for (const Pair& pair : pairs) {
    for (std::size_t c = 0; c < channels; ++c) {
      const double scale = std::max({std::fabs(pair.straight[c]), std::fabs(pair.turned[c]), 1e-3 * largest, 1e-300});
      worst = std::max(worst, std::fabs(pair.straight[c] - pair.turned[c]) / scale);
    }
  }
  return worst;
}

void WriteMerl(const BrdfFunction& brdf, const Channels& channels, const MerlWriteOptions& options,
               const std::filesystem::path& path) {
  const bool grey = channels.size() == 1 && channels.wavelengths_nm.empty();
  if (!grey && channels.names != std::vector<std::string>{"R", "G", "B"}) {
    throw UsageError("a MERL table holds the channels R, G, B, not " + Excerpt(Join(channels.names), 80) +
                     "; convert them with --channels rgb");
  }
  const double dependence = AzimuthDependence(brdf, channels.size());
  if (!(dependence <= options.azimuth_tolerance)) {
    throw UsageError(
        "a MERL table cannot hold this material: its f_r changes by up to " +
        FormatDouble(std::round(dependence * 1000) / 10) +
        " % when the sample turns about its normal, and the table has no azimuth of the sample; write it as "
        "rgl, alta or csv");
  }
  constexpr std::size_t kH = 90, kD = 90, kP = 180, kCells = kH * kD * kP;
  std::string bytes(MerlBytes({kH, kD, kP}), '\0');
  const std::array<std::int32_t, 3> dims = {kH, kD, kP};
  std::memcpy(bytes.data(), dims.data(), sizeof(dims));
  const double shift = options.cell == CellPosition::kCentre ? 0.5 : 0.0;
  ParallelFor(kH, HardwareThreads(), [&](std::size_t h) {
    std::array<double, 3> values = {};
    for (std::size_t cell = h * kD * kP; cell < (h + 1) * kD * kP; ++cell) {
      const double index_d = static_cast<double>(cell / kP % kD), index_p = static_cast<double>(cell % kP);
      const HalfDifference angles = {MerlThetaH(static_cast<double>(h) + shift), 0, (index_d + shift) / kD * kPi / 2,
                                     (index_p + shift) / kP * kPi};
      Vec3 wi, wo;
      FromHalfDifference(angles, &wi, &wo);
      const bool above = wi.z > 1e-9 && wo.z > 1e-9;
      const bool straight = above && (!options.covers || options.covers(wi, wo));
      const bool measured = straight || (above && options.covers(wo, wi));
      if (measured) brdf(straight ? wi : wo, straight ? wo : wi, values.data());
      if (grey) values[1] = values[2] = values[0];
      for (std::size_t c = 0; c < 3; ++c) {
        const double stored = measured ? std::max(0.0, values[c] / kMerlScale[c]) : -1.0;
        std::memcpy(bytes.data() + 12 + 8 * (cell + c * kCells), &stored, 8);
      }
    }
  });
  WriteFileAtomically(path, bytes);
}

}  // namespace lobefit

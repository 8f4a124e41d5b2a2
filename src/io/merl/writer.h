// Writing a MERL `.binary` table.
#pragma once

#include <filesystem>
#include <functional>

#include "lobefit/io/text/format.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Something of a pair of unit directions; safe to call from several threads.
using DirectionsPredicate = std::function<bool(const Vec3& wi, const Vec3& wo)>;

struct MerlWriteOptions {
  CellPosition cell = CellPosition::kCentre;  // where in its cell a value is sampled
  // Largest relative change of f_r when both directions turn about the normal; more is refused, since the table cannot
  // hold it.
  double azimuth_tolerance = 1e-3;
  DirectionsPredicate covers = {};  // the pairs at which f_r was measured, or which lie between those; null: all
};

// Largest change of f_r when both directions turn about the normal, over a fixed set of directions and all channels,
// relative to the larger of the two values and at least 1e-3 of the largest value seen: 0 for an isotropic function.
double AzimuthDependence(const BrdfFunction& brdf, std::size_t channels);

// 90 x 90 x 180 cells, R G B (one channel without a wavelength is written three times); -1, which means "not measured",
// where a direction is below the horizon, and where neither the pair nor the exchanged one (f_r is reciprocal, as the
// table is) is covered. Throws UsageError where f_r depends on the
// azimuth or the channels are not R G B, OutputError where the file cannot be written.
void WriteMerl(const BrdfFunction& brdf, const Channels& channels, const MerlWriteOptions& options,
               const std::filesystem::path& path);

}  // namespace lobefit

// Where a measurement has samples: a small picture for `lobefit info --png`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/measurement/measurement.h"
#include "lobefit/report/figures/report_options.h"

namespace lobefit {

// Three hemispheres seen from above (radius: polar angle): incident directions, outgoing directions, half vectors, with
// the number of samples in each of 45 x 45 cells. What zones and marks left out (Measurement::left_out) stands in rings
// of one colour a reason, with its number below. Isotropic measurements are turned so that the light stands at azimuth
// 0. Throws InputError where there is no sample, OutputError where the file cannot be written.
void WriteCoveragePng(const Measurement& measurement, const std::filesystem::path& path,
                      const ReportOptions& options = {});

// Number of samples in the cells of a disc, row-major, the first row at +y; for tests.
struct CoverageDisc {
  static constexpr int kCells = 45;
  std::string title;
  std::vector<std::size_t> counts;
  // What was left out, in the same cells: its most frequent reason; empty where nothing was.
  std::vector<std::optional<LeftOutReason>> left_out;
};
std::vector<CoverageDisc> CountCoverage(const Measurement& measurement);

}  // namespace lobefit

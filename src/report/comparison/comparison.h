// Models side by side: several materials fitted to one measurement, in one picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/report/figures/report_options.h"

namespace lobefit {

// One column of the comparison, best first.
struct ComparedModel {
  const Material* material = nullptr;
  std::string label;  // short: the name of the recipe
  std::string note;   // what the ranking says of it, "held-out 0.0123"; may be empty
};

// More are not told apart by colour, and their spheres would be too small.
inline constexpr std::size_t kMostCompared = 6;

// Draws the first kMostCompared models against `measurement`, which all were fitted to: errors under every metric,
// in-plane curves with one line a model, the ratio to the measurement over angles, lit spheres. Panels that the
// measurement cannot fill are left out. Throws InputError where a model's channels differ from the measurement's, or
// there is no sample or no model; OutputError where the file cannot be written.
void WriteComparisonPng(const std::vector<ComparedModel>& models, const Measurement& measurement,
                        const std::filesystem::path& path, const ReportOptions& options = {});

}  // namespace lobefit

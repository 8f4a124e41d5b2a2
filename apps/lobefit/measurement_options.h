// The options by which a verb reads a measurement: what a file leaves open, and which part of it is used.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "lobefit/io/read.h"
#include "lobefit/measurement/selection.h"

namespace lobefit {

class MeasurementOptions {
 public:
  // Adds the options; the object must outlive the parsing.
  void AddTo(CLI::App* app);
  // Reads `path` and applies the selection. Throws UsageError and InputError.
  Measurement Load(const std::string& path) const;
  // Keeps the chosen incident directions and channels.
  void Select(Measurement* measurement) const;

 private:
  std::string theta_i_, phi_i_, channels_;
  std::vector<std::string> words_;  // of the options of ReadOptionTable(), in its order; empty: not given
};

}  // namespace lobefit

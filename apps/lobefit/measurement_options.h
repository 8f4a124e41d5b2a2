// The options by which a verb reads a measurement: what a file leaves open, and which part of it is used.
#pragma once

#include <memory>
#include <string>

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

 private:
  ReadOptions Options() const;

  std::string angle_unit_, value_kind_, incident_, value_column_, merl_cell_, side_, xml_naming_, xml_wavelength_,
      alta_interval_, mountain_azimuth_, theta_i_, phi_i_;
  int zemax_rotation_sign_ = 1;
  double lighttools_azimuth_ = 90;
};

}  // namespace lobefit

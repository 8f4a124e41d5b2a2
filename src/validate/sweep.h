// An experiment from what a user asks for, and sweeps: the same experiment with one thing changed from point to point.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobefit/validate/calibration.h"
#include "lobefit/validate/experiment.h"
#include "lobefit/validate/layouts.h"

namespace lobefit {

struct ExperimentRequest {
  Truth truth;
  std::optional<MaterialRange> range;
  LayoutRequest layout;
  bool turned = false;
  Noise noise;
  Recipe recipe;
  // The fitted model follows the truth's where a sweep changes it.
  bool fit_truths_model = true;
  FitOptions fit;
  std::uint64_t seed = 1;
};

// Throws UsageError where the parts do not go together: an aperture wider than the layout's grid, an isotropic layout
// of an anisotropic model, a turned sample of a layout that has lost it.
Experiment MakeExperiment(const ExperimentRequest& request);

// What can be swept: a parameter of the truth by its name in documents (`alpha_x`, `theta_y_deg`) unless its NDF ties
// it to another, `alpha` (alpha_x with the ratio kept), `ratio` (alpha_x / alpha_y), `tilt` (degrees, towards -x), a
// noise term, `incidences` and `azimuths` (how many, evenly spread), `detector-step` (degrees), `metric` and `masking`
// (of the fit). Parameters stay within their bounds.
struct SweepPoint {
  std::string value;  // as given
  ExperimentRequest request;
  std::vector<Trial> trials;
  Calibration calibration;
};
struct Sweep {
  std::string name;
  std::vector<SweepPoint> points;
  bool numeric = true;
};

// "alpha=0.02,0.1,0.4". Throws UsageError with what can be swept.
Sweep ParseSweep(const std::string& text, const ExperimentRequest& base);

// For every parameter a table: bias, spread, coverage at each point.
std::string ToText(const Sweep& sweep);

}  // namespace lobefit

// The instrument from the command line, over what a recipe or the measurement's file says of it.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "lobefit/recipe/recipe.h"

namespace lobefit {

class InstrumentOptions {
 public:
  // --source, --detector, their priors, --drift, --alignment, --offset and, where `with_mean`, --mean.
  void AddTo(CLI::App* app, bool with_mean = true);
  // Throws UsageError.
  void Apply(Recipe* recipe) const;

 private:
  double source_deg_ = -1, detector_deg_ = -1, source_prior_deg_ = -1, detector_prior_deg_ = -1, across_deg_ = -1;
  std::string mean_, drift_, noise_model_;
  double alignment_deg_ = -1;
  bool offset_ = false;
};

// "flux" or "plain"; throws UsageError.
ApertureMean ParseApertureMean(const std::string& text);

}  // namespace lobefit

// lobefit synth --stack: an image stack from maps.
#pragma once

#include <cstddef>
#include <string>

#include "options/synthesis_options.h"

namespace lobefit {

class StackSynthesisOptions {
 public:
  void AddTo(CLI::App* app);
  bool wanted() const { return wanted_; }
  // `source`: a *.maps.exr, "hills" or "brushed-hills"; `out`: the folder of the stack. Noise and seed of `synthesis`.
  // Throws InputError, UsageError, OutputError.
  int Write(const std::string& source, const SynthesisOptions& synthesis, const std::string& out) const;

 private:
  bool wanted_ = false, shadows_ = false;
  std::string lights_ = "96";
  std::size_t size_ = 64;
  int bits_ = 16;
  double light_theta_max_deg_ = 65, light_distance_ = 0, camera_distance_ = 0, steepness_ = 1;
};

}  // namespace lobefit

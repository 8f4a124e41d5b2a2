// Options of the verbs that make synthetic measurements: the truth, the layout, the noise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "lobefit/synthesis/synthesis.h"
#include "lobefit/validate/layouts.h"
#include "lobefit/validate/truth.h"

namespace lobefit {

class SynthesisOptions {
 public:
  void AddTo(CLI::App* app);

  // A *.material.json, or a recipe (file or name) whose parameters have starts or fixed values.
  Truth LoadTruth(const std::string& source) const;
  LayoutRequest Layout() const;
  Noise ChosenNoise() const;
  std::uint64_t seed() const { return seed_; }

 private:
  std::string channels_ = "R,G,B", theta_i_ = "5,15,25,30,35,40,45,50,55,60,65,70", phi_i_ = "0";
  std::string layout_ = "goniometer", noise_, mean_;
  double step_ = 10, theta_max_ = 80;
  std::size_t samples_ = 256;
  bool in_plane_ = false;
  std::uint64_t seed_ = 1;
};

}  // namespace lobefit

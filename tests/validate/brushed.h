// The brushed metal of the samples, measured at few directions: what the tests of validation repeat many times.
#pragma once

#include "lobefit/validate/experiment.h"

namespace lobefit::test {

inline Truth BrushedMetal() {
  Truth truth;
  truth.model.lobes.resize(1);
  truth.values = {
      {0.35}, {0.11}, {0}, {DegreesToRadians(3)}, {DegreesToRadians(25)}, {0.7, 0.5, 0.4}, {0.02, 0.05, 0.03}};
  truth.channels = {"R", "G", "B"};
  return truth;
}

inline Experiment BrushedExperiment(const std::string& noise) {
  Experiment experiment;
  experiment.truth = BrushedMetal();
  GoniometerLayout layout;
  for (const double degrees : {10., 30., 50., 65.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : {0., 60., 120.}) layout.azimuths.push_back(DegreesToRadians(degrees));
  layout.detector_step = DegreesToRadians(20);
  experiment.directions = Goniometer(layout);
  experiment.noise = ParseNoise(noise);
  experiment.recipe = DefaultRecipe(experiment.truth.model, "test");
  experiment.fit.starts = 3;
  return experiment;
}

inline std::vector<Trial> Run(const Experiment& experiment, std::size_t count, int threads = 2) {
  const std::atomic<bool> stop{false};
  return RunTrials(experiment, count, threads, nullptr, stop);
}

}  // namespace lobefit::test

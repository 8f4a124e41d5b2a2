// Fitted materials with given numbers, for tests of exporters.
#pragma once

#include <string>
#include <vector>

#include "tests/support/synthetic.h"

#include "lobefit/material/material.h"

namespace lobefit::test {

inline Material MaterialOf(const SyntheticCase& synthetic) {
  Material material;
  material.model = synthetic.model;
  material.channels = synthetic.channels;
  if (material.channels.size() == 3) material.channels = {"R", "G", "B"};
  for (const std::vector<double>& values : synthetic.values) {
    FittedParameter parameter;
    parameter.values = values;
    parameter.standard_error.assign(values.size(), 0.01);
    parameter.standard_error_clustered.assign(values.size(), 0.01);
    material.parameters.push_back(parameter);
  }
  material.errors = {{"log", 0.0123}};
  material.termination = {true, true, "converged", 7};
  material.source = {"sample.csv", std::string(64, '0'), "csv", {}};
  material.recipe_name = "ellipsoid";
  material.metric = "log";
  material.weighting = "cells";
  material.loss = "none";
  material.theta_max_deg = 80;
  material.command = "lobefit fit sample.csv";
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) material.slope_space.push_back({0, 0, 0.1, 0.1, 0});
  return material;
}

// Brushed metal, leaning and turned.
inline SyntheticCase Tilted() {
  return OneLobe(Ndf::kEllipsoid, 0.35, 0.15, 6, -8, 30, {0.7, 0.6, 0.5}, {0.1, 0.05, 0.02});
}
// The same about the normal.
inline SyntheticCase Turned() {
  return OneLobe(Ndf::kGgxAnisotropic, 0.35, 0.11, 0, 0, 25, {0.7, 0.66, 0.58}, {0.02, 0.018, 0.015});
}
// Satin plastic.
inline SyntheticCase Plastic() {
  return OneLobe(Ndf::kGgx, 0.18, 0.18, 0, 0, 0, {0.04, 0.04, 0.04}, {0.42, 0.06, 0.05});
}
// A narrow and a wide lobe.
inline SyntheticCase TwoLobes() {
  SyntheticCase synthetic = OneLobe(Ndf::kGgxAnisotropic, 0.2, 0.08, 0, 0, -40, {0.5, 0.4, 0.3}, {0.05, 0.05, 0.05});
  synthetic.model.lobes.push_back({Ndf::kGgx, Masking::kSmithHeight, Fresnel::kSchlick});
  const std::vector<double> diffuse = synthetic.values.back();
  synthetic.values.pop_back();
  for (const std::vector<double>& values :
       {std::vector<double>{0.6}, {0.6}, {0.0}, {0.0}, {0.0}, {0.1, 0.1, 0.15}, diffuse}) {
    synthetic.values.push_back(values);
  }
  return synthetic;
}

}  // namespace lobefit::test

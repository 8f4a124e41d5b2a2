// What a synthetic measurement was made from: a model with its parameters, in the form in which fits report them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/recipe/recipe.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {

struct Truth {
  Model model;
  ParameterValues values;  // inside units, in the order of Parameters(model)
  std::vector<std::string> channels;
};

Truth TruthOf(const Material& material);
// A recipe whose parameters have a start or a fixed value; one value stands for all channels; those tied by the choice
// of NDF may be left out. Throws InputError that names `source` and the parameter.
Truth TruthOf(const Recipe& recipe, const std::vector<std::string>& channels, const std::string& source);
// A document with the values of `truth`, without errors: what synthetic files carry and exporters take.
Material MaterialOf(const Truth& truth);

BrdfFunction BrdfOf(const Truth& truth);
// The smallest alpha of its lobes: the scale of the finest structure in f_r, about its width in radians.
double SmallestAlpha(const Truth& truth);

// One number of a result: a parameter, or one channel of it.
struct Entry {
  std::string name;  // "alpha_x", "f0[R]"
  std::string unit;  // outside unit: "1", "deg"
  std::size_t parameter = 0, channel = 0;
  double factor = 1;  // inside value = outside value * factor
};
std::vector<Entry> Entries(const Model& model, const std::vector<std::string>& channels);

// `truth`, an ellipsoid's five parameters, in the form that fits report: 1 >= alpha_x >= alpha_y, third axis on the
// upper side, and of the two writings (theta_x, theta_y, theta_z), (-theta_x, -theta_y, theta_z +- pi) of the same
// distribution the one whose theta_z is nearer to that of `reported`. Errors are differences of such forms.
ParameterValues AlignedWith(const ParameterValues& reported, const Truth& truth);

// Largest relative difference of two lobes' slope-space forms: mean slope and the Cholesky factor of the shape, against
// its larger width. Free of the singularities of angles.
double SlopeDifference(const Truth& a, const ParameterValues& b);

// Materials for sweeps and recovery tests: alpha_x log-uniform, alpha_y / alpha_x log-uniform, tilt uniform in
// magnitude and direction, axes in any direction, f0 and diffuse uniform.
struct MaterialRange {
  double alpha_low = 0.02, alpha_high = 0.8;  // of the larger alpha; the smaller one stays above alpha_low
  double largest_anisotropy = 8;
  double largest_tilt = 15 * 3.14159265358979323846 / 180;
  double f0_low = 0.04, f0_high = 0.95;
  double diffuse_low = 0.005, diffuse_high = 0.4;
};
// Of the kind of `like`: its model and channels. What the model ties or fixes stays tied.
Truth DrawMaterial(const MaterialRange& range, const Truth& like, RandomNumbers* random);

}  // namespace lobefit

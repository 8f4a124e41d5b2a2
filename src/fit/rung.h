// What the search of one model of the ladder found, and how another search starts from it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// A profile of a lobe, with the shape whose radius its knots are counted in.
struct FoundProfile {
  SlopeCoordinates shape;
  std::shared_ptr<const ProfileGrid> grid;  // null: no profile
  std::vector<double> q;
};

struct FoundModel {
  std::vector<ParameterValues> shapes;  // [lobe] its ellipse
  // Fresnel terms, diffuse parts and exponents of tails, by name.
  std::map<std::string, std::vector<double>> others;
  std::vector<FoundProfile> profiles;  // [lobe]
};

// At the solver's coordinates `u`.
FoundModel FoundAt(const Layout& layout, const std::vector<double>& u);

// The lobes' ellipses as starts of the first lobes of a recipe, within the ranges of its parameters.
void StartShapesAt(const FoundModel& found, Recipe* recipe);

// All that was found as starts of a recipe of the same model for `channels` channels; what was found for another number
// of channels is no start. Profiles stand on the knots that they were found with and those further out that `samples`
// reach, where the local exponent is no other than theirs.
void StartAt(const FoundModel& found, std::size_t channels, const Samples& samples, Recipe* recipe);

// A model that was judged.
struct Rung {
  Recipe recipe;
  TriedModel tried;
  std::vector<double> mean_square;  // of each fold's test
  FoundModel found;                 // on the subsample
  bool above_one = false;           // the first lobe's reflectance is at its bound
  bool creates_energy = false;      // CreatesEnergy
  double mean() const;
};

}  // namespace lobefit

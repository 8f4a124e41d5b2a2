// What an instrument reads of a fitted surface: f_r through the discs, alignment, gains and offsets that the fit found.
// This stands beside measured values, in residuals and pictures; the surface alone does in what is exported.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

class Reading {
 public:
  // Of a material with a model. `held`: the side whose directions the instrument held, to which gains belong; without
  // it all gains are 1, as those of a measurement that was not fitted are not known. Throws InputError where the
  // discs are too wide for the cubature of a lobe.
  Reading(const Material& material, std::optional<Beam> held);

  // (*readings)[c][i], 1/sr, for directions above the horizon. `sample_azimuth`: of the sample on its stage, a
  // direction each, radians; null: as in the first turn. Safe from several threads.
  void Evaluate(const DirectionArrays& directions, const double* sample_azimuth,
                std::vector<std::vector<double>>* readings) const;

 private:
  std::uint32_t GainOf(const Vec3& w) const;

  KernelModel model_;
  AlignmentRecipe turns_;
  std::optional<Beam> held_;
  // By ascending cosine of the polar angle; the factors have one more, 1, for directions that have no gain.
  std::vector<Vec3> gain_directions_;
  std::vector<double> gains_;
};

}  // namespace lobefit

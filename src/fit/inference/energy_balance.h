// Whether a fitted model reflects more than it receives.
#pragma once

#include <string>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/brdf/model_energy.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Points of a lobe's slopes that a balance takes: albedos to some 0.5 %.
inline constexpr FacetGrid kBalanceGrid = {64, 32};
// Measured incident directions within `theta_max` (radians), at most `most`, spread over their polar angles, the
// steepest among them.
std::vector<Vec3> SpreadIncidences(const Incidences& incidences, double theta_max, std::size_t most = 16);

// The largest directional albedo of the model at the directions, over all channels.
EnergyBalance BalanceAt(const std::vector<Vec3>& wi, const Model& model, const ParameterValues& values,
                        const std::vector<std::string>& channels, ThreadPool* pool,
                        const FacetGrid& grid = kBalanceGrid);

// The scatter of the ABg lobes alone at the directions; empty where the model has none.
std::vector<ScatterAt> ScatterOfAbg(const std::vector<Vec3>& wi, const Model& model, const ParameterValues& values,
                                    std::size_t channels);

// A model that creates energy describes what was measured, and no surface: at best rough, with what to do about it.
// Does nothing for values of a free scale.
void JudgeEnergy(const EnergyBalance& balance, Verdict* verdict);

}  // namespace lobefit

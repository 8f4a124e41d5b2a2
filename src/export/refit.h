// Fitting a target's own model to the values of a fit.
#pragma once

#include <optional>

#include "lobefit/export/targets/error_meter.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// The material that a fit of `model` in the cube-root metric gives for the fit's own values at the directions of
// `meter`. Nothing where `model` is the fit's or the fit does not converge.
std::optional<FittedBrdf> Refit(const FittedBrdf& fit, const Model& model, const ErrorMeter& meter, int threads);

}  // namespace lobefit

// The standard error of a curve that is drawn from the parameters of a fit.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/material/material.h"

namespace lobefit {

// One number for each of the curve's: sqrt(g C g), g by central differences and C the clustered covariance where there
// is one. `depends(p, c)`: whether channel c of parameter p moves the curve. Empty where no such parameter is in the
// covariance.
std::vector<double> CurveError(const Material& material,
                               const std::function<std::vector<double>(const ParameterValues&)>& curve,
                               const std::function<bool(std::size_t, std::size_t)>& depends);

}  // namespace lobefit

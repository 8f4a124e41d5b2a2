// The 95 % interval of a curve that is drawn from the parameters of a fit.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/material/material.h"

namespace lobefit {

// Half of it, one number for each of the curve's: sqrt(g C g), g by central differences and C the clustered covariance
// where there is one, times the quantile of Student's t of the fewest degrees of freedom among the parameters that
// alone give a hundredth of that variance or more. `depends(p, c)`: whether channel c of parameter p moves the curve.
// Empty where no such parameter is in the covariance.
std::vector<double> HalfIntervals(const Material& material,
                                  const std::function<std::vector<double>(const ParameterValues&)>& curve,
                                  const std::function<bool(std::size_t, std::size_t)>& depends);

}  // namespace lobefit

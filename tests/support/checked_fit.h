// Fit, with the conditions of Karush, Kuhn and Tucker checked of what it returns.
#pragma once

#include "lobefit/fit/fit.h"

namespace lobefit {

// As Fit. Of a material that is called converged it is then expected, by the whole model and the cost written again,
// that the document's cost is that of its parameters, and that no free parameter, moved alone by three tenths of its
// standard error within its bounds, leads to a cost that is lower by more than a tenth of a standard error explains.
// Not of instruments, stated uncertainties, conserved energy and estimated noise, whose costs this does not hold.
Material CheckedFit(const Recipe& recipe, const FitOptions& options, Measurement* measurement);

}  // namespace lobefit

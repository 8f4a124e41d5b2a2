// One material as a row of the table of results.
#pragma once

#include <string>
#include <vector>

#include "lobefit/material/material.h"

namespace lobefit {

// The columns that a document fills as a JSON object, in order: recipe, model, what the data are, how good the fit is,
// and each parameter with its errors ("alpha_x", "alpha_x.stderr", "alpha_x.stderr_clustered", and the degrees of
// freedom of the latter "alpha_x.clustered_freedom"; "f0[R]"; outside units).
// Null: not determined or not there. Nothing of it depends on the machine or the moment.
std::string ResultRow(const Material& material);

// The columns of ResultRow that every material has, in order.
const std::vector<std::string>& FixedResultColumns();

}  // namespace lobefit

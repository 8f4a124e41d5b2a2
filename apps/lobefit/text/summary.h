// Results for people, on stdout.
#pragma once

#include <string>

#include "lobefit/material/material.h"

namespace lobefit {

// Parameters with their intervals, errors, what was set aside and what is not determined.
std::string Summary(const Material& material);

// "0.1234 +- 0.0012": as many digits as the error warrants; without an error, five.
std::string WithError(double value, double standard_error);

}  // namespace lobefit

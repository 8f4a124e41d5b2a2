// Statistics of plain lists of numbers.
#pragma once

#include <vector>

namespace lobefit {

// The middle value, of an even number the upper one of the two in the middle. `values` has one at least.
double Median(std::vector<double> values);

}  // namespace lobefit

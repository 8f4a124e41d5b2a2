// The slice that a fit misses most, drawn in characters under the summary of a fit; only where people look.
#pragma once

#include <string>

#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Columns of the terminal behind stdout; 0 where stdout is a pipe or a file.
int TerminalColumns();

// The narrowest terminal that a plot fits into.
inline constexpr int kLeastPlotColumns = 72;

// Measured ('o') against fitted ('-', both: '@') over the angle of the direction that sweeps, f_r on a logarithmic
// axis: the in-plane slice of at least 8 samples with the largest root mean square of ln(measured / fitted), each
// channel counted, drawn as the mean of the channels. Empty where `columns` are too few or no such slice exists. Lines
// are ASCII and at most min(columns, 100) long. Domain: the channels of the two agree.
std::string WorstSlicePlot(const Material& material, const Measurement& measurement, int columns);

}  // namespace lobefit

// What the live page computes with: the model, its parameters, slices, a table of the measured values, and values to
// test itself by.
#pragma once

#include <string>

#include "lobefit/report/figures/report_data.h"

namespace lobefit {

// One JSON object that may stand inside a <script> element.
std::string DataJson(const ReportData& data);

}  // namespace lobefit

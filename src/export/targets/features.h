// The features of a fit that targets may lose, as rows of their tables.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"

namespace lobefit {

// Rows for every feature that this fit has, all exact: shape, rotation, tilt, masking, Fresnel, diffuse, second lobe,
// channels.
std::vector<Carried> AllExactly(const FittedBrdf& fit, const std::string& note);

// Changes the row of `feature` where the fit has it.
void Mark(std::vector<Carried>* rows, const std::string& feature, Carries how, const std::string& note);

// "" or that the target holds only red, green and blue or one channel.
std::string RefuseSpectra(const FittedBrdf& fit);
// "" or the name of a distribution, masking or Fresnel term that shader text does not know.
std::string RefuseUnknownTerms(const FittedBrdf& fit);

}  // namespace lobefit

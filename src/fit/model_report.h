// What a fit found of the model, for the document: parameters with their errors and covariance, what is not determined,
// the minima.
#pragma once

#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/file_clusters.h"
#include "lobefit/fit/errors/uncertainty.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/distinct.h"
#include "lobefit/material/material.h"

namespace lobefit {

// Parameters with their errors, slope space and covariance in outside terms; axes of lobes whose widths agree are named
// as not determined. `u`: the solution. material->model and channels are set.
void ReportParameters(const Layout& layout, const std::vector<double>& u, const Uncertainty& uncertainty,
                      Material* material);

// Errors by file, and a remark where they are larger than those by incidence. After ReportParameters.
void ReportByFile(const FileErrors& errors, Material* material);

// Takes the errors from the coefficients of which the prior knows more than the samples (their posterior variance is
// more than half its own), and from those that begin beyond the half vectors of `samples`, which act through the
// normalisation and the masking alone; names them. After ReportParameters.
void FlagUndeterminedProfiles(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                              const Samples& samples, ThreadPool* pool, Material* material);

// Whether all is determined but coefficients of a free Fresnel curve: at angles that were not measured they change
// nothing that was; they are named, and the rest is determined without them.
bool DeterminedButForCurves(const Uncertainty& uncertainty, const Layout& layout);

Minimum Describe(const Layout& layout, const DistinctMinimum& minimum);

}  // namespace lobefit

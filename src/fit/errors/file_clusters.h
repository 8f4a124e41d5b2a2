// Errors of what is reported where the samples of one file may depend on each other too: of a series, each file is a
// mounting of the sample, a day, a run with faults of its own.
#pragma once

#include <cstdint>
#include <vector>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

// Of the reported entries (Layout::Report, flattened; inside units). Empty where files say nothing that incidences do
// not: one file, or each file within one incidence.
struct FileErrors {
  std::vector<double> variance;  // NaN for an entry without an error
  std::vector<double> freedom;   // degrees of freedom, for Student's t
};

// CR2 over files (clusters.h) where every incidence lies within one file. Where the same incidences come again in
// several, both ways at once [Cameron, Gelbach and Miller 2011, eq 2.8]: the variance over incidences and that over
// files, less that over what shares both; not less than either, since the difference may be anything where few of them
// decide. The degrees of freedom are then the fewer of the two. Three more passes over the samples at most.
//
// `files`: one a sample, as Samples::file, or empty. Nothing under a drift of gains, which is one an incidence.
FileErrors EstimateErrorsByFile(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, const std::vector<std::uint32_t>& files,
                                ThreadPool* pool);

}  // namespace lobefit

// What is reported, as rows over the whitened coordinates of the sandwich (bread.h).
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/errors/bread.h"

namespace lobefit {

struct ReportedEntries {
  SparseRows rows;                          // d reported entry / d whitened coordinate; zeros for one without an error
  std::vector<bool> undetermined;           // [entry] has a part in an undetermined direction
  std::vector<Eigen::Index> without_error;  // those, and entries that are not differentiable
};

ReportedEntries EntriesOf(const Layout& layout, const std::vector<double>& u, const Bread& bread);

}  // namespace lobefit

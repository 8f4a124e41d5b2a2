#include "lobefit/fit/errors/entries.h"

#include <cmath>

namespace lobefit {

ReportedEntries EntriesOf(const Layout& layout, const std::vector<double>& u, const Bread& bread) {
  ReportedEntries entries;
  SparseRows jacobian = layout.ReportJacobian(u.data());
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    bool undetermined = false, finite = true;
    for (SparseRows::InnerIterator entry(jacobian, row); entry; ++entry) {
      undetermined = undetermined || (bread.undetermined[static_cast<std::size_t>(entry.col())] && entry.value() != 0);
      finite = finite && std::isfinite(entry.value());
    }
    entries.undetermined.push_back(undetermined);
    if (!undetermined && finite) continue;
    entries.without_error.push_back(row);
    for (SparseRows::InnerIterator entry(jacobian, row); entry; ++entry) entry.valueRef() = 0;
  }
  entries.rows = jacobian * bread.whitening;
  return entries;
}

}  // namespace lobefit

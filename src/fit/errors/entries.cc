#include "lobefit/fit/errors/entries.h"

namespace lobefit {

Entries EntriesOf(const Layout& layout, const std::vector<double>& u, const Bread& bread) {
  Entries entries;
  Eigen::MatrixXd jacobian = layout.ReportJacobian(u.data());
  for (Eigen::Index row = 0; row < jacobian.rows(); ++row) {
    bool undetermined = false;
    for (std::size_t k = 0; k < layout.size(); ++k)
      undetermined = undetermined || (bread.undetermined[k] && jacobian(row, static_cast<Eigen::Index>(k)) != 0);
    entries.undetermined.push_back(undetermined);
    if (!undetermined && jacobian.row(row).allFinite()) continue;
    entries.without_error.push_back(row);
    jacobian.row(row).setZero();
  }
  const SparseRows by_coordinate = jacobian.sparseView(), whitening = bread.whitening.sparseView();
  entries.rows = by_coordinate * whitening;
  return entries;
}

}  // namespace lobefit

#include "lobefit/fit/search/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace lobefit {

SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace lobefit

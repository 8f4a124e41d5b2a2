// Eigenvalues and eigenvectors of symmetric matrices, compiled once: in each file that uses it the solver takes 10 s.
#pragma once

#include <Eigen/Core>

namespace lobefit {

// symmetric = vectors diag(values) vectors^T.
struct SymmetricEigen {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // a column each, orthonormal
};

// `symmetric`: n x n and finite, of which the lower triangle is read.
SymmetricEigen DecomposeSymmetric(const Eigen::MatrixXd& symmetric);

}  // namespace lobefit

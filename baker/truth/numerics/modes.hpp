// modes.hpp  Lowest eigenpairs of K v = w^2 M v by block Lanczos on the shifted inverse.
#pragma once
#include <Eigen/SparseCore>

namespace sinew::baker {

struct Eigenmodes {
  Eigen::VectorXd squared_rad_per_s;  // ascending
  Eigen::MatrixXd shape;              // a column a mode; shape^T M shape = 1
};

// Fewer than `count` when the matrix is smaller. `mass` is the diagonal of M. A mode's sign is fixed: its
// largest entry is positive.
Eigenmodes lowest_modes(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& mass, int count);

}  // namespace sinew::baker

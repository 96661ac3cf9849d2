// modes.hpp  Lowest eigenpairs of K v = w^2 M v by shift-invert subspace iteration.
#pragma once
#include <Eigen/SparseCore>

namespace sinew::baker {

// Squared angular frequencies, ascending; fewer than `count` when the matrix is smaller. `mass` is the
// diagonal of M.
Eigen::VectorXd lowest_squared_frequencies(const Eigen::SparseMatrix<double>& stiffness,
                                           const Eigen::VectorXd& mass, int count);

}  // namespace sinew::baker

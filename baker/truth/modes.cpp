// modes.cpp  Lowest eigenpairs of K v = w^2 M v by shift-invert subspace iteration (Bathe 2014,
// section 11.6).
#include "baker/truth/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <random>

namespace sinew::baker {
namespace {

Eigen::MatrixXd start_vectors(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 generator(1);
  return Eigen::MatrixXd::NullaryExpr(rows, columns,
                                      [&] { return static_cast<double>(generator()) / 4294967296.0 - 0.5; });
}

}  // namespace

Eigenmodes lowest_modes(const Eigen::SparseMatrix<double>& stiffness, const Eigen::VectorXd& mass,
                        int count) {
  constexpr double kShift = 1e-6, kConverged = 1e-9;
  constexpr int kMaxIterations = 300;
  const Eigen::Index wanted = std::min<Eigen::Index>(count, mass.size());
  const Eigen::Index size = std::min<Eigen::Index>(std::max(2 * wanted, wanted + 8), mass.size());
  const double shift =
      kShift * stiffness.diagonal().cwiseQuotient(mass).mean();  // a free body's K alone is singular
  Eigen::SparseMatrix<double> shifted = stiffness;
  shifted.diagonal() += shift * mass;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky(shifted);
  Eigen::MatrixXd x = start_vectors(mass.size(), size);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::MatrixXd y = cholesky.solve(mass.asDiagonal() * x);
    const Eigen::MatrixXd k = y.transpose() * (shifted * y), m = y.transpose() * mass.asDiagonal() * y;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(k, m);
    x = y * ritz.eigenvectors();
    const Eigen::VectorXd change = (ritz.eigenvalues() - values).head(wanted).cwiseAbs();
    values = ritz.eigenvalues();
    if ((change.array() <= kConverged * values.head(wanted).array()).all()) break;
  }
  Eigenmodes modes{(values.head(wanted).array() - shift).cwiseMax(0), x.leftCols(wanted)};
  for (Eigen::Index k = 0; k < wanted; ++k) {
    Eigen::Index largest = 0;
    modes.shape.col(k).cwiseAbs().maxCoeff(&largest);
    if (modes.shape(largest, k) < 0) modes.shape.col(k) *= -1;
  }
  return modes;
}

}  // namespace sinew::baker

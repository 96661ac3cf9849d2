// modes.cpp  Lowest eigenpairs of K v = w^2 M v by block Lanczos on the shifted inverse (Grimes, Lewis, Simon
// 1994), every block orthogonalised against all before.
#include "baker/truth/numerics/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <random>
#include <stdexcept>

#include "baker/truth/numerics/sparse_cholesky.hpp"

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kShift = 1e-6;  // of the mean of K's diagonal over M's: a free body's K alone is singular
// A wanted pair's residual over its value. The value is as exact as its square, and soft bodies' modes lie
// close together.
constexpr double kConverged = 1e-7;

MatrixXd random_block(Index rows, Index columns) {
  std::mt19937 generator(1);
  return MatrixXd::NullaryExpr(rows, columns,
                               [&] { return static_cast<double>(generator()) / 4294967296.0 - 0.5; });
}

MatrixXd orthonormal(const MatrixXd& columns) {
  return Eigen::HouseholderQR<MatrixXd>(columns).householderQ() *
         MatrixXd::Identity(columns.rows(), columns.cols());
}

Eigenmodes dense_modes(const Eigen::SparseMatrix<double>& stiffness, const VectorXd& root_mass,
                       Index wanted) {
  const VectorXd scale = root_mass.cwiseInverse();
  const MatrixXd scaled = scale.asDiagonal() * MatrixXd(stiffness) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  return {solver.eigenvalues().head(wanted).cwiseMax(0),
          scale.asDiagonal() * solver.eigenvectors().leftCols(wanted)};
}

// QR of a block that has lost rank returns directions of its own choice.
MatrixXd orthonormal_to(const Eigen::Ref<const MatrixXd>& so_far, const MatrixXd& block) {
  return orthonormal(block - so_far * (so_far.transpose() * block));
}

// The largest eigenvalues of B = sqrt(M) (K + shift M)^-1 sqrt(M), the inverses of what is wanted plus the
// shift.
Eigenmodes lanczos_modes(const Eigen::SparseMatrix<double>& stiffness, const VectorXd& root_mass,
                         Index wanted) {
  const VectorXd mass = root_mass.cwiseAbs2();
  const double shift = kShift * stiffness.diagonal().cwiseQuotient(mass).mean();
  Eigen::SparseMatrix<double> shifted = stiffness;
  shifted.diagonal() += shift * mass;
  SparseCholesky cholesky;
  cholesky.analyze(shifted);
  if (!cholesky.factor(shifted)) throw std::runtime_error("modes: the stiffness matrix is not positive");

  const Index size = mass.size(), block = std::clamp<Index>(wanted / 2, 8, 24);
  const Index most = std::min(size - block, 8 * wanted + 10 * block);
  MatrixXd basis(size, most + block), projected = MatrixXd::Zero(most + block, most + block);
  basis.leftCols(block) = orthonormal(random_block(size, block));
  for (Index known = block;; known += block) {
    MatrixXd next = root_mass.asDiagonal() *
                    cholesky.solve(root_mass.asDiagonal() * basis.middleCols(known - block, block));
    const auto so_far = basis.leftCols(known);
    MatrixXd along = so_far.transpose() * next;
    next -= so_far * along;
    const MatrixXd again = so_far.transpose() * next;
    next -= so_far * again;
    along += again;
    projected.block(0, known - block, known, block) = along;
    projected.block(known - block, 0, block, known) = along.transpose();
    if (known < wanted) {
      basis.middleCols(known, block) = orthonormal_to(so_far, orthonormal(next));
      continue;
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(projected.topLeftCorner(known, known));
    const MatrixXd pairs = ritz.eigenvectors().rightCols(wanted).rowwise().reverse();
    const VectorXd values = ritz.eigenvalues().tail(wanted).reverse();
    const VectorXd residuals = (next * pairs.bottomRows(block)).colwise().norm();
    if ((residuals.array() <= kConverged * values.array()).all() || known + block > most)
      return {(values.cwiseInverse().array() - shift).cwiseMax(0),
              root_mass.cwiseInverse().asDiagonal() * (so_far * pairs)};
    basis.middleCols(known, block) = orthonormal_to(so_far, orthonormal(next));
  }
}

}  // namespace

Eigenmodes lowest_modes(const Eigen::SparseMatrix<double>& stiffness, const VectorXd& mass, int count) {
  const Index wanted = std::min<Index>(count, mass.size());
  const VectorXd root_mass = mass.cwiseSqrt();
  const bool small = mass.size() <= 4 * (wanted + 16);
  Eigenmodes modes =
      small ? dense_modes(stiffness, root_mass, wanted) : lanczos_modes(stiffness, root_mass, wanted);
  for (Index k = 0; k < wanted; ++k) {
    Index largest = 0;
    modes.shape.col(k).cwiseAbs().maxCoeff(&largest);
    if (modes.shape(largest, k) < 0) modes.shape.col(k) *= -1;
  }
  return modes;
}

}  // namespace sinew::baker

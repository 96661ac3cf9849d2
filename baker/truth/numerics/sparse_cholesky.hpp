// sparse_cholesky.hpp  The Cholesky factor of a sparse symmetric positive definite matrix, by CHOLMOD's
// supernodal method (Chen et al. 2008) on BLAS, on one thread.
//
// Factors of tetrahedral meshes are mostly dense blocks: BLAS works through them ten times faster than a
// method that goes entry by entry. The same machine gives the same bits in every run.
#pragma once
#include <Eigen/SparseCore>
#include <memory>

namespace sinew::baker {

class SparseCholesky {
 public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  // Orders rows and lays out the factor for all matrices of this pattern, which has both triangles. Throws
  // std::bad_alloc where memory does not suffice, as factor and solve do.
  void analyze(const Eigen::SparseMatrix<double>& pattern);
  // Of a matrix of the analyzed pattern. False where it is not positive definite; solve then needs another.
  bool factor(const Eigen::SparseMatrix<double>& matrix);
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::baker

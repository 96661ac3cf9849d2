// sparse_cholesky.cpp  The only file that includes CHOLMOD.
#include "baker/truth/numerics/sparse_cholesky.hpp"

#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace sinew::baker {
namespace {

using SetNumber = void (*)(int);

SetNumber found(const char* function) { return reinterpret_cast<SetNumber>(dlsym(RTLD_DEFAULT, function)); }

// Bits must not depend on the number of cores, and whoever wants all cores runs several bakes. A BLAS other
// than OpenBLAS has no such function, and no threads; OpenMP's setting is the calling thread's.
void stay_on_this_thread() {
  static const SetNumber set_blas_threads = found("openblas_set_num_threads"),
                         set_openmp_levels = found("omp_set_max_active_levels");
  static const bool once = set_blas_threads != nullptr && (set_blas_threads(1), true);
  (void)once;
  if (set_openmp_levels != nullptr) set_openmp_levels(0);
}

// CHOLMOD's view of a matrix; it reads the lower triangle.
cholmod_sparse viewed(const Eigen::SparseMatrix<double>& matrix) {
  cholmod_sparse view{};
  view.nrow = static_cast<size_t>(matrix.rows());
  view.ncol = static_cast<size_t>(matrix.cols());
  view.nzmax = static_cast<size_t>(matrix.nonZeros());
  view.p = const_cast<int*>(matrix.outerIndexPtr());
  view.i = const_cast<int*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense viewed(const Eigen::MatrixXd& matrix) {
  cholmod_dense view{};
  view.nrow = view.d = static_cast<size_t>(matrix.rows());
  view.ncol = static_cast<size_t>(matrix.cols());
  view.nzmax = view.nrow * view.ncol;
  view.x = const_cast<double*>(matrix.data());
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

}  // namespace

struct SparseCholesky::Impl {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense *solution = nullptr, *work_y = nullptr, *work_e = nullptr;

  Impl() {
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
  }
  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void check() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < CHOLMOD_OK)
      throw std::runtime_error("a sparse factorisation failed with status " + std::to_string(common.status));
  }
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::analyze(const Eigen::SparseMatrix<double>& pattern) {
  cholmod_free_factor(&impl_->factor, &impl_->common);
  stay_on_this_thread();
  cholmod_sparse view = viewed(pattern);
  impl_->factor = cholmod_analyze(&view, &impl_->common);
  impl_->check();
}

bool SparseCholesky::factor(const Eigen::SparseMatrix<double>& matrix) {
  stay_on_this_thread();
  cholmod_sparse view = viewed(matrix);
  cholmod_factorize(&view, impl_->factor, &impl_->common);
  impl_->check();
  return impl_->common.status == CHOLMOD_OK && impl_->factor->minor == impl_->factor->n;
}

Eigen::MatrixXd SparseCholesky::solve(const Eigen::MatrixXd& right) const {
  stay_on_this_thread();
  cholmod_dense view = viewed(right);
  cholmod_solve2(CHOLMOD_A, impl_->factor, &view, nullptr, &impl_->solution, nullptr, &impl_->work_y,
                 &impl_->work_e, &impl_->common);
  impl_->check();
  return Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(impl_->solution->x), right.rows(),
                                           right.cols());
}

}  // namespace sinew::baker

// compared_solver.hpp  Solvers that rods' direct one is compared with, on the runtime's own batches.
//
// Yardsticks of published systems: conjugate gradients (Shao et al. 2021) and sweeps over joints (XPBD,
// Macklin 2016). Both take the direct solver's step where they go on to the end.
#pragma once
#include "baker/research/rods/kernels.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::baker {

enum class SolverKind : uint32_t {
  kDirect = 0,  // the runtime's own
  kCg = 1,      // conjugate gradients, preconditioned by the diagonal
  // Joint by joint (Gauss-Seidel, XPBD): a sweep costs less than an exact solution, and long or stiff strands
  // need hundreds. What it leaves undone is stretch and bend, never momentum. It knows no contacts.
  kLocal = 2,
};
const char* name_of(SolverKind kind) noexcept;

// Of one thread's batches, which it outlives, where it is.
struct ComparedSolver {
  SolverKind kind = SolverKind::kDirect;
  CgLimits cg = {};
  uint32_t local_sweeps = 10;  // over all joints, in each iteration; 1 to 10000

  uint32_t cg_iterations = 0;  // of all strands so far

  // For RodSettings::solver. Throws BadInput for a number outside its range.
  rods::RodSolver solver();
};

}  // namespace sinew::baker

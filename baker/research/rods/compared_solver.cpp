// compared_solver.cpp  see compared_solver.hpp.
#include "baker/research/rods/compared_solver.hpp"

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

void begin_cg(void*, const simd::RodJob& job, uint32_t width) { rod_research_calls(width).measure_cg(job); }

uint32_t iterate_cg(void* self, const simd::RodJob& job, uint32_t width) {
  auto& solver = *static_cast<ComparedSolver*>(self);
  return rod_research_calls(width).cg(job, solver.cg, &solver.cg_iterations);
}

uint32_t iterate_local(void* self, const simd::RodJob& job, uint32_t width) {
  return rod_research_calls(width).local(job, static_cast<ComparedSolver*>(self)->local_sweeps);
}

}  // namespace

const char* name_of(SolverKind kind) noexcept {
  return kind == SolverKind::kCg ? "cg" : kind == SolverKind::kLocal ? "local" : "direct";
}

rods::RodSolver ComparedSolver::solver() {
  if (!(cg.tolerance >= 1e-7f && cg.tolerance <= 1)) throw BadInput("cg: tolerance; give 1e-7 to 1");
  if (cg.max_iterations < 1 || cg.max_iterations > 100000) throw BadInput("cg: iterations; give 1 to 100000");
  if (local_sweeps < 1 || local_sweeps > 10000) throw BadInput("local: sweeps; give 1 to 10000");
  if (kind == SolverKind::kCg) return {begin_cg, iterate_cg, this};
  if (kind == SolverKind::kLocal) return {nullptr, iterate_local, this, false};
  return {};
}

}  // namespace sinew::baker

// compared_solver.cpp  see compared_solver.hpp.
#include "baker/research/rods/compared_solver.hpp"

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

rods::RodSolver ComparedSolver::solver() noexcept {
  if (kind == SolverKind::kCg) return {begin_cg, iterate_cg, this};
  return kind == SolverKind::kLocal ? rods::RodSolver{nullptr, iterate_local, this} : rods::RodSolver{};
}

}  // namespace sinew::baker

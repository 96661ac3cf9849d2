// kernels.cpp  Compiles the kernels of compared methods once an instruction set, on the runtime's own.
#include "baker/research/rods/kernels.hpp"

#include <iterator>

#include "kernels/kernels.hpp"
#include "kernels/targets.hpp"
#define HWY_TARGET_INCLUDE "baker/research/rods/kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "kernels/begin_calls.hpp"
#include "kernels/three-inl.hpp"
#include "kernels/rods/rod_lanes-inl.hpp"
#include "kernels/rods/rod_step-inl.hpp"
#include "kernels/rods/rod_relax-inl.hpp"
#include "kernels/rods/rod_linearise-inl.hpp"
#include "kernels/rod_contacts/rod_contacts-inl.hpp"
#include "kernels/rods/rod_direct-inl.hpp"
#include "kernels/rods/rod_start-inl.hpp"
#include "baker/research/rods/cg-inl.hpp"
#include "baker/research/rods/local-inl.hpp"
#include "baker/research/rods/nearest-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

template <size_t kWidth>
constexpr baker::RodResearchCalls rod_research_calls_of() {
  return {.measure_cg = rod_measure_cg<kWidth>,
          .cg = rod_cg<kWidth>,
          .local = rod_local<kWidth>,
          .add_nearest = rod_add_nearest<kWidth>};
}

constexpr baker::RodResearchTable kRodResearch = {HWY_TARGET, rod_research_calls_of<16>(),
                                                  rod_research_calls_of<4>()};

}  // namespace sinew::simd::HWY_NAMESPACE

#include "kernels/end_calls.hpp"

#if HWY_ONCE
namespace sinew::simd {
namespace {

const baker::RodResearchTable& active_table() noexcept {
  static const baker::RodResearchTable* const tables[] = {HWY_CHOOSE_TARGET_LIST(kRodResearch),
                                                          HWY_CHOOSE_FALLBACK(kRodResearch)};
  for (const baker::RodResearchTable* table : tables) {
    if (table && table->target == kernels().target) return *table;
  }
  return *tables[std::size(tables) - 1];
}

}  // namespace
}  // namespace sinew::simd

namespace sinew::baker {

const RodResearchCalls& rod_research_calls(uint32_t width) noexcept {
  const RodResearchTable& table = simd::active_table();
  return width == 16 ? table.wide : table.narrow;
}

}  // namespace sinew::baker
#endif

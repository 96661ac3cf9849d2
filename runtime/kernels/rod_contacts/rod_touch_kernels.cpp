// rod_touch_kernels.cpp  Compiles what finds and follows rods' contacts once an instruction set; kernels.cpp
// puts it into its tables.
#include "kernels/rod_contacts/rod_touch_job.hpp"

#include "kernels/rod_contacts/rod_force_job.hpp"
#include "kernels/rods/rod_job.hpp"
#include "kernels/targets.hpp"
#define HWY_TARGET_INCLUDE "kernels/rod_contacts/rod_touch_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "kernels/begin_calls.hpp"
#include "kernels/wasm_doubles-inl.hpp"
#include "kernels/three-inl.hpp"
#include "kernels/rods/rod_lanes-inl.hpp"
#include "kernels/rod_contacts/rod_reach-inl.hpp"
#include "kernels/plain-inl.hpp"
#include "kernels/rod_contacts/rod_look-inl.hpp"
#include "kernels/rod_contacts/rod_touch-inl.hpp"
#include "kernels/rod_contacts/rod_forces-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

template <size_t kWidth>
constexpr RodTouchCalls rod_touch_calls() {
  return {.reach = rod_reach<kWidth>,
          .near_round = rod_near_round<kWidth>,
          .near_flat = rod_near_flat<kWidth>,
          .enter = rod_enter<kWidth>,
          .touch = rod_touch<kWidth>};
}

extern const RodTouchKernels kRodTouchKernels;
const RodTouchKernels kRodTouchKernels = {.wide = rod_touch_calls<16>(), .narrow = rod_touch_calls<4>()};
extern const RodForceKernels kRodForceKernels;
const RodForceKernels kRodForceKernels = {.look = rod_look, .take = rod_take, .push = rod_push};

}  // namespace sinew::simd::HWY_NAMESPACE

#include "kernels/end_calls.hpp"

// rod_touch_kernels.cpp  Compiles what finds and follows rods' contacts once an instruction set; kernels.cpp
// puts it into its tables.
#include "simd/rod_touch_job.hpp"

#include "simd/rod_force_job.hpp"
#include "simd/rod_job.hpp"
#include "simd/targets.hpp"
#define HWY_TARGET_INCLUDE "simd/rod_touch_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "simd/begin_calls.hpp"
#include "simd/wasm_doubles-inl.hpp"
#include "simd/three-inl.hpp"
#include "simd/rod_lanes-inl.hpp"
#include "simd/rod_reach-inl.hpp"
#include "simd/plain-inl.hpp"
#include "simd/rod_look-inl.hpp"
#include "simd/rod_touch-inl.hpp"
#include "simd/rod_forces-inl.hpp"
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

#include "simd/end_calls.hpp"

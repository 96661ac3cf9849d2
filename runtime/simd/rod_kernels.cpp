// rod_kernels.cpp  Compiles the rod kernels once an instruction set; kernels.cpp puts them into its tables.
#include "simd/rod_job.hpp"
#include "simd/targets.hpp"
#define HWY_TARGET_INCLUDE "simd/rod_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

// In this order: each needs the ones before it.
// clang-format off
#include "simd/begin_calls.hpp"
#include "simd/three-inl.hpp"
#include "simd/rod_lanes-inl.hpp"
#include "simd/rod_step-inl.hpp"
#include "simd/rod_relax-inl.hpp"
#include "simd/rod_linearise-inl.hpp"
#include "simd/rod_contacts-inl.hpp"
#include "simd/rod_residual-inl.hpp"
#include "simd/rod_direct-inl.hpp"
#include "simd/tanh-inl.hpp"
#include "simd/rod_start-inl.hpp"
#include "simd/rod_learned-inl.hpp"
#include "simd/rod_pack-inl.hpp"
// clang-format on

namespace sinew::simd::HWY_NAMESPACE {

template <size_t kWidth>
constexpr RodCalls rod_calls() {
  return {.start = {.continue_start = rod_continue<kWidth>,
                    .add_network = rod_add_network<kWidth>,
                    .encode_joints = rod_encode_joints<kWidth>},
          .predict = rod_predict<kWidth>,
          .hold_forces = rod_hold_forces<kWidth>,
          .direct = rod_direct<kWidth>,
          .residual = rod_residual<kWidth>,
          .finish = rod_finish<kWidth>,
          .move_lanes = rod_move_lanes<kWidth>};
}

extern const RodKernels kRodKernels;
const RodKernels kRodKernels = {.wide = rod_calls<16>(), .narrow = rod_calls<4>()};

}  // namespace sinew::simd::HWY_NAMESPACE

#include "simd/end_calls.hpp"

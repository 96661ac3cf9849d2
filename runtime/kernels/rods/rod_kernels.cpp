// rod_kernels.cpp  Compiles the rod kernels once an instruction set; kernels.cpp puts them into its tables.
#include "kernels/rods/rod_job.hpp"
#include "kernels/targets.hpp"
#define HWY_TARGET_INCLUDE "kernels/rods/rod_kernels.cpp"
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
#include "kernels/rods/rod_residual-inl.hpp"
#include "kernels/rods/rod_direct-inl.hpp"
#include "kernels/tanh-inl.hpp"
#include "kernels/rods/rod_start-inl.hpp"
#include "kernels/rods/rod_learned-inl.hpp"
#include "kernels/rods/rod_pack-inl.hpp"
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

#include "kernels/end_calls.hpp"

// joint_fields.hpp  What of a joint may be changed after its batch was made.
#pragma once
#include "kernels/rods/rod_job.hpp"

namespace sinew::rods {

// In the order of RodBatch::made_joints_.
inline constexpr simd::RodField kJointFields[] = {simd::kRodBendCompliance, simd::kRodTwistCompliance,
                                                  simd::kRodDamping};

}  // namespace sinew::rods

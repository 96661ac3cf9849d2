// learned_start.hpp  What a batch with RodStart::kLearned takes from a COPINGNet.
//
// The network corrects what kContinued starts from: told by how much that missed in the last step, over its
// root mean square on the strand, it answers by how much it will miss now, in the same measure. So one set of
// weights serves rods of all sizes, stiffnesses and speeds, and a strand that moves as it did costs nothing
// in accuracy. See kernels/rods/rod_start_job.hpp for the inputs; a node's outputs are accelerations, a
// joint's its force and moment.
#pragma once
#include "kernels/rods/rod_start_job.hpp"
#include "rods/start/coping_net.hpp"

namespace sinew::rods {

// Refused: none, a width that is no multiple of 8 or above pack::kPanel.
Status check_learned_start(const CopingNet* network) noexcept;

simd::RodStartNet start_net(const CopingNet& network) noexcept;

// What the network is told of a joint: rest [3] (SegmentDef's Darboux vector times length), and the
// logarithms of the compliances of bend and twist in the strand's own units, over ten.
void joint_inputs(const float (&rest)[3], float bend_compliance, float twist_compliance,
                  float (&out)[simd::kRodJointInputs]) noexcept;

}  // namespace sinew::rods

// instance.cpp  One character in the world: what its state points to.
#include "character/instance.hpp"

#include <type_traits>

namespace sinew::world {
namespace {

static_assert(std::is_trivially_copyable_v<InstanceState>, "saved as bytes");
static_assert(sizeof(InstanceState) == 872, "no padding: equal states are equal bytes");

}  // namespace

void point_to_state(Instance& instance) noexcept {
  instance.level = &instance.asset->levels[instance.state->level];
  const uint32_t first = instance.state->poses.first_joints;
  Matrix34** const poses[] = {&instance.motion.joints_older, &instance.motion.joints_before,
                              &instance.motion.joints, &instance.motion.next_joints};
  for (uint32_t k = 0; k < 4; ++k) *poses[k] = instance.motion.pose_joints[(first + k) % 4];
}

}  // namespace sinew::world

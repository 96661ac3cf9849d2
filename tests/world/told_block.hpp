// told_block.hpp  A block that is told its tier and level, where a world's scheduler would choose.
#pragma once
#include <algorithm>
#include <vector>

#include "baker/common/lone_instance.hpp"
#include "tests/world/stage.hpp"

namespace sinew::test {

class ToldBlock : public baker::LoneInstance {
 public:
  explicit ToldBlock(const scenes::PackBytes& pack, const ContactDef& contacts = {})
      : LoneInstance(pack.bytes(), contacts) {}
  void tick(const Motion& motion, const Plan& plan) {
    time_s_ += tick_s();
    const scenes::BlockPose pose = motion(time_s_);
    std::ranges::copy(pose.joints, joints().begin());
    root() = pose.root;
    step(plan);
  }
  void play(const Motion& motion, const Plan& plan, int ticks) {
    for (int t = 0; t < ticks; ++t) tick(motion, plan);
  }
  // What the surface is displaced by.
  std::vector<float> surface() const { return positions(Space::kBind); }
  // Displacement of the nodes as it is shown.
  std::vector<float> shown() const {
    return {instance().transition.shown[0],
            instance().transition.shown[0] + size_t{3} * asset().node_count()};
  }

 private:
  double time_s_ = 0;
};

}  // namespace sinew::test

// told_block.hpp  A block that is told its tier, level and rate, where a world's scheduler would choose.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/world/stage.hpp"
#include "world/instance.hpp"
#include "world/read.hpp"
#include "world/tick.hpp"

namespace sinew::test {

class ToldBlock {
 public:
  explicit ToldBlock(const scenes::PackBytes& pack, const ContactDef& contacts = {}) {
    REQUIRE(world::open_asset(pack.bytes(), &asset_).ok());
    REQUIRE(world::make_instance(asset_, {.contacts = contacts}, &block_).ok());
  }
  struct Plan {
    Tier tier;
    uint32_t level = 0;
  };
  void tick(const Motion& motion, const Plan& plan) {
    time_s_ += asset_.tick_s;
    const scenes::BlockPose pose = motion(time_s_);
    std::ranges::copy(pose.joints, block_.next_joints);
    block_.state->next_root = pose.root;
    block_.state->has_next = 1;
    block_.plan = {.ticks = {.ticks = 1, .first_tick_s = asset_.tick_s},
                   .dt_s = asset_.tick_s,
                   .tier = plan.tier,
                   .level = plan.level};
    world::step_instance(block_, {.clock = {}, .profiler = {}, .sleep_tolerance = sleep_tolerance});
  }
  void play(const Motion& motion, const Plan& plan, int ticks) {
    for (int t = 0; t < ticks; ++t) tick(motion, plan);
  }
  // What the surface is displaced by.
  std::vector<float> surface() const {
    std::vector<float> out(size_t{3} * asset_.vertex_count());
    world::read_positions(block_,
                          {.space = Space::kBind, .out = out.data(), .capacity = asset_.vertex_count()});
    return out;
  }
  // Displacement of the nodes as it is shown.
  std::vector<float> shown() const {
    return {block_.shown[0], block_.shown[0] + size_t{3} * asset_.node_count()};
  }
  world::Instance& instance() { return block_; }
  const world::Asset& asset() const { return asset_; }
  double height_m() const { return static_cast<double>(asset_.pack.character->height_m); }

  float sleep_tolerance = 0;

 private:
  world::Asset asset_;
  world::Instance block_;
  double time_s_ = 0;
};

}  // namespace sinew::test

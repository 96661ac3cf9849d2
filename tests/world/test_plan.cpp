// test_plan.cpp  What a plan leaves for those that run last.
#include "world/step/plan.hpp"

#include "character/asset/open_asset.hpp"
#include "character/life/create_instance.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kIdle = 4;

// One whose network is paid for, and others that nothing is left for.
struct Floor {
  world::WorldState world;
  world::Asset* asset = nullptr;

  Floor() {
    REQUIRE(world::reserve(world, {.max_assets = 1, .max_instances = 1 + kIdle}));
    world::Asset opened;
    REQUIRE(world::open_asset(test::block_pack().bytes(), &opened).ok());
    const AssetId id = world.assets.create(std::move(opened));
    asset = world.assets.find(id);
    for (uint32_t i = 0; i <= kIdle; ++i) add({.asset = id, .importance = i == 0 ? 1e6f : 1});
    world.costs.overhead = world.costs.idle = frame::CostEstimate(0);
    const frame::Front& front = asset->costs.front;
    world.budget_us = front.step_us(front.best(), 1) + 0.5f * front.step_us(1, 1);
    world.budget_us = world.budget_us / world.costs.capacity.scale();
  }
  void add(const InstanceDef& def) {
    world::Instance made;
    REQUIRE(world::make_instance(*asset, def, &made).ok());
    world.instances.create(std::move(made));
    world::keep_row(world, world.instances.end() - 1);
    world.rows[world.instances.end() - 1].seen = true;
  }
};

}  // namespace

TEST_CASE("what_idle_characters_take_behind_all_others_is_left_for_as_one_step_in_twenty_takes_it") {
  Floor floor;
  constexpr float kUsual_us = 0.001f;
  for (int step = 0; step < 600; ++step) {
    floor.world.costs.idle.observe(step % 10 == 0 ? 1.9f * kUsual_us : kUsual_us);
    floor.world.costs.idle.settle();
  }
  REQUIRE(floor.world.costs.idle.p95_us() > 1.4f * floor.world.costs.idle.estimate_us());
  world::plan_step(floor.world, floor.asset->tick_s);
  REQUIRE(floor.world.order.running.size() == 1);
  REQUIRE(floor.world.order.idle_count == kIdle);
  CHECK(floor.world.planning.answers[0].decision.behind_us == Approx(kIdle * floor.world.costs.idle.p95_us()));
}

// test_short_memory.cpp  Where memory is short a call is refused, and the world goes on. In an executable of
// its own: it replaces the allocator.
#include <cstdio>
#include <fstream>

#include "sinew/sinew.h"
#include "tests/pack/short_memory.hpp"
#include "tests/scenes/half_spaces.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using namespace sinew::test;

namespace {

struct Case {
  const char* name;
  scenes::BlockOptions options;
  bool touches_own_body = false;
};

// Modes alone; a network; rods that touch; three levels of which one leaves a region out; arms against the
// flesh.
std::vector<Case> cases() {
  return {{"modes", {.network = false}},
          {"network", {}},
          {"rods", {.rods = scenes::RodMatter{.sewn = true}}},
          {"levels", {.nodes = 40, .coarser_nodes = {20, 10}, .leaves_out = true}},
          {"levels with rods", {.nodes = 40, .rods = scenes::RodMatter{.bar = true}, .coarser_nodes = {10}}},
          {"arms", {.arms = scenes::ArmMatter{}}, true}};
}

// A world in which something lives already, and another with the same that no call fails in.
struct Twins {
  Stage stage, twin;
  double time_s = 0;
  explicit Twins(const WorldDef& def = {}) : stage(2, def), twin(2, def) {}

  bool go_on() {
    time_s += 1.0 / 60;
    for (Stage* each : {&stage, &twin}) {
      for (const InstanceId block : each->blocks) each->pose(block, scenes::walk(time_s));
      each->world.step(1.0f / 60);
    }
    return hash_of(stage) == hash_of(twin) && stage.save() == twin.save();
  }
};

void require_each_is_refused(const Refusals& refusals, size_t at_least) {
  INFO(refusals.wrong);
  REQUIRE(refusals.wrong.empty());
  CHECK(refusals.count >= at_least);
}

// Both ways: one allocation alone, and all from there on. `undo` takes back what succeeded.
template <class Work, class GoesOn, class Undo>
void refuse_in_turn(const Work& work, const GoesOn& goes_on, const Undo& undo, bool may_keep = false) {
  for (const bool and_all_after : {false, true}) {
    const Refusals refusals = refuse_each(work, goes_on, {and_all_after, may_keep});
    require_each_is_refused(refusals, 1);
    CHECK(goes_on());
    undo();
    CHECK(goes_on());
  }
}

}  // namespace

TEST_CASE("the_allocator_refuses_the_allocation_that_it_is_told") {
  const size_t live = live_blocks();
  refuse_allocation(2);
  void* volatile first = std::malloc(10);
  void* volatile second = std::malloc(10);
  void* volatile third = ::operator new(10, std::nothrow);
  void* volatile fourth = ::operator new (64, std::align_val_t{64}, std::nothrow);
  const size_t asked = allocations_asked_for();
  CHECK((first && !second && third && fourth));
  CHECK(asked == 4);
  CHECK(live_blocks() == live + 3);
  std::free(first);
  ::operator delete(third);
  ::operator delete (fourth, std::align_val_t{64});
  CHECK(live_blocks() == live);
}

TEST_CASE("without_memory_a_world_is_not_made") {
  const WorldDef def{.report_history = 16, .event_capacity = 16};
  const auto nothing = [] { return true; };
  for (const bool and_all_after : {false, true}) {
    World world;
    const Refusals refusals =
        refuse_each([&] { return World::create(def, &world); }, nothing, {and_all_after});
    require_each_is_refused(refusals, 15);
  }
}

TEST_CASE("without_memory_a_pack_is_not_loaded_and_the_world_goes_on") {
  for (const Case& each : cases()) {
    INFO(each.name);
    const scenes::PackBytes pack = scenes::soft_block(each.options);
    const std::string path = std::string(SINEW_BINARY_DIR) + "/short_memory.sinew";
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(pack.bytes().data()),
               static_cast<std::streamsize>(pack.bytes().size()));
    Twins twins;
    AssetId made;
    World& world = twins.stage.world;
    const auto undo = [&] { REQUIRE(world.unload_asset(made).ok()); };
    const auto go_on = [&] { return twins.go_on(); };
    refuse_in_turn([&] { return world.load_asset(pack.bytes(), &made); }, go_on, undo);
    refuse_in_turn([&] { return world.load_asset_file(path.c_str(), &made); }, go_on, undo);
    std::remove(path.c_str());
  }
}

namespace {

// What an asset keeps for its next instance goes with it.
template <class Work>
void require_all_given_back(const Work& work) {
  work();  // what Catch makes at first use
  const size_t live = live_blocks();
  work();
  const size_t left = live_blocks() - live;
  CHECK(left == 0);
}

void refuse_instances(Twins& twins, const scenes::PackBytes& pack, ContactDef contacts) {
  World& world = twins.stage.world;
  InstanceDef def{.contacts = contacts};
  InstanceId made;
  REQUIRE(world.load_asset(pack.bytes(), &def.asset).ok());
  refuse_in_turn([&] { return world.create_instance(def, &made); }, [&] { return twins.go_on(); },
                 [&] { REQUIRE(world.destroy_instance(made).ok()); }, true);
  REQUIRE(world.unload_asset(def.asset).ok());
}

}  // namespace

TEST_CASE("without_memory_an_instance_is_not_made_and_the_world_goes_on") {
  for (const Case& each : cases()) {
    INFO(each.name);
    const scenes::PackBytes pack = scenes::soft_block(each.options);
    scenes::HalfSpaces floor, skin;
    for (const bool touches : {false, true}) {
      Twins twins;
      ContactDef contacts;
      if (touches) contacts = {.source = &floor, .own_body = each.touches_own_body, .surface = &skin};
      require_all_given_back([&] { refuse_instances(twins, pack, contacts); });
    }
  }
}

namespace {

struct Side {
  World world;
  AssetId first, second;
  InstanceId blocks[2];
  AssetInfo info;

  Side(const scenes::PackBytes& pack, const scenes::PackBytes& by, const ContactDef& contacts) {
    REQUIRE(World::create({}, &world).ok());
    REQUIRE(world.load_asset(pack.bytes(), &first).ok());
    REQUIRE(world.load_asset(by.bytes(), &second).ok());
    REQUIRE(world.asset_info(first, &info).ok());
    REQUIRE(world.create_instance({.asset = first}, &blocks[0]).ok());
    REQUIRE(world.create_instance({.asset = first, .contacts = contacts}, &blocks[1]).ok());
  }
  std::vector<std::byte> state() const {
    const size_t bytes = world.state_bytes(blocks[0]);
    std::vector<std::byte> out(bytes + world.state_bytes(blocks[1]));
    REQUIRE(world.save_state(blocks[0], std::span(out).first(bytes)).ok());
    REQUIRE(world.save_state(blocks[1], std::span(out).subspan(bytes)).ok());
    return out;
  }
  void step(double time_s) {
    std::vector<Matrix34> joints(info.joint_count);
    REQUIRE(world.bind_pose(first, joints).ok());
    joints[1].m[0][3] += 0.02f * static_cast<float>(std::sin(15 * time_s));
    for (const InstanceId block : blocks) REQUIRE(world.set_pose(block, {.joints = joints}).ok());
    world.step(1.0f / 60);
  }
};

void refuse_replacements(const scenes::PackBytes& pack, const scenes::PackBytes& by,
                         const ContactDef& contacts) {
  Side side(pack, by, contacts), twin(pack, by, contacts);
  double time_s = 0;
  const auto go_on = [&] {
    time_s += 1.0 / 60;
    side.step(time_s);
    twin.step(time_s);
    return side.state() == twin.state();
  };
  for (int f = 0; f < 10; ++f) REQUIRE(go_on());
  for (const bool back_again : {false, true}) {
    AssetId from = side.first, to = side.second;
    if (back_again) std::swap(from, to);
    const Refusals refusals =
        refuse_each([&] { return side.world.replace_asset(from, to); }, go_on, {back_again, true});
    require_each_is_refused(refusals, 3);
    REQUIRE(twin.world.replace_asset(from, to).ok());
    CHECK(go_on());
  }
}

}  // namespace

TEST_CASE("without_memory_no_asset_is_replaced_and_its_instances_go_on") {
  for (const Case& each : cases()) {
    INFO(each.name);
    scenes::BlockOptions anew = each.options;
    anew.seed = 7;
    const scenes::PackBytes pack = scenes::soft_block(each.options), by = scenes::soft_block(anew);
    scenes::HalfSpaces floor;
    const ContactDef contacts{.source = &floor, .own_body = each.touches_own_body};
    require_all_given_back([&] { refuse_replacements(pack, by, contacts); });
  }
}

// Nothing that a frame calls asks for memory; where none is left it goes on as where there is.
TEST_CASE("the_first_frames_and_all_that_is_set_do_without_memory") {
  for (const Case& each : cases()) {
    INFO(each.name);
    const scenes::PackBytes pack = scenes::soft_block(each.options);
    Stage stage(2, {}, pack);
    World& world = stage.world;
    std::vector<float> out(size_t{3} * stage.info.vertex_count);
    std::vector<Matrix34> joints(stage.info.joint_count);
    REQUIRE(world.bind_pose(stage.asset, joints).ok());
    std::vector<std::byte> saved = stage.save();
    bool ok = true;
    const View view{.position_m = {0, 0.3, 3}};
    refuse_allocation(1, true);
    for (int f = 0; f < 30; ++f) {
      joints[1].m[0][3] += 0.002f;
      for (const InstanceId block : stage.blocks) {
        ok = ok && world.set_pose(block, {.joints = joints}).ok();
        ok = ok && world.set_parameters(block, {.stiffness = 1.2f}).ok();
        ok = ok && world.set_region_parameters(block, 0, {.intensity = 0.5f}).ok();
        ok = ok && world.set_tier_limit(block, f % 10 < 5 ? Tier::kModal : Tier::kNetwork).ok();
        ok = ok && world.set_hidden(block, f % 10 == 7).ok();
        ok = ok && world.set_time_scale(block, 0.5f).ok();
        ok = ok && world.set_importance(block, 2).ok();
      }
      ok = ok && world.set_views({&view, 1}).ok();
      ok = ok && world.set_budget_us(f % 8 == 0 ? 0.0f : 1e9f).ok();
      world.step(f == 3 ? 0.0f : 1.0f / 60);
      ok = ok &&
           world.read_positions(stage.blocks[0], {.out = out.data(), .capacity = stage.info.vertex_count})
               .ok();
      ok = ok && world.read_joint_matrices(stage.blocks[0], joints).ok();
      ok = ok && world.save_state(stage.blocks[0], saved).ok();
      ok = ok && world.restore_state(stage.blocks[0], saved).ok();
      if (f == 20) ok = ok && world.reset(stage.blocks[1]).ok();
    }
    const size_t asked = allocations_asked_for();
    CHECK(ok);
    CHECK(asked == 0);
    CHECK(all_finite(out));
  }
}

namespace {

Status status_of(sinew_status status) {
  Status out{.code = static_cast<StatusCode>(status)};
  std::snprintf(out.message, sizeof out.message, "%s", sinew_message());
  return out;
}

}  // namespace

TEST_CASE("without_memory_the_c_interface_refuses_and_goes_on") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{.sewn = true}});
  const auto refuse = [](const auto& call, bool and_all_after, size_t at_least) {
    const Refusals refusals =
        refuse_each([&] { return status_of(call()); }, [] { return true; }, {and_all_after, true});
    require_each_is_refused(refusals, at_least);
  };
  const auto play = [&](bool and_all_after) {
    const sinew_world_def world_def = sinew_default_world_def();
    sinew_world world = {};
    refuse([&] { return sinew_create_world(SINEW_LAYOUT, &world_def, &world); }, and_all_after, 15);
    sinew_asset asset = {}, by = {};
    const std::span<const std::byte> bytes = pack.bytes();
    refuse([&] { return sinew_load_asset(world, bytes.data(), bytes.size(), &asset); }, and_all_after, 6);
    REQUIRE(sinew_load_asset(world, bytes.data(), bytes.size(), &by) == SINEW_OK);
    sinew_instance_def def = sinew_default_instance_def();
    def.asset = asset;
    def.contacts.find = [](const sinew_contact_probe*, uint32_t, float, sinew_contact_hit*, uint32_t, void*) {
      return 0u;
    };
    sinew_instance instance = {};
    refuse([&] { return sinew_create_instance(world, &def, &instance); }, and_all_after, 5);
    refuse([&] { return sinew_replace_asset(world, asset, by); }, and_all_after, 5);
    CHECK(sinew_step(world, 1.0f / 60, nullptr) == SINEW_OK);
    CHECK(sinew_destroy_world(world) == SINEW_OK);
  };
  for (const bool and_all_after : {false, true}) require_all_given_back([&] { play(and_all_after); });
}

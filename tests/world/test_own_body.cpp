// test_own_body.cpp  Soft blocks against the capsules about their own arms.
#include <algorithm>
#include <cmath>

#include "tests/scenes/half_spaces.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::ArmMatter;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr double kRounding_m = 1e-6;  // as against walls
constexpr double kAim_m = 1e-5;       // of trembling in a resting contact
constexpr double kPressed_m = -0.13;  // the arm's way from 10 cm off the block to 3 cm in it

const scenes::PackBytes& arm_pack(bool touches_body = true) {
  static const scenes::PackBytes packs[] = {scenes::soft_block({.arms = ArmMatter{.touches_body = false}}),
                                            scenes::soft_block({.arms = ArmMatter{}})};
  return packs[touches_body];
}

struct ArmStage : Stage {
  ArmMatter matter;
  double turn_rad = 0;  // of the first arm

  explicit ArmStage(bool own_body = true, const WorldDef& def = {},
                    const scenes::PackBytes& pack = arm_pack(), const ArmMatter& arms = {},
                    ContactSource* source = nullptr)
      : Stage(0, def, pack), matter(arms) {
    add_with({.source = source, .own_body = own_body});
  }
  // On this tier.
  explicit ArmStage(Tier tier, const scenes::PackBytes& pack = arm_pack(), const ArmMatter& arms = {})
      : ArmStage(true, {.budget_mode = BudgetMode::kWorkUnits}, pack, arms) {
    REQUIRE(world.set_budget_us(tier == Tier::kNetwork ? INFINITY : 1.01f * test::tier_cost_us(tier)).ok());
  }
  void add_with(const ContactDef& contacts) {
    InstanceId made;
    REQUIRE(world.create_instance({.asset = asset, .contacts = contacts}, &made).ok());
    blocks.push_back(made);
  }
  void step_to(double way_m, const scenes::BlockPose& block = scenes::bind_pose(), double dt_s = kFrame_s) {
    for (const InstanceId id : blocks)
      REQUIRE(world.set_pose(id, scenes::with_arms(block, matter, way_m, turn_rad).pose()).ok());
    world.step(static_cast<float>(dt_s));
  }
  void hold(double way_m, int frames) {
    for (int f = 0; f < frames; ++f) step_to(way_m);
  }
  void swing(double from_m, double to_m, int frames) {
    for (int f = 1; f <= frames; ++f) step_to(from_m + (to_m - from_m) * f / frames);
  }
  // How far any vertex goes in a tick, two seconds after the arm came to stand there.
  double trembles_m(double way_m) {
    swing(0, way_m, 30);
    hold(way_m, 120);
    double most = 0;
    for (int f = 0; f < 120; ++f) {
      const std::vector<float> before = read();
      hold(way_m, 1);
      most = std::max(most, test::largest_distance(read(), before));
    }
    REQUIRE(report().vertices_touched > 3);
    return most;
  }
  // Vertices in the first arm or on it.
  size_t touching(double way_m) const {
    constexpr double kOn_m = 1e-3;
    size_t count = 0;
    for_each_depth(way_m, [&](double depth_m) { count += depth_m > -kOn_m; });
    return count;
  }
  // Of all vertices in the first arm; the lower ones, which are not soft, are far from it.
  double deepest_m(double way_m) const {
    double most = 0;
    for_each_depth(way_m, [&](double depth_m) { most = std::max(most, depth_m); });
    return most;
  }
  template <class Visit>
  void for_each_depth(double way_m, Visit visit) const {
    const std::vector<float> places = read();
    const double x_m = matter.at_x_m[0] + way_m, c = std::cos(turn_rad), s = std::sin(turn_rad);
    for (size_t v = 0; v + 2 < places.size(); v += 3) {
      const auto at = [&](size_t k) { return static_cast<double>(places[v + k]); };
      const double across_m = c * (at(0) - x_m) - s * at(2), along_m = s * (at(0) - x_m) + c * at(2);
      const double beyond_m = std::max(0.0, std::abs(along_m) - 0.2);
      visit(matter.radius_m - std::hypot(across_m, at(1) - scenes::kArmHeight_m, beyond_m));
    }
  }
};

}  // namespace

TEST_CASE("an_arm_swung_into_the_flesh_is_outside_of_it_on_every_simulated_tier") {
  for (const Tier tier : {Tier::kNetwork, Tier::kModal}) {
    ArmStage stage(tier);
    stage.hold(0, 30);
    CHECK(stage.report().vertices_touched == 0);
    for (int f = 1; f <= 12; ++f) {
      stage.step_to(kPressed_m * f / 12);
      CHECK(stage.deepest_m(kPressed_m * f / 12) < kRounding_m);
    }
    stage.hold(kPressed_m, 60);
    REQUIRE(stage.report().tier == tier);
    CHECK(stage.deepest_m(kPressed_m) < kRounding_m);
    CHECK(stage.report().vertices_touched > 5);
    CHECK(stage.report().contact_volume_m3 > 0);
    CHECK(stage.report().deepest_penetration_m < static_cast<float>(kRounding_m));
  }
  ArmStage off(false);
  off.swing(0, kPressed_m, 12);
  CHECK(off.deepest_m(kPressed_m) > 0.02);
}

TEST_CASE("an_arm_that_turns_into_the_flesh_is_outside_of_it") {
  constexpr double kBeside_m = -0.05, kTurn_rad = 0.45;
  for (const bool own_body : {true, false}) {
    ArmStage stage(own_body);
    stage.swing(0, kBeside_m, 10);
    double most_m = 0;
    for (int f = 1; f <= 12; ++f) {
      stage.turn_rad = kTurn_rad * f / 12;
      stage.step_to(kBeside_m);
      most_m = std::max(most_m, stage.deepest_m(kBeside_m));
    }
    if (own_body)
      CHECK(most_m < kRounding_m);
    else
      CHECK(most_m > 0.02);
  }
}

TEST_CASE("an_arm_beyond_what_flesh_gives_way_has_nothing_inside_and_flesh_loses_nothing") {
  constexpr float kHalf_m3 = 0.15f * 0.3f * 0.3f;  // that is soft, and on the arm's side
  for (const Tier tier : {Tier::kNetwork, Tier::kModal}) {
    for (const double middle_m : {-0.2, -0.25, -0.3}) {
      ArmStage stage(tier);
      for (int f = 1; f <= 90; ++f) {
        const double way_m = middle_m * std::min(f, 30) / 30;
        stage.step_to(way_m);
        REQUIRE(stage.deepest_m(way_m) < kRounding_m);
        REQUIRE(stage.report().contact_volume_m3 < kHalf_m3);
        REQUIRE(test::all_finite(stage.read()));
      }
      CHECK(stage.report().tier == tier);
      CHECK(stage.report().restarts == 0);
      CHECK(stage.report().fallbacks == 0);
    }
  }
}

TEST_CASE("what_an_arm_leaves_inside_where_flesh_may_go_no_further_is_told_in_every_tick") {
  constexpr double kThrough_m = -0.45;
  static const scenes::PackBytes stiff = scenes::soft_block({.displacement_limit = 0.2, .arms = ArmMatter{}});
  ArmStage stage(Tier::kModal, stiff);
  double most_m = 0;
  for (int f = 1; f <= 90; ++f) {
    const double way_m = kThrough_m * std::min(f, 30) / 30;
    stage.step_to(way_m);
    const double left_m = stage.deepest_m(way_m);
    most_m = std::max(most_m, left_m);
    REQUIRE(left_m < static_cast<double>(stage.report().deepest_penetration_m) + kRounding_m);
  }
  CHECK(most_m > 0.01);
  CHECK(stage.report().vertices_touched <= stage.touching(kThrough_m));  // each once
}

TEST_CASE("flesh_that_an_arm_pushes_against_a_wall_is_outside_of_both_or_told") {
  const ArmMatter thin{.radius_m = 0.04};
  const scenes::PackBytes pack = scenes::soft_block({.arms = thin});
  for (const double wall_m : {-0.12, -0.09, -0.06}) {
    scenes::HalfSpaces wall;
    wall.walls = {{{wall_m, 0, 0}, {1, 0, 0}}};
    ArmStage stage(true, {}, pack, thin, &wall);
    const auto check_at = [&](double way_m) {
      stage.step_to(way_m);
      const std::vector<float> places = stage.read();
      double left_m = stage.deepest_m(way_m);
      for (size_t v = 0; v < places.size(); v += 3)
        if (places[v + 1] > 0.45f) left_m = std::max(left_m, wall_m - static_cast<double>(places[v]));
      CHECK(left_m < static_cast<double>(stage.report().deepest_penetration_m) + kRounding_m);
    };
    for (int f = 1; f <= 120; ++f) check_at(-0.16 * (1 - std::cos(0.2 * f)));
    for (const double way_m : {-0.16, -0.2, -0.24, -0.28})
      for (int f = 0; f < 120; ++f) check_at(way_m);
  }
}

TEST_CASE("flesh_that_an_arm_presses_as_deep_as_it_is_thick_stands_still") {
  for (const Tier tier : {Tier::kNetwork, Tier::kModal}) {
    for (const double radius_m : {0.03, 0.05, 0.08}) {
      const ArmMatter matter{.radius_m = radius_m};
      for (const double depth_m : {0.02, 0.04, 0.06}) {
        const scenes::PackBytes pack = scenes::soft_block({.arms = matter});
        ArmStage stage(tier, pack, matter);
        CHECK(stage.trembles_m(radius_m - 0.15 - depth_m) < kAim_m);
      }
    }
  }
}

TEST_CASE("flesh_of_many_vertices_a_node_that_an_arm_presses_stands_still") {
  for (const int nodes : {5, 14}) {
    for (const double height_m : {0.49, 0.51}) {
      const ArmMatter matter{.height_m = height_m, .radius_m = 0.04};
      const scenes::PackBytes pack = scenes::soft_block({.cells = 12, .nodes = nodes, .arms = matter});
      ArmStage stage(Tier::kNetwork, pack, matter);
      CHECK(stage.trembles_m(-0.15) < kAim_m);
    }
  }
}

TEST_CASE("flesh_that_an_arm_goes_through_within_a_tick_is_held_on_the_side_it_came_to") {
  // The right face is at 0.15. A thin arm goes from 0.3 to 0.12, as a whole behind it. Later flesh swings
  // back and slides off: nothing but single vertices lie on the arm.
  constexpr double kThrough_m = -0.18;
  const ArmMatter thin{.radius_m = 0.02};
  const scenes::PackBytes pack = scenes::soft_block({.arms = thin});
  // As fast as it is, it is not taken for a teleport here.
  ArmStage stage(true, {.teleport = {.distance = 1}}, pack, thin);
  const std::vector<float> rest = Stage().read();
  stage.hold(0, 10);
  for (int f = 0; f < 5; ++f) {
    stage.step_to(kThrough_m);
    const std::vector<float> places = stage.read();
    double rightmost = -1;
    for (size_t v = 0; v < rest.size(); v += 3) {
      const bool hit = rest[v] > 0.149f && std::fabs(rest[v + 1] - 0.5f) < 0.01f;
      if (hit) rightmost = std::max(rightmost, static_cast<double>(places[v]));
    }
    REQUIRE(rightmost > -1);
    CHECK(rightmost < 0.3 + kThrough_m);
  }
}

// It goes by as much as its own thickness in a tick, and so does flesh that follows it.
TEST_CASE("flesh_that_a_thin_arm_leaves_quickly_stays_on_its_side") {
  constexpr double kDeep_m = 0.03, kOut_m = 0.03;
  for (const double radius_m : {0.015, 0.02}) {
    const ArmMatter thin{.radius_m = radius_m};
    const scenes::PackBytes pack = scenes::soft_block({.cells = 12, .arms = thin});
    ArmStage stage(Tier::kModal, pack, thin);
    const std::vector<float> rest = stage.read();
    const double in_m = radius_m - 0.15 - kDeep_m;
    stage.swing(0, in_m, 60);
    stage.hold(in_m, 60);
    REQUIRE(stage.report().vertices_touched > 3);
    for (int f = 0; f <= 3; ++f) {
      const double way_m = in_m + kOut_m * f;
      stage.step_to(way_m);
      const std::vector<float> places = stage.read();
      for (size_t v = 0; v < rest.size(); v += 3)
        if (rest[v] > 0.149f && std::fabs(rest[v + 1] - scenes::kArmHeight_m) < 0.01)
          CHECK(static_cast<double>(places[v]) < thin.at_x_m[0] + way_m);
    }
  }
}

TEST_CASE("capsules_in_the_flesh_at_rest_and_of_bones_that_carry_it_are_passed_for_ever") {
  for (const bool of_the_waist : {false, true}) {
    const ArmMatter matter{.at_x_m = {of_the_waist ? 0.35 : 0.17}, .waist_too = of_the_waist};
    const scenes::PackBytes pack = scenes::soft_block({.arms = matter});
    ArmStage on(true, {}, pack, matter), off(false, {}, pack, matter);
    for (int f = 0; f < 60; ++f) {
      const scenes::BlockPose block = scenes::shake(1 + f * kFrame_s);
      for (ArmStage* stage : {&on, &off}) stage->step_to(-0.001 * f, block);
      REQUIRE(on.read() == off.read());
    }
    CHECK(on.report().vertices_touched == 0);
  }
}

TEST_CASE("regions_that_do_not_say_so_and_instances_that_do_not_ask_touch_nothing_of_their_body") {
  const ArmMatter matter;
  ArmStage unsaid(true, {}, arm_pack(false)), unasked(false), neither(false, {}, arm_pack(false));
  for (ArmStage* stage : {&unsaid, &unasked, &neither}) {
    stage->swing(0, kPressed_m, 30);
    CHECK(stage->report().vertices_touched == 0);
    CHECK(stage->world.state_bytes(stage->blocks[0]) == neither.world.state_bytes(neither.blocks[0]));
    CHECK(stage->read() == unsaid.read());
  }
}

TEST_CASE("an_arm_that_stays_away_changes_no_bit") {
  ArmStage on, off(false);
  for (int f = 0; f < 60; ++f) {
    for (ArmStage* stage : {&on, &off}) stage->step_to(0.05, scenes::walk(f * kFrame_s));
    REQUIRE(on.read() == off.read());
  }
}

TEST_CASE("flesh_is_held_by_a_wall_and_by_an_arm_at_once") {
  scenes::HalfSpaces wall;
  wall.walls = {{{-0.13, 0, 0}, {1, 0, 0}}};
  ArmStage stage(true, {}, arm_pack(), {}, &wall);
  stage.swing(0, kPressed_m, 12);
  stage.hold(kPressed_m, 30);
  CHECK(stage.deepest_m(kPressed_m) < kRounding_m);
  const std::vector<float> places = stage.read();
  for (size_t v = 0; v < places.size(); v += 3)
    if (places[v + 1] > 0.45f) CHECK(places[v] > -0.13f - static_cast<float>(kRounding_m));
}

TEST_CASE("an_arm_s_contacts_have_room_where_a_source_has_more_than_fit") {
  scenes::HalfSpaces walls;
  walls.near_m = 100;
  walls.walls.assign(300, {{-5, 0, 0}, {1, 0, 0}});
  ArmStage stage(true, {}, arm_pack(), {}, &walls);
  stage.swing(0, kPressed_m, 12);
  stage.hold(kPressed_m, 30);
  CHECK(stage.report().contacts_dropped > 0);
  CHECK(stage.report().vertices_touched > 5);
  CHECK(stage.deepest_m(kPressed_m) < kRounding_m);
}

TEST_CASE("flesh_that_an_arm_hardly_misses_at_rest_sleeps") {
  const ArmMatter beside{.at_x_m = {0.15 + 1.07 * scenes::kArmRadius_m}};
  const scenes::PackBytes pack = scenes::soft_block({.arms = beside});
  ArmStage stage(true, {}, pack, beside);
  stage.hold(0, 240);
  CHECK(stage.report().regions_asleep == 2);
}

TEST_CASE("flesh_that_sleeps_is_woken_by_an_arm_that_creeps_and_sleeps_when_it_is_gone") {
  ArmStage stage;
  stage.hold(0, 240);
  REQUIRE(stage.report().regions_asleep == 2);
  for (double way_m = 0; way_m > kPressed_m; way_m -= 1e-4) {
    stage.step_to(way_m);
    REQUIRE(stage.deepest_m(way_m) < kRounding_m);
  }
  CHECK(stage.report().vertices_touched > 5);
  stage.hold(kPressed_m, 240);
  CHECK(stage.report().regions_asleep == 1);  // the left half
  CHECK_FALSE(stage.report().dormant);
  stage.hold(0, 600);
  CHECK(stage.report().regions_asleep == 2);
  CHECK(stage.report().dormant);
  stage.swing(0, kPressed_m, 4);
  CHECK(stage.deepest_m(kPressed_m) < kRounding_m);
}

TEST_CASE("an_arm_that_creeps_presses_flesh_tick_by_tick_and_wakes_rods_by_its_whole_way") {
  // Clear of the horns, it comes down on the block's top from 5 cm above it.
  const ArmMatter above{.at_x_m = {0.01}, .height_m = 0.7};
  const scenes::PackBytes packs[] = {scenes::soft_block({.rods = scenes::RodMatter{}, .arms = above}),
                                     scenes::soft_block({.arms = above})};
  ArmStage with(true, {}, packs[0], above), without(true, {}, packs[1], above);
  double up_m = 0;
  const auto step = [&](double by_m) {
    up_m += by_m;
    const scenes::BlockPose block = scenes::bind_pose();
    const scenes::TailedPose tailed = scenes::with_rods(block);
    const scenes::ArmedPose poses[] = {scenes::with_raised_arms(tailed.pose(), above, up_m),
                                       scenes::with_raised_arms(block.pose(), above, up_m)};
    REQUIRE(with.world.set_pose(with.blocks[0], poses[0].pose()).ok());
    REQUIRE(without.world.set_pose(without.blocks[0], poses[1].pose()).ok());
    for (ArmStage* stage : {&with, &without}) stage->world.step(static_cast<float>(kFrame_s));
    std::vector<float> places = with.read();
    places.resize(without.read().size());
    REQUIRE(places == without.read());
  };
  const auto hold = [&] {
    for (int f = 0; f < 600; ++f) step(0);
    REQUIRE(with.report().rods_asleep > 0);
  };
  for (int f = 0; f < 12; ++f) step(-0.08 / 12);
  hold();
  REQUIRE(with.report().vertices_touched > 5);
  // A quarter of what counts as still, and a bit less.
  constexpr double kCreep_m = 0.24e-3 * scenes::kArmRadius_m;
  for (int tick = 1; tick <= 4; ++tick) step(-kCreep_m);
  CHECK(with.report().rods_asleep > 0);
  CHECK(with.report().vertices_touched > 5);
  step(-kCreep_m);
  CHECK(with.report().rods_asleep == 0);
  hold();
}

TEST_CASE("a_snapshot_against_an_arm_goes_on_with_the_same_bits") {
  ArmStage stage;
  stage.swing(0, kPressed_m, 20);
  const std::vector<std::byte> saved = stage.save();
  std::vector<std::vector<float>> seen[2];
  for (auto& pass : seen) {
    REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
    pass.push_back(stage.read());
    for (int f = 0; f < 90; ++f) {  // with frames that have no tick
      stage.step_to(kPressed_m + 0.02 * std::sin(0.2 * f), scenes::walk(f / 144.0), 1.0 / 144);
      pass.push_back(stage.read());
    }
  }
  CHECK(seen[0] == seen[1]);
  ArmStage other(false);
  CHECK(other.world.restore_state(other.blocks[0], saved).code == StatusCode::kCorrupt);
}

TEST_CASE("a_teleport_takes_arm_and_pressed_flesh_along") {
  ArmStage stage;
  stage.swing(0, kPressed_m, 12);
  stage.hold(kPressed_m, 120);
  const std::vector<float> before = stage.read();
  scenes::BlockPose away = scenes::bent_pose(0, 300, 2);
  away.root.position_m[2] = -1e5;
  for (int f = 0; f < 30; ++f) {
    stage.step_to(kPressed_m, away);
    CHECK(test::largest_distance(stage.read(), before) < 1e-4);
    CHECK(stage.deepest_m(kPressed_m) < kRounding_m);
  }
}

TEST_CASE("own_bodies_are_touched_with_the_same_bits_on_any_number_of_workers") {
  uint64_t seen[2];
  for (int workers = 0; workers < 2; ++workers) {
    scenes::ThreadPool pool(4);
    WorldDef def;
    if (workers) def.tasks = pool.hook();
    ArmStage stage(true, def);
    for (int i = 0; i < 4; ++i) stage.add_with({.own_body = true});
    stage.swing(0, kPressed_m, 30);
    REQUIRE(stage.report().vertices_touched > 0);
    seen[workers] = test::hash_of(stage);
  }
  CHECK(seen[0] == seen[1]);
}

TEST_CASE("the_own_body_is_touched_on_coarser_control_graphs_too") {
  const scenes::PackBytes pack =
      scenes::soft_block({.nodes = 40, .coarser_nodes = {20, 10}, .arms = ArmMatter{}});
  ArmStage stage(true, {.budget_mode = BudgetMode::kWorkUnits}, pack);
  stage.swing(0, kPressed_m, 12);
  REQUIRE(stage.world.set_budget_us(15).ok());
  stage.hold(kPressed_m, 60);
  REQUIRE(stage.report().graph_level > 0);
  CHECK(stage.report().vertices_touched > 5);
  CHECK(stage.deepest_m(kPressed_m) < kRounding_m);
}

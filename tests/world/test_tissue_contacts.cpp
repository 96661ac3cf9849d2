// test_tissue_contacts.cpp  Soft blocks against walls: held off, at rest there, free again.
#include <algorithm>
#include <numeric>

#include "tests/scenes/half_spaces.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"
#include "tests/world/told_block.hpp"
#include "tissue/modes/guard.hpp"

using namespace sinew;
using scenes::HalfSpaces;
using scenes::Wall;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr double kHalfWidth_m = 0.15;
// Places are floats of some tenths of a metre, pushed by a few roundings.
constexpr double kRounding_m = 1e-6;

scenes::BlockPose stands(double) { return scenes::bind_pose(); }

// A wall at the block's right side, some way in.
Wall right_wall(double depth_m) { return {{kHalfWidth_m - depth_m, 0, 0}, {-1, 0, 0}}; }
Wall left_wall(double depth_m) { return {{depth_m - kHalfWidth_m, 0, 0}, {1, 0, 0}}; }

struct Touching : Stage {
  explicit Touching(ContactSource* source, const WorldDef& def = {},
                    const scenes::PackBytes& pack = test::block_pack())
      : Stage(0, def, pack) {
    add_with(source);
  }
  void add_with(ContactSource* source) {
    InstanceId made;
    REQUIRE(world.create_instance({.asset = asset, .contacts = {.source = source}}, &made).ok());
    blocks.push_back(made);
  }
};

// Soft vertices are those that move when the block is shaken.
std::vector<uint32_t> soft_vertices() {
  pack::PackView view;
  REQUIRE(pack::open_pack(test::block_pack().bytes(), &view).ok());
  std::vector<uint32_t> soft;
  for (const pack::RegionRecord& region : view.regions) {
    for (uint32_t v = 0; v < region.vertex_count; ++v) {
      float sum = 0;
      for (uint32_t n = 0; n < region.node_count; ++n)
        sum += view.carry[region.carry + size_t{n} * region.padded_vertices + v];
      if (sum > 0.05f) soft.push_back(view.region_vertices[region.first_vertex + v]);
    }
  }
  return soft;
}

// How deep the deepest soft vertex lies behind any of the walls.
double deepest(const Stage& stage, const std::vector<Wall>& walls) {
  const std::vector<float> places = stage.read(0, Space::kWorld);
  double most = 0;
  for (const uint32_t v : soft_vertices()) {
    for (const Wall& wall : walls) {
      double height = 0;
      for (size_t k = 0; k < 3; ++k)
        height +=
            static_cast<double>(wall.normal[k]) * (static_cast<double>(places[3 * v + k]) - wall.point_m[k]);
      most = std::max(most, -height);
    }
  }
  return most;
}

}  // namespace

TEST_CASE("answers_that_are_none_are_left_out_and_counted") {
  scenes::Nonsense source;
  Touching stage(&source);
  Stage alone;
  for (int f = 0; f < 30; ++f) {
    stage.step(scenes::walk, kFrame_s);
    alone.step(scenes::walk, kFrame_s);
  }
  CHECK(stage.report().contacts_refused > 0);
  CHECK(stage.read() == alone.read());
}

TEST_CASE("what_is_far_away_changes_no_bit") {
  HalfSpaces far;
  far.walls = {{{0, -5, 0}, {0, 1, 0}}};
  Touching stage(&far);
  Stage alone;
  for (int f = 0; f < 60; ++f) {
    stage.step(scenes::walk, kFrame_s);
    alone.step(scenes::walk, kFrame_s);
    REQUIRE(stage.read() == alone.read());
  }
}

TEST_CASE("a_wall_in_the_flesh_holds_it_off_on_every_simulated_tier") {
  for (const Tier tier : {Tier::kNetwork, Tier::kModal}) {
    HalfSpaces wall;
    wall.walls = {right_wall(0.02)};
    Touching stage(&wall, {.budget_mode = BudgetMode::kWorkUnits});
    REQUIRE(
        stage.world.set_budget_us(tier == Tier::kNetwork ? INFINITY : 1.01f * test::tier_cost_us(tier)).ok());
    stage.play(stands, 1);
    REQUIRE(stage.report().tier == tier);
    CHECK(deepest(stage, wall.walls) < kRounding_m);
    CHECK(stage.report().vertices_touched > 10);
    CHECK(stage.report().deepest_penetration_m < static_cast<float>(kRounding_m));
    CHECK(stage.report().displacement_clamps == 0);
  }
}

TEST_CASE("what_a_wall_pushes_the_network_remembers") {
  HalfSpaces wall;
  wall.walls = {right_wall(0.02)};
  const scenes::PackBytes wide = scenes::soft_block({.displacement_limit = 4});  // it is shown whole
  test::ToldBlock touching(wide, {.source = &wall}), free(wide);
  const size_t nodes = touching.asset().node_count();
  std::vector<float> remembered(3 * nodes);
  for (int t = 0; t < 30; ++t) {
    touching.tick(stands, {.tier = Tier::kNetwork});
    free.tick(stands, {.tier = Tier::kNetwork});
    world::Instance& block = touching.instance();
    tissue::read_output(block.asset->network, block.level->pack.regions, static_cast<uint32_t>(nodes),
                        block.tissue.network_memory, remembered.data());
    const std::vector<float> pressed(block.tissue.l[0], block.tissue.l[0] + remembered.size());
    REQUIRE(test::largest_distance(
                pressed, {free.instance().tissue.l[0], free.instance().tissue.l[0] + pressed.size()}) > 0.01);
    REQUIRE(test::largest_distance(pressed, remembered) < kRounding_m);
  }
}

TEST_CASE("flesh_at_rest_on_a_wall_stands_still_and_does_not_sleep") {
  HalfSpaces wall;
  wall.walls = {right_wall(0.02)};
  Touching stage(&wall);
  stage.play(stands, 3);
  CHECK(stage.report().regions_asleep < 2);
  const std::vector<float> before = stage.read();
  double most = 0;
  for (int f = 0; f < 120; ++f) {
    stage.step(stands, kFrame_s);
    most = std::max(most, test::largest_distance(stage.read(), before));
  }
  // A thousandth of a millimetre; places round to a thirtieth of that.
  CHECK(most < 1e-6);
}

TEST_CASE("a_wall_that_leaves_lets_the_flesh_swing_back_no_further_than_it_was_pushed") {
  HalfSpaces wall;
  wall.walls = {right_wall(0.02)};
  Touching stage(&wall);
  stage.play(stands, 2);
  const std::vector<float> pressed = stage.read();
  wall.walls.clear();
  Stage alone;
  alone.play(stands, 1.0 / 60);
  const std::vector<float> rest = alone.read();
  const double pushed = test::largest_distance(pressed, rest);
  double most = 0;
  for (int f = 0; f < 60; ++f) {
    stage.step(stands, kFrame_s);
    const double now = test::largest_distance(stage.read(), rest);
    most = std::max(most, now);
    // It was the flesh that was pushed, not its picture: a tick later it is not yet back.
    if (f == 0) CHECK(now > 0.5 * pushed);
  }
  CHECK(most < pushed);
  stage.play(stands, 6);
  CHECK(test::largest_distance(stage.read(), rest) < 1e-4);
}

TEST_CASE("between_two_walls_the_flesh_is_held_by_both_and_its_lost_volume_is_told") {
  HalfSpaces walls;
  walls.walls = {right_wall(0.02), left_wall(0.02)};
  Touching stage(&walls);
  stage.play(stands, 1);
  CHECK(deepest(stage, walls.walls) < kRounding_m);
  // Two slabs of 2 cm x 0.3 m (soft: the upper part) x 0.3 m, at most.
  CHECK(stage.report().contact_volume_m3 > 2e-4f);
  CHECK(stage.report().contact_volume_m3 < 2 * 0.02f * 0.3f * 0.6f);
}

TEST_CASE("a_wall_through_the_middle_is_held_off_within_bounds_and_what_is_left_is_told") {
  HalfSpaces wall;
  wall.walls = {right_wall(0.3)};
  Touching stage(&wall);
  stage.play(stands, 2);
  CHECK(test::all_finite(stage.read()));
  CHECK(stage.report().restarts == 0);
  CHECK(stage.report().fallbacks == 0);
  CHECK(test::largest_distance(stage.read(), Stage().read()) < 0.5);
  const double left_m = deepest(stage, wall.walls);
  CHECK(left_m > 0.01);
  CHECK(static_cast<double>(stage.report().deepest_penetration_m) == Approx(left_m).epsilon(0.01));
}

TEST_CASE("a_wall_that_comes_at_ten_metres_a_second_pushes_no_faster_than_itself") {
  HalfSpaces wall;
  Touching stage(&wall);
  constexpr double kEnd_m = kHalfWidth_m - 0.03;
  Wall coming = right_wall(-0.5);
  for (int f = 0; f < 12; ++f) {
    const double before_m = coming.point_m[0];
    coming.point_m[0] = std::max(kEnd_m, before_m - 10 * kFrame_s);
    coming.velocity_m_s[0] = static_cast<float>((coming.point_m[0] - before_m) / kFrame_s);
    wall.walls = {coming};
    stage.step(stands, kFrame_s);
    CHECK(deepest(stage, wall.walls) < kRounding_m);
  }
  stage.play(stands, 3);
  CHECK(deepest(stage, wall.walls) < kRounding_m);
  CHECK(stage.report().restarts == 0);
}

TEST_CASE("a_snapshot_in_contact_goes_on_with_the_same_bits") {
  HalfSpaces wall;
  wall.walls = {right_wall(0.04)};
  Touching stage(&wall);
  stage.play(scenes::walk, 0.3);
  const std::vector<std::byte> saved = stage.save();
  const double then_s = stage.time_s;
  std::vector<std::vector<float>> seen[2];
  for (auto& pass : seen) {
    REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
    stage.time_s = then_s;
    pass.push_back(stage.read());
    for (int f = 0; f < 90; ++f) {
      stage.step(scenes::walk, 1.0 / 144);  // with frames that have no tick
      pass.push_back(stage.read());
    }
  }
  CHECK(seen[0] == seen[1]);
}

TEST_CASE("a_snapshot_without_contacts_is_refused_by_an_instance_with_them") {
  HalfSpaces wall;
  Touching stage(&wall);
  Stage alone;
  CHECK(stage.world.restore_state(stage.blocks[0], alone.save()).code == StatusCode::kCorrupt);
}

TEST_CASE("what_was_touched_is_forgotten_where_nothing_is_simulated_and_after_a_reset") {
  HalfSpaces wall;
  wall.walls = {right_wall(0.02)};
  Touching stage(&wall, {.budget_mode = BudgetMode::kWorkUnits});
  stage.play(stands, 0.5);
  REQUIRE(stage.report().vertices_touched > 0);
  REQUIRE(stage.world.reset(stage.blocks[0]).ok());
  CHECK(stage.report().vertices_touched == 0);
  stage.play(stands, 0.5);
  REQUIRE(stage.report().vertices_touched > 0);
  REQUIRE(stage.world.set_budget_us(0).ok());
  stage.play(stands, 0.1);
  CHECK(stage.report().vertices_touched == 0);
  CHECK(stage.report().contact_volume_m3 == 0);
}

TEST_CASE("contacts_have_the_same_bits_on_any_number_of_workers") {
  uint64_t seen[2];
  for (int workers = 0; workers < 2; ++workers) {
    HalfSpaces wall;
    wall.walls = {right_wall(0.03)};
    scenes::ThreadPool pool(4);
    WorldDef def;
    if (workers) def.tasks = pool.hook();
    Touching stage(&wall, def);
    for (int i = 0; i < 4; ++i) stage.add_with(&wall);
    stage.play(scenes::walk, 0.5);
    seen[workers] = test::hash_of(stage);
  }
  CHECK(seen[0] == seen[1]);
}

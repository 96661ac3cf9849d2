// test_replace_asset.cpp  The same character baked anew takes over in motion.
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

AssetId load(Stage& stage, const scenes::PackBytes& pack) {
  AssetId asset;
  const Status status = stage.world.load_asset(pack.bytes(), &asset);
  INFO(status.message);
  REQUIRE(status.ok());
  return asset;
}

const scenes::PackBytes& softer_pack() {
  static const scenes::PackBytes pack = scenes::soft_block({.network = false, .frequency_share = 0.7});
  return pack;
}

// The largest way of a vertex in a frame, along so many frames.
double largest_step_m(Stage& stage, int frames) {
  double most_m = 0;
  std::vector<float> before = stage.read(0, Space::kBind);
  for (int f = 0; f < frames; ++f) {
    stage.step(scenes::walk, kFrame_s);
    const std::vector<float> now = stage.read(0, Space::kBind);
    most_m = std::max(most_m, test::largest_distance(before, now));
    before = now;
  }
  return most_m;
}

}  // namespace

TEST_CASE("another_skeleton_and_assets_that_are_gone_are_refused") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<float> before = stage.read();
  const AssetId tailed = load(stage, test::tailed_pack());
  const Status status = stage.world.replace_asset(stage.asset, tailed);
  CHECK(status.code == StatusCode::kInvalidArgument);
  CHECK_THAT(status.message, Catch::Contains("joints"));
  CHECK(stage.world.replace_asset(stage.asset, {}).code == StatusCode::kStaleId);
  CHECK(stage.world.replace_asset({}, tailed).code == StatusCode::kStaleId);
  CHECK(stage.world.replace_asset(stage.asset, stage.asset).ok());
  CHECK(stage.read() == before);
  CHECK(stage.world.unload_asset(stage.asset).code == StatusCode::kInvalidArgument);
}

TEST_CASE("instances_go_on_where_they_are_and_the_old_asset_may_be_unloaded") {
  for (const scenes::PackBytes* by : {&test::weightless_pack(), &softer_pack()}) {
    Stage stage(2, {}, test::weightless_pack());
    stage.play(scenes::walk, 1);
    const double ordinary_m = largest_step_m(stage, 30);
    const std::vector<float> before = stage.read(0, Space::kBind);
    REQUIRE(test::largest_length(before) > 0.005);
    REQUIRE(stage.world.replace_asset(stage.asset, load(stage, *by)).ok());
    CHECK(test::largest_distance(before, stage.read(0, Space::kBind)) < 1e-6);
    CHECK(stage.world.unload_asset(stage.asset).ok());
    CHECK(largest_step_m(stage, 30) < 1.5 * ordinary_m);
    CHECK(stage.report().tier == Tier::kModal);
    CHECK(stage.report(1).tier == Tier::kModal);
  }
}

// A second later nothing is left of the change.
TEST_CASE("who_was_replaced_moves_as_one_that_was_always_so") {
  Stage replaced(1, {}, test::weightless_pack()), always(1, {}, softer_pack());
  replaced.play(scenes::walk, 1);
  always.play(scenes::walk, 1);
  REQUIRE(replaced.world.replace_asset(replaced.asset, load(replaced, softer_pack())).ok());
  double off_m = 0, swing_m = 0;
  for (int f = 0; f < 240; ++f) {
    replaced.step(scenes::walk, kFrame_s);
    always.step(scenes::walk, kFrame_s);
    if (f < 180) continue;
    const std::vector<float> mine = replaced.read(0, Space::kBind), theirs = always.read(0, Space::kBind);
    off_m = std::max(off_m, test::largest_distance(mine, theirs));
    swing_m = std::max(swing_m, test::largest_length(theirs));
  }
  CHECK(off_m < 0.05 * swing_m);
}

TEST_CASE("other_graphs_take_over_what_is_shown_and_what_was_set_stays") {
  Stage stage(1, {}, test::levels_pack());
  REQUIRE(stage.world.set_time_scale(stage.blocks[0], 0.5f).ok());
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 0, {.stiffness = 2}).ok());
  stage.play(scenes::walk, 2);
  const std::vector<float> before = stage.read(0, Space::kBind);
  REQUIRE(stage.world.replace_asset(stage.asset, load(stage, test::block_pack())).ok());
  // Of nodes elsewhere the nearest one's.
  CHECK(test::largest_distance(before, stage.read(0, Space::kBind)) < 0.35 * test::largest_length(before));
  PartParameters kept;
  REQUIRE(stage.world.region_parameters(stage.blocks[0], 0, &kept).ok());
  CHECK(kept.stiffness == 2);
  stage.play(scenes::walk, 1);
  CHECK(test::all_finite(stage.read()));
}

TEST_CASE("rods_go_on_where_they_hang") {
  Stage stage(1, {}, test::tailed_pack());
  const auto tail = [](double t_s) { return scenes::with_rods(scenes::walk(t_s)); };
  for (int f = 1; f <= 90; ++f) {
    REQUIRE(stage.world.set_pose(stage.blocks[0], tail(f * kFrame_s).pose()).ok());
    stage.world.step(1.0f / 60);
  }
  const std::vector<float> before = test::joints_of(stage);
  REQUIRE(stage.world.replace_asset(stage.asset, load(stage, test::tailed_pack())).ok());
  const std::vector<float> after = test::joints_of(stage);
  double worst = 0;
  for (size_t i = 0; i < before.size(); ++i)
    worst = std::max(worst, static_cast<double>(std::abs(before[i] - after[i])));
  CHECK(worst < 1e-5);
}

// Gravity upside down: what is replaced hangs as what was always so.
TEST_CASE("the_world_s_environment_is_felt_on") {
  Stage replaced(1, {}, test::weightless_pack()), always(1, {}, test::weightless_pack());
  for (Stage* stage : {&replaced, &always}) {
    REQUIRE(stage->world.set_environment({.gravity_m_s2 = {0, 9.8f, 0}}).ok());
    stage->play([](double) { return scenes::bind_pose(); }, 2);
  }
  REQUIRE(replaced.world.replace_asset(replaced.asset, load(replaced, softer_pack())).ok());
  REQUIRE(replaced.world.replace_asset(replaced.asset, replaced.asset).ok());
  replaced.play([](double) { return scenes::bind_pose(); }, 4);
  const double hangs_m = test::largest_length(always.read(0, Space::kBind));
  REQUIRE(hangs_m > 0.005);
  CHECK(test::largest_length(replaced.read(0, Space::kBind)) > hangs_m);  // softer
}

TEST_CASE("who_is_hidden_meanwhile_comes_back_as_after_all_of_that_time") {
  Stage stage(1, {}, test::weightless_pack());
  stage.play(scenes::walk, 1);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
  stage.play(scenes::walk, 2);
  REQUIRE(stage.world.replace_asset(stage.asset, load(stage, softer_pack())).ok());
  REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
  stage.step(scenes::walk, kFrame_s);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) < 0.002);  // its tail has faded long ago
}

TEST_CASE("a_state_that_was_saved_before_is_refused_after") {
  Stage stage(1, {}, test::weightless_pack());
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> state = stage.save();
  REQUIRE(stage.world.replace_asset(stage.asset, load(stage, softer_pack())).ok());
  CHECK(stage.world.restore_state(stage.blocks[0], state).code == StatusCode::kCorrupt);
}

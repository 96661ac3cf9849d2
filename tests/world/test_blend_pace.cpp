// test_blend_pace.cpp  A blend lasts as long as it takes to move nothing far.
#include "character/transition/blend_pace.hpp"

#include <algorithm>
#include <cmath>

#include "character/life/snapshot.hpp"
#include "tests/world/told_block.hpp"

using namespace sinew;

namespace {

struct Block : test::ToldBlock {
  Block() : ToldBlock(test::levels_pack()) {}
  float blend_ticks() { return instance().state->blend_ticks; }
};

// Bent as far as it goes, then it shakes: much is off, and nothing of it is seen yet.
scenes::BlockPose shaken(double time_s) { return scenes::bent_pose(0.3 + 0.5 * std::sin(21 * time_s)); }

}  // namespace

TEST_CASE("a_blend_that_would_move_something_far_takes_longer_and_ends_within_the_stated_ticks") {
  Block block;
  block.play(shaken, {.tier = Tier::kModal}, 300);
  block.play(shaken, {.tier = Tier::kSkinning}, 60);
  block.tick(shaken, {.tier = Tier::kModal});
  uint32_t ticks = 1;
  float last = block.blend_ticks();
  for (; ticks < 100 && block.blend_ticks() < world::kBlendInTicks; ++ticks) {
    block.tick(shaken, {.tier = Tier::kModal});
    CHECK(block.blend_ticks() > last);
    CHECK(block.blend_ticks() <= last + 1);
    last = block.blend_ticks();
  }
  WARN("blended in over " << ticks << " ticks");
  CHECK(ticks > world::kBlendInTicks);
  CHECK(ticks <= world::kLongestBlendTicks);
}

TEST_CASE("a_blend_that_moves_nothing_far_takes_the_stated_ticks") {
  const auto stands = [](double) { return scenes::bind_pose(); };
  Block block;
  block.play(stands, {.tier = Tier::kModal}, 60);
  block.play(stands, {.tier = Tier::kSkinning}, 60);
  block.play(stands, {.tier = Tier::kModal}, static_cast<int>(world::kBlendInTicks) - 1);
  CHECK(block.blend_ticks() < world::kBlendInTicks);
  block.tick(stands, {.tier = Tier::kModal});
  CHECK(block.blend_ticks() == world::kBlendInTicks);
}

// Each tick's difference, of what the twins show.
double farthest_apart(Block& a, Block& b) {
  const std::vector<float> x = a.surface(), y = b.surface();
  std::vector<float> between(x.size());
  for (size_t i = 0; i < x.size(); ++i) between[i] = x[i] - y[i];
  return test::largest_length(between);
}

TEST_CASE("a_network_without_a_memory_begins_to_correct_gently") {
  const auto apart_after_one = [](bool gently) {
    Block begins, stays;
    for (Block* block : {&begins, &stays}) block->play(shaken, {.tier = Tier::kModal}, 120);
    begins.tick(shaken, {.tier = Tier::kNetwork});
    stays.tick(shaken, {.tier = Tier::kModal});
    if (!gently) {  // a second one, with all of its corrections
      begins.instance().state->tissue.network_begins = 0;
      begins.tick(shaken, {.tier = Tier::kNetwork});
      stays.tick(shaken, {.tier = Tier::kModal});
    }
    return farthest_apart(begins, stays);
  };
  const double gentle = apart_after_one(true), whole = apart_after_one(false);
  INFO(gentle << " m after a first tick, " << whole << " m with a whole one behind it");
  REQUIRE(whole > 0);
  CHECK(gentle < whole / 4);
}

// Beside a twin whose modes stand, so that all else they hear is the same.
TEST_CASE("modes_that_take_over_from_a_network_go_on_a_twentieth_slower") {
  const auto sways = [](double time_s) { return scenes::bent_pose(0.1 * std::sin(9 * time_s)); };
  Block moves, stands;
  for (Block* block : {&moves, &stands}) block->play(sways, {.tier = Tier::kNetwork}, 120);
  const std::span<const pack::ModeRecord> modes = moves.instance().level->pack.modes;
  const world::Instance &a = moves.instance(), &b = stands.instance();
  std::vector<double> before;
  for (size_t m = 0; m < modes.size(); ++m) {
    before.push_back(double{modes[m].a2} * (double{a.tissue.q[1][m]} - double{a.tissue.q[0][m]}));
    b.tissue.q[1][m] = b.tissue.q[0][m];
  }
  for (Block* block : {&moves, &stands}) block->tick(sways, {.tier = Tier::kModal});
  double most = 0, kept = 0;
  for (size_t m = 0; m < modes.size(); ++m) {
    if (std::fabs(before[m]) <= most) continue;
    most = std::fabs(before[m]);
    kept = (double{a.tissue.q[0][m]} - double{b.tissue.q[0][m]}) / before[m];
  }
  REQUIRE(most > 0);
  INFO(kept << " of the way of a mode in a tick");
  CHECK(std::fabs(kept - 0.95) < 0.002);  // floats that cancel
}

// Missed a tick or two, and comes back as modes: what the network moved in its ticks would swing on in them.
TEST_CASE("modes_that_make_up_for_a_network_take_back_most_of_what_it_corrected") {
  const auto sways = [](double time_s) { return scenes::bent_pose(0.1 * std::sin(9 * time_s)); };
  const auto apart = [&](bool taken_back) {
    Block block, modes;
    block.play(sways, {.tier = Tier::kModal}, 120);
    modes.play(sways, {.tier = Tier::kModal}, 120);
    block.play(sways, {.tier = Tier::kNetwork}, 30);
    modes.play(sways, {.tier = Tier::kModal}, 30);
    block.play(sways, {.tier = Tier::kExtrapolate}, 2);
    modes.play(sways, {.tier = Tier::kModal}, 2);
    if (!taken_back)
      for (float* corrected : block.instance().tissue.corrected)
        std::fill_n(corrected, block.asset().mode_count(), 0.0f);
    block.tick(sways, {.tier = Tier::kModal});
    modes.tick(sways, {.tier = Tier::kModal});
    double most = 0;
    const world::Instance &a = block.instance(), &b = modes.instance();
    for (uint32_t m = 0; m < block.asset().mode_count(); ++m)
      most = std::max(most, std::fabs(double{a.tissue.q[0][m]} - double{b.tissue.q[0][m]}));
    return most;
  };
  const double with = apart(true), without = apart(false);
  INFO(with << " off, without it " << without);
  REQUIRE(without > 0);
  CHECK(with < 0.6 * without);
}

TEST_CASE("what_is_left_alone_fades_for_longer_the_further_it_hangs") {
  const auto faded_after = [](const auto& motion) {
    Block block;
    block.play(motion, {.tier = Tier::kModal}, 120);
    uint32_t ticks = 0;
    do block.tick(motion, {.tier = Tier::kExtrapolate});
    while (++ticks < 60 && test::largest_length(block.surface()) > 0);
    return ticks - world::kCarryTicks;
  };
  const auto strolls = [](double time_s) { return scenes::walk(0.2 * time_s); };
  CHECK(faded_after(strolls) == world::kFadeTicks);
  CHECK(faded_after(scenes::walk) > world::kFadeTicks);
  CHECK(faded_after(shaken) == world::kLongestFadeTicks);
}

// What began elsewhere than it would have been swings on: its last ticks go half as fast. So does what missed
// too little to begin at rest, and cannot be caught up with: other than it was, on a finer level.
TEST_CASE("a_blend_from_what_was_shown_ends_slowly_where_something_moves") {
  Block block;
  block.play(shaken, {.tier = Tier::kNetwork, .level = 1}, 120);
  block.play(shaken, {.tier = Tier::kExtrapolate}, 2);
  uint32_t ticks = 0;
  do block.tick(shaken, {.tier = Tier::kModal});
  while (++ticks < 100 && block.blend_ticks() < world::kBlendInTicks);
  CHECK(ticks > world::kBlendInTicks + 4);
  CHECK(ticks < 2 * world::kBlendInTicks);
}

TEST_CASE("a_blend_to_modes_that_begin_at_rest_takes_longer_where_something_moves") {
  const auto blended_after = [](const auto& pose) {
    Block block;
    block.play(pose, {.tier = Tier::kModal}, 120);
    block.play(pose, {.tier = Tier::kSkinning}, 60);
    uint32_t ticks = 0;
    do block.tick(pose, {.tier = Tier::kModal});
    while (++ticks < 100 && block.blend_ticks() < world::kBlendInTicks);
    return ticks;
  };
  const auto stands = [](double) { return scenes::bind_pose(); };
  CHECK(blended_after(stands) == world::kBlendInTicks);
  CHECK(blended_after(shaken) > 2 * world::kBlendInTicks);
  CHECK(blended_after(shaken) <= world::kLongestBlendTicks);
}

TEST_CASE("a_blend_saved_between_its_ticks_goes_on_with_the_same_bits") {
  Block block;
  block.play(shaken, {.tier = Tier::kModal}, 300);
  block.play(shaken, {.tier = Tier::kSkinning}, 60);
  block.play(shaken, {.tier = Tier::kModal}, 16);
  REQUIRE(block.blend_ticks() != std::floor(block.blend_ticks()));
  std::vector<std::byte> saved(world::snapshot_bytes(block.instance()));
  REQUIRE(world::save(block.instance(), saved).ok());
  const auto on = [&] {
    std::vector<float> seen;
    for (int t = 0; t < 60; ++t) {
      block.tick([&](double) { return shaken(0.1 * t); }, {.tier = Tier::kModal});
      const std::vector<float> now = block.surface();
      seen.insert(seen.end(), now.begin(), now.end());
    }
    return seen;
  };
  const std::vector<float> once = on();
  REQUIRE(world::restore(block.instance(), saved).ok());
  CHECK(on() == once);
}

// Frames of a 144 Hz screen have a tick or none.
TEST_CASE("a_blend_goes_on_by_ticks_however_short_frames_are") {
  const auto blend_after = [](double frame_s) {
    test::Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits}, test::levels_pack());
    stage.play(shaken, 3);
    REQUIRE(stage.world.set_budget_us(0).ok());
    stage.play(shaken, 1);
    REQUIRE(stage.world.set_budget_us(INFINITY).ok());
    std::vector<float> blends;
    for (double t = 0; t < 1.2; t += frame_s) {
      stage.step(shaken, frame_s);
      const float blend = stage.report().blend;
      if (blends.empty() || blend != blends.back()) blends.push_back(blend);
    }
    CHECK(std::is_sorted(blends.begin(), blends.end()));
    return blends;
  };
  const std::vector<float> usual = blend_after(1.0 / 60), quick = blend_after(1.0 / 144);
  CHECK(usual.back() == 1);
  CHECK(quick.back() == 1);
  CHECK(quick.size() <= world::kLongestBlendTicks + 1);
}

// test_catch_up.cpp  A tick or two without simulation: made up for, and faded.
#include <limits>
#include <utility>

#include "character/instance.hpp"
#include "tests/scenes/half_spaces.hpp"
#include "tests/world/told_block.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kNothing_us = 1e-6f;  // above zero, below any network's cost: denied, not skinned
// Of half a metre in floats, through poses that are put together anew.
constexpr double kRounding_m = 1e-5;

float budget_of(Tier tier) {
  return tier == Tier::kNetwork ? std::numeric_limits<float>::infinity() : test::tier_cost_us(tier) * 1.01f;
}

struct Pair {
  Stage interrupted{1, {.budget_mode = BudgetMode::kWorkUnits}},
      steady{1, {.budget_mode = BudgetMode::kWorkUnits}};
  Tier tier;

  explicit Pair(Tier of) : tier(of) {
    for (Stage* stage : {&interrupted, &steady}) {
      REQUIRE(stage->world.set_budget_us(budget_of(tier)).ok());
      stage->play(scenes::walk, 1.5);
    }
  }
  void frame(const test::Motion& motion = scenes::walk, double dt_s = kFrame_s) {
    interrupted.step(motion, dt_s);
    steady.step(motion, dt_s);
  }
  void miss(int frames, double dt_s = kFrame_s) {
    REQUIRE(interrupted.world.set_budget_us(kNothing_us).ok());
    for (int f = 0; f < frames; ++f) frame(scenes::walk, dt_s);
    REQUIRE(interrupted.report().tier == Tier::kExtrapolate);
    REQUIRE(interrupted.world.set_budget_us(budget_of(tier)).ok());
  }
  double apart_m() const { return test::largest_distance(interrupted.read(), steady.read()); }
};

constexpr Tier kSimulated[] = {Tier::kModal, Tier::kNetwork};

}  // namespace

TEST_CASE("what_missed_a_tick_or_two_comes_to_where_it_would_have_been") {
  for (const Tier tier : kSimulated) {
    for (const int missed : {1, 2}) {
      Pair pair(tier);
      pair.miss(missed);
      REQUIRE(pair.apart_m() > 20 * kRounding_m);
      for (uint32_t f = 0; f < world::kBlendInTicks; ++f) pair.frame();
      INFO("tier " << static_cast<int>(tier) << ", missed " << missed);
      CHECK(pair.interrupted.report().tier == tier);
      CHECK(pair.apart_m() < kRounding_m);
    }
  }
}

TEST_CASE("what_missed_more_begins_anew") {
  Pair pair(Tier::kNetwork);
  pair.miss(world::kCaughtUpTicks + 1);
  for (uint32_t f = 0; f < world::kBlendInTicks; ++f) pair.frame();
  CHECK(pair.apart_m() > 100 * kRounding_m);
}

// The way back from what was carried on is faded: in no frame more than a tenth of what a frame moves anyway.
TEST_CASE("coming_back_from_a_missed_tick_moves_nothing_by_itself") {
  constexpr double kBeside = 0.1;
  for (const Tier tier : kSimulated) {
    Pair pair(tier);
    double usual_m = 0, beside_m = 0;
    const auto bind = [](const Stage& stage) { return stage.read(0, Space::kBind); };
    for (int round = 0; round < 20; ++round) {
      pair.miss(1);
      for (int f = 0; f < 7; ++f) {
        const std::vector<float> was = bind(pair.interrupted), steady_was = bind(pair.steady);
        pair.frame();
        const std::vector<float> now = bind(pair.interrupted), steady_now = bind(pair.steady);
        usual_m = std::max(usual_m, test::largest_distance(steady_now, steady_was));
        std::vector<float> beside(now.size());
        for (size_t i = 0; i < now.size(); ++i) beside[i] = now[i] - was[i] - (steady_now[i] - steady_was[i]);
        beside_m = std::max(beside_m, test::largest_length(beside));
      }
    }
    WARN("tier " << static_cast<int>(tier) << ": in a frame " << usual_m * 1e3 << " mm, beside them "
                 << beside_m * 1e3);
    CHECK(beside_m < kBeside * usual_m);
  }
}

TEST_CASE("a_missed_frame_of_two_ticks_is_made_up_for") {
  Pair pair(Tier::kNetwork);
  for (int f = 0; f < 10; ++f) pair.frame(scenes::walk, 2 * kFrame_s);
  pair.miss(1, 2 * kFrame_s);
  for (uint32_t f = 0; f < world::kBlendInTicks; ++f) pair.frame(scenes::walk, 2 * kFrame_s);
  CHECK(pair.apart_m() < 5 * kRounding_m);  // the way between two poses goes by the three that are known
}

TEST_CASE("a_teleport_between_a_missed_tick_and_its_making_up_is_not_felt") {
  Pair pair(Tier::kNetwork);
  const auto far = [](double t) {
    scenes::BlockPose pose = scenes::walk(t);
    pose.root.position_m[0] += 30;
    return pose;
  };
  pair.miss(1);
  pair.frame(far);
  for (uint32_t f = 0; f < world::kBlendInTicks; ++f) pair.frame(far);
  // Its place is thirty metres off, and its last step is known from fewer poses.
  CHECK(pair.apart_m() < 10 * kRounding_m);
}

TEST_CASE("a_gap_saved_in_its_midst_ends_with_the_same_bits") {
  Pair pair(Tier::kNetwork);
  Stage& stage = pair.interrupted;
  REQUIRE(stage.world.set_budget_us(kNothing_us).ok());
  stage.step(scenes::walk, kFrame_s);
  const std::vector<std::byte> gap = stage.save();
  REQUIRE(stage.world.set_budget_us(budget_of(Tier::kNetwork)).ok());
  const double at_s = stage.time_s;
  stage.play(scenes::walk, 0.1);
  const std::vector<std::byte> riding = stage.save();
  stage.play(scenes::walk, 0.5);
  const std::vector<float> whole = stage.read();
  REQUIRE(stage.world.restore_state(stage.blocks[0], gap).ok());
  stage.time_s = at_s;
  stage.play(scenes::walk, 0.1);
  CHECK(stage.save() == riding);
  stage.play(scenes::walk, 0.5);
  CHECK(stage.read() == whole);
}

TEST_CASE("a_change_of_level_while_a_tail_rides_does_not_jump") {
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits}, test::levels_pack());
  stage.play(scenes::walk, 1.5);
  double usual_m = 0;
  const auto frame = [&] {
    const std::vector<float> was = stage.read(0, Space::kBind);
    stage.step(scenes::walk, kFrame_s);
    return test::largest_distance(was, stage.read(0, Space::kBind));
  };
  for (int f = 0; f < 60; ++f) usual_m = std::max(usual_m, frame());
  double most_m = 0;
  for (int round = 0; round < 10; ++round) {
    for (const float budget_us : {kNothing_us, budget_of(Tier::kNetwork), test::tier_cost_us(Tier::kModal),
                                  budget_of(Tier::kNetwork)}) {
      REQUIRE(stage.world.set_budget_us(budget_us).ok());
      for (int f = 0; f < (budget_us == kNothing_us ? 1 : 3); ++f) most_m = std::max(most_m, frame());
    }
  }
  constexpr double kPop = 2;  // as of tiers (test_blend.cpp)
  CHECK(most_m < kPop * usual_m);
}

TEST_CASE("rods_that_missed_a_tick_come_to_where_they_would_have_been") {
  const scenes::PackBytes pack = scenes::soft_block({.network = false, .rods = scenes::RodMatter{}});
  Stage interrupted(1, {.budget_mode = BudgetMode::kWorkUnits}, pack),
      steady(1, {.budget_mode = BudgetMode::kWorkUnits}, pack);
  const auto joints = [](const Stage& stage) {
    std::vector<Matrix34> out(stage.info.joint_count);
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], out).ok());
    return out;
  };
  const auto apart = [&] {
    const std::vector<Matrix34> a = joints(interrupted), b = joints(steady);
    double most = 0;
    for (size_t j = 0; j < a.size(); ++j)
      for (size_t k = 0; k < 12; ++k)
        most = std::max(most, std::abs(static_cast<double>((&a[j].m[0][0])[k] - (&b[j].m[0][0])[k])));
    return most;
  };
  const auto frame = [&] {
    for (Stage* stage : {&interrupted, &steady}) {
      stage->time_s += kFrame_s;
      const scenes::TailedPose pose = scenes::with_rods(scenes::shake(stage->time_s, 2));
      REQUIRE(stage->world.set_pose(stage->blocks[0], pose.pose()).ok());
      stage->world.step(static_cast<float>(kFrame_s));
    }
  };
  for (int f = 0; f < 60; ++f) frame();
  REQUIRE(apart() == 0);
  REQUIRE(interrupted.world.set_budget_us(kNothing_us).ok());
  frame();
  REQUIRE(apart() > 1e-3);
  const double off = apart();
  REQUIRE(interrupted.world.set_budget_us(std::numeric_limits<float>::infinity()).ok());
  frame();
  CHECK(std::abs(apart() - off) < 0.1 * off);  // what was shown rides on what is simulated
  for (uint32_t f = 1; f < world::kBlendInTicks; ++f) frame();
  CHECK(apart() < 1e-3);  // a solver's tolerance, some steps long
}

namespace {

class Told : public test::ToldBlock {
 public:
  explicit Told(const ContactDef& contacts = {}) : ToldBlock(test::levels_pack(), contacts) {}
  void play(const test::Motion& motion, Tier tier, uint32_t level, int ticks) {
    ToldBlock::play(motion, {.tier = tier, .level = level}, ticks);
  }
};

// In the second after a gap that ends on another level.
double furthest_apart_m(Tier tier, uint32_t from, uint32_t to, uint32_t missed) {
  Told steady, interrupted;
  for (Told* block : {&steady, &interrupted}) block->play(scenes::walk, tier, from, 90);
  steady.play(scenes::walk, tier, from, static_cast<int>(missed));
  interrupted.play(scenes::walk, Tier::kExtrapolate, from, static_cast<int>(missed));
  double most = 0;
  for (int t = 0; t < 60; ++t) {
    for (Told* block : {&steady, &interrupted}) block->play(scenes::walk, tier, to, 1);
    most = std::max(most, test::largest_distance(steady.surface(), interrupted.surface()));
  }
  return most;
}

}  // namespace

// Poses that stand still for three frames and then leap, as an animation at 60 Hz does in a quicker world.
TEST_CASE("frames_shorter_than_a_tick_make_up_for_nothing") {
  constexpr double kQuick_s = kFrame_s / 4;
  const auto held = [](double t) { return scenes::walk(std::floor(60 * t + 1e-6) / 60); };
  Pair pair(Tier::kNetwork);
  for (int f = 0; f < 40; ++f) pair.frame(held, kQuick_s);
  REQUIRE(pair.interrupted.world.set_budget_us(kNothing_us).ok());
  for (int f = 0; f < 4; ++f) pair.frame(held, kQuick_s);
  REQUIRE(pair.interrupted.world.set_budget_us(budget_of(Tier::kNetwork)).ok());
  double most_m = 0;
  for (int f = 0; f < 80; ++f) pair.frame(held, kQuick_s), most_m = std::max(most_m, pair.apart_m());
  CHECK(most_m < test::largest_length(pair.steady.read(0, Space::kBind)) + 0.1);
}

TEST_CASE("a_gap_that_ends_on_another_level_is_no_worse_than_a_longer_one") {
  for (const Tier tier : kSimulated) {
    for (const auto& [from, to] : {std::pair{2u, 0u}, {1u, 0u}, {0u, 2u}}) {
      const double longer_m = furthest_apart_m(tier, from, to, world::kCaughtUpTicks + 1);
      INFO("tier " << static_cast<int>(tier) << ", level " << from << " to " << to);
      for (const uint32_t missed : {1u, 2u}) CHECK(furthest_apart_m(tier, from, to, missed) < 1.1 * longer_m);
    }
  }
}

// Its nodes keep what they had, and the missed ticks are theirs.
TEST_CASE("what_missed_a_tick_or_two_makes_up_for_it_on_a_coarser_level_too") {
  for (const Tier tier : {Tier::kModal, Tier::kNetwork}) {
    for (const int missed : {1, 2}) {
      Told steady, interrupted;
      for (Told* block : {&steady, &interrupted}) block->play(scenes::walk, tier, 0, 90);
      steady.play(scenes::walk, tier, 1, missed);
      interrupted.play(scenes::walk, Tier::kExtrapolate, 0, missed);
      const double off_m = test::largest_distance(steady.surface(), interrupted.surface());
      for (Told* block : {&steady, &interrupted}) block->play(scenes::walk, tier, 1, 60);
      INFO("tier " << static_cast<int>(tier) << ", missed " << missed << ": " << off_m << " m off before");
      CHECK(test::largest_distance(steady.surface(), interrupted.surface()) < 0.02 * off_m);
    }
  }
}

// It is made up for on the level that it was missed on.
TEST_CASE("a_finer_level_waits_for_a_step_in_which_missed_ticks_are_made_up_for") {
  for (const Tier tier : kSimulated) {
    for (const int missed : {1, 2}) {
      Told steady, interrupted;
      for (Told* block : {&steady, &interrupted}) block->play(scenes::walk, tier, 1, 90);
      steady.play(scenes::walk, tier, 1, missed);
      interrupted.play(scenes::walk, Tier::kExtrapolate, 1, missed);
      const double off_m = test::largest_distance(steady.surface(), interrupted.surface());
      interrupted.play(scenes::walk, tier, 0, 1);
      CHECK(interrupted.instance().state->level == 1);
      CHECK(interrupted.instance().state->held_s > 1);  // nor counts as a rise: another may follow
      steady.play(scenes::walk, tier, 1, 1);
      for (Told* block : {&steady, &interrupted}) block->play(scenes::walk, tier, 0, 60);
      CHECK(interrupted.instance().state->level == 0);
      INFO("tier " << static_cast<int>(tier) << ", missed " << missed << ": " << off_m << " m off before");
      CHECK(test::largest_distance(steady.surface(), interrupted.surface()) < 0.02 * off_m);
    }
  }
}

TEST_CASE("a_network_on_a_finer_level_waits_for_what_modes_missed_and_modes_do_not_for_a_network") {
  for (const auto& [left, planned, level] :
       {std::tuple{Tier::kModal, Tier::kNetwork, 1u}, {Tier::kNetwork, Tier::kModal, 0u}}) {
    Told block;
    block.play(scenes::walk, left, 1, 90);
    block.play(scenes::walk, Tier::kExtrapolate, 1, 1);
    block.play(scenes::walk, planned, 0, 1);
    CHECK(block.instance().state->tier == Tier::kModal);
    CHECK(block.instance().state->level == level);
    block.play(scenes::walk, planned, 0, 1);
    CHECK(block.instance().state->tier == planned);
    CHECK(block.instance().state->level == 0);
  }
}

TEST_CASE("a_finer_level_while_simulation_is_blended_in_from_skinning_does_not_jump") {
  Told stays, rises;
  for (Told* block : {&stays, &rises}) {
    block->play(scenes::walk, Tier::kModal, 1, 60);
    block->play(scenes::walk, Tier::kExtrapolate, 1, 40);
    block->play(scenes::walk, Tier::kModal, 1, 3);
  }
  constexpr double kPop_m = 1e-3;
  for (int t = 0; t < 3; ++t) {
    const std::vector<float> was = stays.surface(), risen_was = rises.surface();
    stays.play(scenes::walk, Tier::kModal, 1, 1);
    rises.play(scenes::walk, Tier::kModal, 0, 1);
    const double own_m = test::largest_distance(was, stays.surface());
    CHECK(test::largest_distance(risen_was, rises.surface()) < own_m + kPop_m);
  }
}

TEST_CASE("what_touched_in_missed_ticks_is_not_pushed_nor_told_with_the_present_one") {
  const auto stands = [](double) { return scenes::bind_pose(); };
  for (const int missed : {1, 2}) {
    scenes::HalfSpaces wall;
    wall.walls = {{{0.13, 0, 0}, {-1, 0, 0}}};
    Told block({.source = &wall});
    block.play(stands, Tier::kModal, 0, 60);
    const uint32_t usual = block.instance().told.vertices;
    REQUIRE(usual > 0);
    block.play(stands, Tier::kExtrapolate, 0, missed);
    block.play(stands, Tier::kModal, 0, 1);
    REQUIRE(block.instance().marks.made_up == missed);
    CHECK(block.instance().told.vertices == usual);
  }
}

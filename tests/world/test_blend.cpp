// test_blend.cpp  Losing the network and getting it back: faded, bounded, without a pop.
#include "character/instance.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

// Largest change of any vertex's displacement from one frame to the next, while the budget does as it is
// told.
double largest_change(Stage& stage, int frames, const std::function<float(int frame)>& budget_us) {
  std::vector<float> before = stage.read(0, Space::kBind);
  double largest = 0;
  for (int f = 0; f < frames; ++f) {
    REQUIRE(stage.world.set_budget_us(budget_us(f)).ok());
    stage.step(scenes::walk, kFrame_s);
    std::vector<float> now = stage.read(0, Space::kBind);
    largest = std::max(largest, test::largest_distance(before, now));
    before = std::move(now);
  }
  return largest;
}

constexpr float kAll = std::numeric_limits<float>::infinity();
// Above zero, below any network's cost: denied, not skinned.
constexpr float kNothing_us = 1e-6f;

Stage& settle(Stage& stage) {
  stage.play(scenes::walk, 1.5);
  return stage;
}

}  // namespace

TEST_CASE("denied_instance_is_extrapolated_then_faded_to_skinning") {
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
  settle(stage);
  REQUIRE(stage.world.set_budget_us(kNothing_us).ok());
  std::vector<float> blends;
  for (uint32_t f = 1; f <= 40; ++f) {
    stage.step(scenes::walk, kFrame_s);
    const InstanceReport report = stage.report();
    CHECK(report.ticks_since_network == f);
    CHECK(report.tier == (report.blend > 0 ? Tier::kExtrapolate : Tier::kSkinning));
    blends.push_back(report.blend);
  }
  CHECK(blends[world::kCarryTicks - 1] == 1);
  CHECK(std::ranges::is_sorted(blends, std::greater()));
  const auto shown = static_cast<uint32_t>(std::ranges::find(blends, 0.0f) - blends.begin());
  CHECK(shown + 1 >= world::kCarryTicks + world::kFadeTicks);
  CHECK(shown + 1 <= world::kCarryTicks + world::kLongestFadeTicks);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) == 0);
}

TEST_CASE("returning_instance_is_blended_in_over_the_stated_ticks") {
  const auto strolls = [](double time_s) {
    return scenes::walk(0.2 * time_s);
  };  // quicker: test_blend_pace.cpp
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
  stage.play(strolls, 1.5);
  REQUIRE(stage.world.set_budget_us(kNothing_us).ok());
  stage.play(strolls, 1);
  REQUIRE(stage.world.set_budget_us(kAll).ok());
  for (uint32_t f = 1; f <= world::kBlendInTicks; ++f) {
    stage.step(strolls, kFrame_s);
    CHECK(stage.report().tier == Tier::kNetwork);
    const double t = static_cast<double>(f) / world::kBlendInTicks;
    CHECK(stage.report().blend == Approx(t * t * (3 - 2 * t)));
  }
}

// While it is not simulated nobody follows how it bends; it must come back as it is seen.
TEST_CASE("coming_back_in_another_bend_does_not_turn_what_is_shown") {
  constexpr int kDenied = 10;
  constexpr double kBend_rad = 2, kBefore_s = 2.2;
  const auto largest_change_at = [&](double bend_rad) {
    Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
    double bent = 0;
    const auto motion = [&](double t) {
      scenes::BlockPose pose = scenes::bent_pose(bent + 0.45 * std::sin(19 * std::min(t, kBefore_s)));
      return pose;
    };
    stage.play(motion, kBefore_s);
    REQUIRE(stage.world.set_budget_us(kNothing_us).ok());
    for (int f = 0; f < kDenied; ++f) {
      bent += bend_rad / kDenied;
      stage.step(motion, kFrame_s);
    }
    const std::vector<float> before = stage.read(0, Space::kBind);
    REQUIRE(test::largest_length(before) > 0.01);
    REQUIRE(stage.world.set_budget_us(kAll).ok());
    stage.step(motion, kFrame_s);
    return test::largest_distance(before, stage.read(0, Space::kBind));
  };
  CHECK(largest_change_at(kBend_rad) < 2 * largest_change_at(0) + 1e-3);  // a millimetre
}

// No pop: whatever is taken away or given back, no vertex moves more than twice as far in a frame as it does
// undisturbed. The blend moves it by 1.5 / kBlendInTicks of its displacement a tick; a switch would by all of
// it.
constexpr double kPop = 2;

TEST_CASE("changing_tiers_does_not_pop") {
  Stage steady(1, {.budget_mode = BudgetMode::kWorkUnits}),
      denied(1, {.budget_mode = BudgetMode::kWorkUnits}), skinned(1, {.budget_mode = BudgetMode::kWorkUnits}),
      flickering(1, {.budget_mode = BudgetMode::kWorkUnits});
  const double usual_m = largest_change(settle(steady), 600, [](int) { return kAll; });
  const double denied_m =
      largest_change(settle(denied), 600, [](int f) { return f / 25 % 2 == 0 ? kNothing_us : kAll; });
  const double skinned_m =
      largest_change(settle(skinned), 600, [](int f) { return f / 37 % 2 == 0 ? 0 : kAll; });
  const double flickering_m =
      largest_change(settle(flickering), 600, [](int f) { return f % 2 == 0 ? kNothing_us : kAll; });
  WARN("largest change in a frame: undisturbed "
       << usual_m * 1e3 << " mm, denied and given back " << denied_m * 1e3 << ", skinned and given back "
       << skinned_m * 1e3 << ", every other frame " << flickering_m * 1e3);
  CHECK(denied_m < kPop * usual_m);
  CHECK(skinned_m < kPop * usual_m);
  CHECK(flickering_m < kPop * usual_m);
}

// Modes and network hand displacement and velocity on without a blend.
TEST_CASE("tier_switches_are_continuous") {
  constexpr double kMost_mm =
      6;  // in a frame, beyond what the motion itself does; it displaces by up to 56 mm
  const auto budget = [](Tier tier) {
    return tier == Tier::kNetwork ? kAll : test::tier_cost_us(tier) * 1.01f;
  };
  const auto switched = [&](Tier a, Tier b) {
    Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
    std::vector<Tier> seen;
    const double change_m = largest_change(settle(stage), 600, [&](int f) {
      seen.push_back(stage.report().tier);
      return budget(f / 37 % 2 == 0 ? a : b);
    });
    CHECK(std::ranges::count(seen, a) > 250);
    CHECK(std::ranges::count(seen, b) > 250);
    return change_m * 1e3;
  };
  const auto steady = [&](Tier tier) {
    Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
    return 1e3 * largest_change(settle(stage), 600, [&](int) { return budget(tier); });
  };
  const double network_mm = steady(Tier::kNetwork), modal_mm = steady(Tier::kModal);
  const double network_modal_mm = switched(Tier::kNetwork, Tier::kModal);
  WARN("largest change in a frame: network " << network_mm << " mm, modal " << modal_mm << "; network-modal "
                                             << network_modal_mm);
  CHECK(network_modal_mm < std::max(network_mm, modal_mm) + kMost_mm);
}

TEST_CASE("modes_go_on_where_the_network_left_them") {
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
  settle(stage);
  REQUIRE(stage.world.set_budget_us(test::tier_cost_us(Tier::kModal) * 1.01f).ok());
  for (uint32_t f = 1; f <= 30; ++f) {
    stage.step(scenes::walk, kFrame_s);
    CHECK(stage.report().tier == Tier::kModal);
    CHECK(stage.report().blend == 1);
    CHECK(stage.report().ticks_since_network == f);
  }
}

TEST_CASE("a_character_without_a_network_runs_on_its_modes") {
  Stage stage(2, {}, test::weightless_pack());
  const FrameReport report = stage.step(scenes::walk, kFrame_s);
  CHECK(report.instances_modal == 2);
  CHECK(report.instances_network == 0);
  stage.play(scenes::walk, 2);
  CHECK(stage.report().tier == Tier::kModal);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) > 0.005);
}

TEST_CASE("tissue_comes_back_to_what_it_would_have_been") {
  Stage interrupted(1, {.budget_mode = BudgetMode::kWorkUnits}),
      steady(1, {.budget_mode = BudgetMode::kWorkUnits});
  settle(interrupted);
  settle(steady);
  REQUIRE(interrupted.world.set_budget_us(kNothing_us).ok());
  interrupted.play(scenes::walk, 1);
  steady.play(scenes::walk, 1);
  REQUIRE(interrupted.world.set_budget_us(kAll).ok());
  interrupted.play(scenes::walk, 3);
  steady.play(scenes::walk, 3);
  const double off_m = test::largest_distance(interrupted.read(), steady.read());
  const double size_m = test::largest_length(steady.read(0, Space::kBind));
  WARN("3 s after it came back, " << off_m * 1e3 << " mm off of " << size_m * 1e3 << " mm");
  CHECK(off_m < 0.05 * size_m);  // damped by exp(-0.1 x 2 pi x 3.5 x 3) = 0.0014 of what was missed
}

// What a change alone moves: the same frame with it and without, at each frame of two seconds of a walk.
TEST_CASE("a_change_of_tiers_moves_no_vertex_far") {
  constexpr double kMost = 0.0045;  // of the height, in a frame; a network cut off to be extrapolated: 0.0043
  struct Offer {
    const char* name;
    float budget_us;
  };
  const Offer offers[] = {{"network", kAll},
                          {"modal", test::tier_cost_us(Tier::kModal) * 1.01f},
                          {"extrapolated", kNothing_us},
                          {"skinning", 0}};
  for (const Offer& from : offers) {
    for (const Offer& to : offers) {
      if (&from == &to) continue;
      Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
      REQUIRE(stage.world.set_budget_us(from.budget_us).ok());
      settle(stage);
      double largest_m = 0;
      const auto look = [&](float budget_us, const std::vector<std::byte>& state) {
        REQUIRE(stage.world.restore_state(stage.blocks[0], state).ok());
        REQUIRE(stage.world.set_budget_us(budget_us).ok());
        stage.step(scenes::walk, kFrame_s);
        stage.time_s -= kFrame_s;
        return stage.read(0, Space::kBind);
      };
      for (int f = 0; f < 120; ++f) {
        const std::vector<std::byte> state = stage.save();
        const std::vector<float> changed = look(to.budget_us, state), kept = look(from.budget_us, state);
        stage.time_s += kFrame_s;
        largest_m = std::max(largest_m, test::largest_distance(changed, kept));
      }
      const double share = largest_m / static_cast<double>(stage.info.height_m);
      UNSCOPED_INFO(from.name << " to " << to.name << ": " << largest_m * 1e3 << " mm, " << 100 * share
                              << " % of the height");
      CHECK(share < kMost);
    }
  }
}

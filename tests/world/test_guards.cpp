// test_guards.cpp  Each guard is seen to fire, and the world goes on.
#include <limits>

#include "tests/world/poison.hpp"

using namespace sinew;
using test::in_network;
using test::poison;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

scenes::BlockPose strong_shake(double t) { return scenes::shake(t, 12); }

struct Place {
  const char* name;
  float* (*of)(const world::Instance& twin);
};
constexpr Place kBasePlaces[] = {
    {"u", [](const world::Instance& t) { return t.tissue.u[0] + 20; }},
    {"u before", [](const world::Instance& t) { return t.tissue.u[1] + 20; }},
    {"q", [](const world::Instance& t) { return t.tissue.q[0] + 2; }},
    {"q before", [](const world::Instance& t) { return t.tissue.q[1] + 3; }},
    {"a frame", [](const world::Instance& t) { return t.motion.poses[0][3].rotation; }},
    {"a place", [](const world::Instance& t) { return t.motion.poses[1][9].place_m; }}};

// Largest change of any vertex from one frame to the next, while something happens every 101 frames.
template <class Event>
double largest_change(Stage& stage, const Event& event) {
  double worst_m = 0;
  std::vector<float> before = stage.read(0, Space::kBind);
  for (int f = 0; f < 600; ++f) {
    if (f % 101 == 0) event();
    stage.step(scenes::walk, kFrame_s);
    std::vector<float> now = stage.read(0, Space::kBind);
    worst_m = std::max(worst_m, test::largest_distance(now, before));
    before = std::move(now);
  }
  return worst_m;
}

}  // namespace

TEST_CASE("inputs_beyond_the_envelope_are_clamped_and_counted") {
  Stage stage;
  stage.play(strong_shake, 2);
  CHECK(stage.report().input_clamps > 0);
  CHECK(test::all_finite(stage.read()));
}

TEST_CASE("displacement_stays_below_the_limit_and_is_counted_where_it_would_not") {
  constexpr double kShare = 0.2;
  const scenes::PackBytes tight = scenes::soft_block({.displacement_limit = kShare});
  Stage stage(1, {}, tight);
  double largest_m = 0;
  for (int f = 0; f < 90; ++f) {
    stage.step(strong_shake, kFrame_s);
    largest_m = std::max(largest_m, test::largest_length(stage.read(0, Space::kBind)));
  }
  CHECK(stage.report().displacement_clamps > 0);
  // Radius 0.2 m or so; skinning bends the bind-space delta a little.
  CHECK(largest_m < 1.3 * kShare * 0.25);
  CHECK(largest_m > 0.02);
}

// Up to the limit only what is shown is held and the state swings on, driven and damped; beyond it all is
// scaled. So it stands after an hour where it stood after seconds. What a frame that turns does to flesh is
// heard of what is shown, or a spin faster than the first mode would fling it without end.
TEST_CASE("an_hour_at_the_limit_winds_nothing_up") {
  const scenes::PackBytes tight = scenes::soft_block({.displacement_limit = 0.2});
  const auto shaken = [](double t) { return scenes::shake(t, 3 * 4); };
  const auto spun = [](double t) { return scenes::bent_pose(0, 0, 30 * t); };
  constexpr double kLong_s = 1.0 / 15;  // four ticks a step
  for (const Tier tier : {Tier::kNetwork, Tier::kModal})
    for (const bool spins : {false, true}) {
      double left_m[2], after_m[2];
      for (const int hour : {0, 1}) {
        Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits}, tight);
        REQUIRE(stage.world.set_budget_us(test::tier_cost_us(tier) * 4.04f).ok());
        for (double t = 0; t < (hour ? 3600 : 10); t += kLong_s)
          spins ? stage.step(spun, kLong_s) : stage.step(shaken, kLong_s);
        CHECK(stage.report().displacement_clamps > 0);
        REQUIRE(stage.report().tier == tier);
        stage.play([](double) { return scenes::bind_pose(); }, 2);
        left_m[hour] = test::largest_length(stage.read(0, Space::kBind));
        stage.play([](double) { return scenes::bind_pose(); }, 5);
        after_m[hour] = test::largest_length(stage.read(0, Space::kBind));
        CHECK(stage.report().restarts == 0);
      }
      INFO("tier " << static_cast<uint32_t>(tier) << (spins ? " spun" : " shaken") << ": after 2 s "
                   << left_m[0] << " m, " << left_m[1] << " m");
      CHECK(left_m[1] < 2 * left_m[0] + 1e-5);
      CHECK(after_m[1] < 1e-4);
    }
}

// NaN anywhere in the network's state: the modal base shows this very tick, and sixty more.
TEST_CASE("nan_in_the_network_falls_back_to_the_modal_base") {
  for (const double share : {0.0, 0.1, 0.3, 0.5, 0.7, 0.95}) {
    INFO("NaN at " << share << " of the network's state");
    Stage stage(2);
    stage.play(scenes::walk, 1);
    poison(stage, in_network(share));
    for (uint32_t f = 0; f <= world::kFallbackTicks + 1; ++f) {
      const FrameReport report = stage.step(scenes::walk, kFrame_s);
      CHECK(report.fallbacks == (f == 0 ? 1 : 0));
      CHECK(report.restarts == 0);
      CHECK(stage.report(0).tier == (f <= world::kFallbackTicks ? Tier::kModal : Tier::kNetwork));
      CHECK(stage.report(0).blend == 1);
      CHECK(stage.report(1).tier == Tier::kNetwork);
      REQUIRE(test::all_finite(stage.read()));
    }
    CHECK(stage.report(0).fallbacks == 1);
    CHECK(stage.report(1).fallbacks == 0);
  }
}

// NaN anywhere under the network: faded to skinning, restarted, counted; the neighbour does not notice.
TEST_CASE("nan_in_the_base_fades_to_skinning_and_restarts") {
  for (const Place& place : kBasePlaces) {
    INFO("NaN in " << place.name);
    Stage stage(2);
    stage.play(scenes::walk, 1);
    poison(stage, place.of);
    uint32_t restarts = 0;
    bool finite = true;
    float least_blend = 1;
    for (int f = 0; f < 90; ++f) {
      restarts += stage.step(scenes::walk, kFrame_s).restarts;
      finite = finite && test::all_finite(stage.read());
      least_blend = std::min(least_blend, stage.report().blend);
    }
    CHECK(restarts == 1);
    CHECK(stage.report(0).restarts == 1);
    CHECK(stage.report(1).restarts == 0);
    CHECK(finite);
    CHECK(least_blend == 0);                        // it went down to skinning
    CHECK(stage.report(0).tier == Tier::kNetwork);  // and came back
    CHECK(stage.report(0).blend == 1);
  }
}

TEST_CASE("restarts_and_fallbacks_do_not_pop") {
  constexpr double kPop = 2;  // as in test_blend
  Stage restarted, fallen, sound;
  for (Stage* stage : {&restarted, &fallen, &sound}) stage->play(scenes::walk, 1.5);
  const double usual_m = largest_change(sound, [] {});
  const double restart_m = largest_change(restarted, [&] { poison(restarted, kBasePlaces[0].of); });
  const double fallback_m = largest_change(fallen, [&] { poison(fallen, in_network(0.3)); });
  REQUIRE(restarted.report().restarts == 6);
  REQUIRE(fallen.report().fallbacks == 6);
  WARN("largest change in a frame with six restarts " << restart_m * 1e3 << " mm, with six fallbacks "
                                                      << fallback_m * 1e3 << " mm, of the sound twin "
                                                      << usual_m * 1e3 << " mm");
  CHECK(restart_m < kPop * usual_m);
  CHECK(fallback_m < kPop * usual_m);
}

// Three times what the tissue is made for, for two seconds, in every simulated tier: held, finite, and at
// rest again when the motion is. A mode of 3.5 Hz damped by 0.1 falls to exp(-0.1 2 pi 3.5 5) = 2e-5 in five
// seconds.
TEST_CASE("overdriven_x3_returns_to_rest") {
  for (const Tier tier : {Tier::kNetwork, Tier::kModal}) {
    INFO("tier " << static_cast<uint32_t>(tier));
    Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
    REQUIRE(stage.world.set_budget_us(test::tier_cost_us(tier) * 1.01f).ok());
    double largest_m = 0;
    for (int f = 0; f < 120; ++f) {
      stage.step([](double t) { return scenes::shake(t, 3 * 4); }, kFrame_s);
      largest_m = std::max(largest_m, test::largest_length(stage.read(0, Space::kBind)));
    }
    CHECK(stage.report().displacement_clamps > 0);
    CHECK(largest_m < 0.25);
    stage.play([](double) { return scenes::bind_pose(); }, 5);
    CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-4);
    CHECK(stage.report().restarts == 0);
  }
}

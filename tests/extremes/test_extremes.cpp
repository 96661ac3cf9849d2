// test_extremes.cpp  A thousand or so of the cases that `extremes` plays by the hundred thousand.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/extremes/scenes.hpp"
#include "tests/extremes/strands.hpp"
#include "tests/extremes/subjects.hpp"

using namespace sinew;
using namespace sinew::extremes;

namespace {

constexpr uint32_t kFrames = 40;
constexpr float kRounding = 1e-5f;

}  // namespace

TEST_CASE(
    "whatever_is_done_to_a_character_no_vertex_is_read_further_out_than_half_of_its_extent_nor_outside_of_"
    "its_bounds") {
  const auto& subjects = built_subjects();
  for (size_t s = 0; s < all_scenes().size(); ++s) {
    for (uint64_t seed = 1; seed <= 10 * subjects.size(); ++seed) {
      Subject& subject = *subjects[seed % subjects.size()];
      const Outcome outcome = play(subject, all_scenes()[s], seed, kFrames);
      INFO(all_scenes()[s].name << ", " << subject.name << ", seed " << seed);
      CHECK(outcome.frames == kFrames);
      CHECK(outcome.worst.finite);
      CHECK(outcome.worst.displacement <= 0.5f + kRounding);
      CHECK((all_scenes()[s].deforms || outcome.worst.outside <= kRounding));
    }
  }
}

TEST_CASE(
    "left_alone_again_a_character_is_like_one_to_whom_nothing_was_done_once_its_slowest_swing_has_died_"
    "down") {
  // To a tenth, and a quarter of that more, for a network's memory may last longer than its modes swing.
  constexpr float kLeft = 0.125f, kLeast = 1e-3f;
  const auto& subjects = built_subjects();
  for (size_t s = 0; s < all_scenes().size(); ++s) {
    for (uint64_t seed = 1; seed <= subjects.size(); ++seed) {
      Subject& subject = *subjects[seed % subjects.size()];
      if (!subject.one_rest) continue;
      const Recovery recovery = recover(subject, all_scenes()[s], seed, kFrames);
      INFO(all_scenes()[s].name << ", " << subject.name << ", seed " << seed << ", " << recovery.largest
                                << " of the height away, left after " << recovery.wait_s << " s");
      CHECK(recovery.left <= std::max(kLeft * recovery.largest, kLeast));
    }
  }
}

TEST_CASE("a_rod_with_a_limit_that_was_folded_over_what_it_touches_comes_back") {
  // Of 15,000 cases those that stayed on the other side of it, where nothing held what swings beyond the
  // limit.
  const auto& subjects = built_subjects();
  const auto limited =
      std::ranges::find(subjects, "block, rods within limits", [](const auto& s) { return s->name; });
  REQUIRE(limited != subjects.end());
  for (const uint64_t seed : {554, 1478, 3314, 7292}) {
    const Scene& scene = all_scenes()[seed % all_scenes().size()];
    const Recovery recovery = recover(**limited, scene, seed, kFrames);
    INFO(scene.name << ", seed " << seed << ", left " << recovery.left << " of " << recovery.largest);
    CHECK(recovery.largest > 0.1f);
    CHECK(recovery.is_back());
  }
}

TEST_CASE("what_has_come_to_rest_stays_there_for_an_hour") {
  constexpr int kTicks_hour = 60 * 60 * 60, kSettle = 60 * 60;
  for (const auto& subject : built_subjects()) {
    Act act(*subject, 0, 1);
    act.clip = kNone;
    REQUIRE(act.world.create_instance({.asset = act.asset}, &act.instance).ok());
    act.begin_frame();
    for (int t = 0; t < kSettle; ++t) act.step();
    const std::vector<float> settled = shown(act);
    for (int t = 0; t < kTicks_hour; ++t) act.step();
    INFO(subject->name);
    CHECK(shown(act) == settled);
  }
}

TEST_CASE("whatever_is_done_to_a_strand_it_ends_no_step_two_percent_beyond_its_length") {
  for (uint32_t s = 0; s < kStrandScenes; ++s) {
    for (uint64_t seed = 1; seed <= 150; ++seed) {
      const StrandOutcome outcome = play_strand(s, seed, kFrames);
      INFO(strand_scene_name(s) << ", seed " << seed);
      CHECK(outcome.finite);
      CHECK(outcome.reach <= 1.02 + 1e-3);  // places are floats of the strand's own units
    }
  }
}

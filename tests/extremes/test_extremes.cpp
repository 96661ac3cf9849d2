// test_extremes.cpp  A thousand or so of the cases that `extremes` plays by the hundred thousand.
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

TEST_CASE("whatever_is_done_to_a_character_no_vertex_is_read_further_out_than_half_of_its_extent") {
  const auto& subjects = built_subjects();
  for (size_t s = 0; s < all_scenes().size(); ++s) {
    for (uint64_t seed = 1; seed <= 10 * subjects.size(); ++seed) {
      Subject& subject = *subjects[seed % subjects.size()];
      const Outcome outcome = play(subject, all_scenes()[s], seed, kFrames);
      INFO(all_scenes()[s].name << ", " << subject.name << ", seed " << seed);
      CHECK(outcome.frames == kFrames);
      CHECK(outcome.worst.finite);
      CHECK(outcome.worst.displacement <= 0.5f + kRounding);
    }
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

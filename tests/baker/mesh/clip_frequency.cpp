// clip_frequency.cpp  Flesh on a column that a clip shakes to and fro.
#include "baker/mesh/regions/clip_frequency.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "column.hpp"

using namespace sinew::baker;

namespace {

constexpr double kShaken_hz = 3;

// Ten seconds of the root swinging along x.
Character shaken_column(double amplitude_m) {
  Character character = column();
  Clip clip{.name = "shake", .duration_s = 10, .channels = {}};
  Channel sway{.node = 0, .times_s = {}, .values = {}};
  for (int k = 0; k <= 600; ++k) {
    sway.times_s.push_back(k / 60.0);
    const double x = amplitude_m * std::sin(2 * std::numbers::pi * kShaken_hz * k / 60);
    sway.values.insert(sway.values.end(), {x, 0, 0});
  }
  clip.channels.push_back(sway);
  character.clips.push_back(clip);
  return character;
}

Recipe soft_middle() {
  Recipe recipe;
  recipe.states_regions = true;
  recipe.regions = {{.name = "middle", .joints = {"bone_1", "bone_2"}}};
  return recipe;
}

// What an oscillator moves by against its foot in the long run.
double amplitude_m(double shaken_m, double frequency_hz, double damping_ratio) {
  const double square = frequency_hz * frequency_hz, shaken = kShaken_hz * kShaken_hz;
  return shaken_m * shaken / std::hypot(square - shaken, 2 * damping_ratio * frequency_hz * kShaken_hz);
}

}  // namespace

TEST_CASE("a_default_frequency_is_raised_just_so_far_that_clips_let_flesh_swing_within_its_limit") {
  Character gentle = shaken_column(0.001), violent = shaken_column(0.3);
  const Region usual = layout_tissue(gentle, soft_middle()).regions.at(0);
  CHECK(gentle.notes.empty());
  const Region raised = layout_tissue(violent, soft_middle()).regions.at(0);
  REQUIRE(violent.notes.size() == 1);
  CHECK_THAT(violent.notes[0], Catch::Contains("'middle'") && Catch::Contains("state frequency_hz"));
  CHECK(raised.frequency_hz > usual.frequency_hz);
  const double limit_m = raised.max_displacement * raised.radius_m;
  // A sine is above 0.988 of its crest for a tenth of the time; the clip's beginning takes a little of that.
  constexpr double kCrest = 1.02, kStep = 1.1;
  CHECK(amplitude_m(0.3, raised.frequency_hz, raised.damping_ratio) < kCrest * limit_m);
  CHECK(amplitude_m(0.3, raised.frequency_hz / kStep, raised.damping_ratio) > limit_m / kCrest);
}

TEST_CASE("a_stated_frequency_is_kept_and_a_note_names_the_one_that_would_do") {
  Character violent = shaken_column(0.3);
  const double would_do = layout_tissue(violent, soft_middle()).regions.at(0).frequency_hz;
  Recipe recipe = soft_middle();
  recipe.regions[0].frequency_hz = 2;
  Character same = shaken_column(0.3);
  CHECK(layout_tissue(same, recipe).regions.at(0).frequency_hz == 2);
  REQUIRE(same.notes.size() == 1);
  CHECK_THAT(same.notes[0], Catch::Contains("too soft"));
  recipe.regions[0].frequency_hz = 1.15 * would_do;
  Character stiff = shaken_column(0.3);
  CHECK(layout_tissue(stiff, recipe).regions.at(0).frequency_hz == 1.15 * would_do);
  CHECK(stiff.notes.empty());
}

TEST_CASE("moduli_are_kept_whatever_clips_do") {
  Character violent = shaken_column(0.3);
  Recipe recipe = soft_middle();
  recipe.states_moduli = true;
  CHECK(layout_tissue(violent, recipe).regions.at(0).frequency_hz == 0);
  CHECK(violent.notes.empty());
}

TEST_CASE("clips_of_no_length_ask_nothing_of_a_frequency") {
  Character character = column();
  character.clips = {{.name = "empty", .duration_s = 0, .channels = {}}};
  Character without = column();
  CHECK(layout_tissue(character, soft_middle()).regions.at(0).frequency_hz ==
        layout_tissue(without, soft_middle()).regions.at(0).frequency_hz);
}

// The root lies down and stays: flesh hangs by its own weight to the side, and less.
TEST_CASE("a_pose_in_which_flesh_sags_beyond_its_limit_counts_as_a_shake_does") {
  Character lying = column();
  Clip clip{.name = "lie", .duration_s = 2, .channels = {}};
  const double half = std::numbers::pi / 4;
  clip.channels.push_back(
      {.node = 0,
       .path = Path::kRotation,
       .times_s = {0, 2},
       .values = {0, 0, std::sin(half), std::cos(half), 0, 0, std::sin(half), std::cos(half)}});
  lying.clips.push_back(clip);
  Recipe recipe = soft_middle();
  recipe.max_displacement = 0.05;
  const Region raised = layout_tissue(lying, recipe).regions.at(0);
  REQUIRE(lying.notes.size() == 1);
  // It swings in from the bind pose and past its rest by half as much again or less, with damping 0.1.
  const double sag_m = std::sqrt(2) * 9.81 / std::pow(2 * std::numbers::pi * raised.frequency_hz, 2);
  CHECK(sag_m < raised.max_displacement * raised.radius_m);
  CHECK(4 * sag_m > raised.max_displacement * raised.radius_m);
}

TEST_CASE("where_no_frequency_would_do_a_note_says_so") {
  Character thrown = shaken_column(1000);
  Recipe recipe = soft_middle();
  recipe.regions[0].frequency_hz = 2;
  layout_tissue(thrown, recipe);
  REQUIRE(thrown.notes.size() == 1);
  CHECK_THAT(thrown.notes[0], Catch::Contains("not even 25"));
}

// test_left_out.cpp  Control graphs that leave regions out: skinned there, untouched elsewhere.
#include "character/describe_instance.hpp"
#include "character/life/snapshot.hpp"
#include "character/rest/asleep.hpp"
#include "character/rest/sleep.hpp"
#include "tests/scenes/half_spaces.hpp"
#include "tests/world/told_block.hpp"

using namespace sinew;

namespace {

constexpr Tier kSimulated[] = {Tier::kModal, Tier::kNetwork};
constexpr uint32_t kWhole = 2, kLess = 3;  // levels of ten nodes a region, with both and with the right alone

const scenes::PackBytes& left_out_pack() {
  static const scenes::PackBytes pack =
      scenes::soft_block({.nodes = 40, .coarser_nodes = {20, 10}, .leaves_out = true});
  return pack;
}

struct Block : test::ToldBlock {
  explicit Block(const ContactDef& contacts = {}) : ToldBlock(left_out_pack(), contacts) {}
  // By how much its vertices are displaced.
  std::vector<float> of_region(size_t r) const {
    const std::vector<float> all = surface();
    const pack::RegionRecord& region = asset().pack.regions[r];
    std::vector<float> out;
    for (const uint32_t v : asset().pack.region_vertices.subspan(region.first_vertex, region.vertex_count))
      out.insert(out.end(), all.begin() + 3 * v, all.begin() + 3 * v + 3);
    return out;
  }
};

float largest(const std::vector<float>& values) {
  float most = 0;
  for (const float x : values) most = std::max(most, std::fabs(x));
  return most;
}

// Of any node, seen or not yet.
double simulated_m(Block& block) {
  const float* u = block.instance().tissue.u[0];
  return test::largest_length({u, u + size_t{3} * block.instance().level->node_count()});
}

}  // namespace

TEST_CASE("what_a_level_leaves_out_is_skinned_and_the_rest_has_the_bits_it_has_beside_it") {
  for (const Tier tier : kSimulated) {
    Block whole, less;
    for (int t = 0; t < 60; ++t) {
      whole.tick(scenes::walk, {.tier = tier, .level = kWhole});
      less.tick(scenes::walk, {.tier = tier, .level = kLess});
      REQUIRE(largest(less.of_region(0)) == 0);
      REQUIRE(less.of_region(1) == whole.of_region(1));
    }
    CHECK(largest(whole.of_region(0)) > 1e-3f);
    const InstanceReport report = world::describe(less.instance(), {});
    CHECK(report.regions_left_out == 1);
    CHECK(world::describe(whole.instance(), {}).regions_left_out == 0);
  }
}

TEST_CASE("a_region_that_is_left_out_fades_and_when_it_is_had_again_swings_as_before") {
  for (const Tier tier : kSimulated) {
    Block whole, changes;
    for (Block* block : {&whole, &changes}) block->play(scenes::walk, {.tier = tier, .level = kWhole}, 60);
    whole.play(scenes::walk, {.tier = tier, .level = kWhole}, 40);
    changes.play(scenes::walk, {.tier = tier, .level = kLess}, 40);
    CHECK(largest(changes.of_region(0)) == 0);
    CHECK(changes.of_region(1) == whole.of_region(1));
    for (Block* block : {&whole, &changes}) block->play(scenes::walk, {.tier = tier, .level = kWhole}, 90);
    const std::vector<float> a = whole.of_region(0), b = changes.of_region(0);
    const double apart_m = test::largest_distance(a, b);
    INFO(static_cast<int>(tier) << ": " << apart_m);
    CHECK(apart_m < 0.1 * static_cast<double>(largest(a)));  // what a tenth of a hertz's damping leaves
  }
}

TEST_CASE("what_begins_under_a_load_that_lasts_begins_where_it_hangs") {
  // By a network that forgot; begun at zero, it has 0.2 too little when it is blended in.
  constexpr float kSwings = 0.15f;
  const auto bent = [](double time_s) { return scenes::bent_pose(0.3 * std::min(1.0, time_s)); };
  for (const Tier tier : kSimulated)
    for (const bool left_alone : {false, true}) {
      Block stays, back;
      for (Block* block : {&stays, &back}) block->play(bent, {.tier = tier, .level = kWhole}, 600);
      back.play(bent, {.tier = left_alone ? Tier::kExtrapolate : tier, .level = kLess}, 60);
      REQUIRE(largest(back.of_region(0)) < 1e-6f);
      for (uint32_t t = 1; t <= 2 * world::kBlendInTicks; ++t) {
        back.tick(bent, {.tier = tier, .level = kWhole});
        const float hangs = largest(stays.of_region(0)), shown = largest(back.of_region(0));
        INFO(static_cast<int>(tier) << " after " << t << ": " << shown / hangs);
        CHECK(shown < (1 + kSwings) * hangs);
        if (t >= world::kBlendInTicks) CHECK(shown > (1 - kSwings) * hangs);
      }
    }
}

TEST_CASE("a_snapshot_of_one_that_leaves_a_region_out_goes_on_with_the_same_bits") {
  for (const Tier tier : kSimulated) {
    Block saved, other;
    saved.play(scenes::walk, {.tier = tier, .level = 0}, 50);
    saved.play(scenes::walk, {.tier = tier, .level = kLess}, 30);
    saved.play(scenes::walk, {.tier = tier, .level = 0}, 7);  // coming into view
    std::vector<std::byte> bytes(world::snapshot_bytes(saved.instance()));
    REQUIRE(world::save(saved.instance(), bytes).ok());
    other.play(scenes::walk, {.tier = tier, .level = 1}, 87);
    REQUIRE(world::restore(other.instance(), bytes).ok());
    for (const uint32_t level : {kLess, 0u, kLess, kWhole}) {
      saved.play(scenes::walk, {.tier = tier, .level = level}, 11);
      other.play(scenes::walk, {.tier = tier, .level = level}, 11);
      REQUIRE(saved.surface() == other.surface());
    }
  }
}

TEST_CASE("what_is_left_out_touches_nothing_and_the_rest_does") {
  const auto stands = [](double) { return scenes::bind_pose(); };
  for (const float side : {-1.0f, 1.0f}) {
    scenes::HalfSpaces wall;
    wall.walls = {{{0.14 * double{side}, 0, 0}, {-side, 0, 0}}};
    for (const uint32_t level : {kWhole, kLess}) {
      Block block({.source = &wall});
      block.play(stands, {.tier = Tier::kModal, .level = level}, 30);
      CHECK((block.instance().told.vertices > 0) == (level == kWhole || side > 0));
    }
  }
}

TEST_CASE("what_is_had_again_on_another_tier_begins_at_rest_too") {
  const auto bent = [](double time_s) { return scenes::bent_pose(0.3 * std::min(1.0, time_s)); };
  Block stays, back;
  stays.play(bent, {.tier = Tier::kModal, .level = kWhole}, 660);
  back.play(bent, {.tier = Tier::kNetwork, .level = kLess}, 620);
  for (int t = 0; t < 40; ++t) {
    back.tick(bent, {.tier = Tier::kModal, .level = kWhole});
    CHECK(largest(back.of_region(0)) < 1.02f * largest(stays.of_region(0)));
  }
  CHECK(largest(back.of_region(0)) > 0.98f * largest(stays.of_region(0)));
}

// For ever it would hold them at their limit.
TEST_CASE("a_jolt_in_the_tick_of_coming_back_throws_nothing_further_than_it_throws_what_stayed") {
  for (const Tier tier : kSimulated) {
    Block stays, back;
    const auto jolted = [](double time_s) {
      scenes::BlockPose pose = scenes::bind_pose();
      if (time_s > 1.5) pose.root.position_m[0] += 0.05;
      return pose;
    };
    stays.play(jolted, {.tier = tier, .level = kWhole}, 90);
    back.play(jolted, {.tier = tier, .level = kWhole}, 30);
    back.play(jolted, {.tier = Tier::kExtrapolate, .level = kWhole}, 60);
    double most_stays = 0, most_back = 0;
    for (int t = 0; t < 60; ++t) {
      stays.tick(jolted, {.tier = tier, .level = kWhole});
      back.tick(jolted, {.tier = tier, .level = kWhole});
      most_stays = std::max(most_stays, test::largest_length(stays.surface()));
      most_back = std::max(most_back, test::largest_length(back.surface()));
    }
    INFO(static_cast<int>(tier) << ": " << most_back << " and " << most_stays);
    CHECK(most_back < most_stays);
  }
}

TEST_CASE("what_is_had_again_against_a_wall_is_pressed_no_further_than_what_stayed") {
  const auto stands = [](double) { return scenes::bind_pose(); };
  for (const Tier tier : kSimulated) {
    scenes::HalfSpaces wall;
    wall.walls = {{{-0.14, 0, 0}, {1, 0, 0}}};
    Block stays({.source = &wall}), back({.source = &wall});
    stays.play(stands, {.tier = tier, .level = kWhole}, 120);
    back.play(stands, {.tier = tier, .level = kLess}, 60);
    double most = 0;
    for (int t = 0; t < 60; ++t) {
      back.tick(stands, {.tier = tier, .level = kWhole});
      most = std::max(most, simulated_m(back));
    }
    INFO(static_cast<int>(tier) << ": " << most << " and " << simulated_m(stays));
    CHECK(most < 2.1 * simulated_m(stays));  // a load that is there at once swings as far again
  }
}

TEST_CASE("what_is_left_out_keeps_nobody_awake") {
  Block block;
  block.sleep_tolerance = 5e-4f;
  const auto stands = [](double) { return scenes::bind_pose(); };
  block.play(scenes::walk, {.tier = Tier::kModal, .level = kLess}, 30);
  block.play(stands, {.tier = Tier::kModal, .level = kLess}, 600);
  CHECK(world::regions_asleep(block.instance()) == 1);
  CHECK(world::describe(block.instance(), {}).why == TierReason::kStill);
}

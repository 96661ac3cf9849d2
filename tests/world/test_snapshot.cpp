// test_snapshot.cpp  Rollback: what follows a restore has the bits of what followed the save.
#include <cstring>
#include <limits>
#include <set>
#include <utility>

#include "character/instance.hpp"
#include "core/hash.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;

std::vector<uint64_t> play_hashes(Stage& stage, int frames) {
  std::vector<uint64_t> hashes;
  for (int f = 0; f < frames; ++f) {
    stage.step(scenes::walk, 1.0 / 45);  // ticks and frames out of step: the accumulator is part of the state
    hashes.push_back(test::hash_of(stage.read()));
  }
  return hashes;
}

void check_refused(Stage& stage, std::span<const std::byte> bytes) {
  const std::vector<std::byte> before = stage.save();
  const Status status = stage.world.restore_state(stage.blocks[0], bytes);
  CHECK(status.code == StatusCode::kCorrupt);
  CHECK(std::string(status.message).size() > 20);
  CHECK(stage.save() == before);
}

struct Given {
  Tier tier;
  uint32_t level;
  uint64_t shown;
  bool operator==(const Given&) const = default;
};

// A crowd whose budget comes and goes, so that tiers and control graphs change: what each was given.
std::vector<Given> play_crowd(Stage& stage, int first_frame, int frames) {
  constexpr float kLow_us = 0.5f, kHigh_us = 6;
  std::vector<Given> given;
  const float network_us = test::tier_cost_us(Tier::kNetwork);
  for (int f = first_frame; f < first_frame + frames; ++f) {
    const float share = 0.5f + 0.5f * std::sin(0.05f * static_cast<float>(f));
    REQUIRE(stage.world.set_budget_us(network_us * (kLow_us + (kHigh_us - kLow_us) * share)).ok());
    stage.step(scenes::walk, kFrame_s);
    for (size_t i = 0; i < stage.blocks.size(); ++i) {
      const InstanceReport report = stage.report(i);
      given.push_back({report.tier, report.graph_level, test::hash_of(stage.read(i))});
    }
  }
  return given;
}

}  // namespace

TEST_CASE("restore_refuses_foreign_bytes_and_changes_nothing") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const std::vector<std::byte> good = stage.save();
  check_refused(stage, {});
  check_refused(stage, std::span(good).first(good.size() - 1));
  check_refused(stage, std::vector<std::byte>(good.size()));
  for (const size_t at : {size_t{0}, size_t{9}, size_t{33}, size_t{41}, good.size() - 1, good.size() / 2}) {
    std::vector<std::byte> flipped = good;
    flipped[at] ^= std::byte{4};
    check_refused(stage, flipped);
  }
  const scenes::PackBytes other_pack = scenes::soft_block({.seed = 2});
  Stage other(1, {}, other_pack);
  REQUIRE(other.save().size() == good.size());
  check_refused(stage, other.save());
}

TEST_CASE("restore_refuses_a_tier_a_control_graph_and_a_time_that_there_is_not") {
  constexpr size_t kHeader_bytes = 40, kChecksum_at = 24;
  Stage stage;
  stage.play(scenes::walk, 0.5);
  const auto changed = [&](const auto& change) {
    std::vector<std::byte> bytes = stage.save();
    world::InstanceState state;
    std::memcpy(&state, bytes.data() + kHeader_bytes, sizeof state);
    change(state);
    std::memcpy(bytes.data() + kHeader_bytes, &state, sizeof state);
    const uint64_t checksum = core::hash64(std::span(bytes).subspan(kHeader_bytes));
    std::memcpy(bytes.data() + kChecksum_at, &checksum, sizeof checksum);
    return bytes;
  };
  check_refused(stage, changed([](world::InstanceState& s) { s.tier = static_cast<Tier>(kTierCount); }));
  check_refused(stage, changed([](world::InstanceState& s) { s.left_tier = static_cast<Tier>(kTierCount); }));
  check_refused(stage, changed([](world::InstanceState& s) { s.tier_limit = Tier::kExtrapolate; }));
  check_refused(stage, changed([](world::InstanceState& s) { s.tier = static_cast<Tier>(3); }));  // springs
  check_refused(stage, changed([](world::InstanceState& s) { s.level = 1; }));
  check_refused(stage, changed([](world::InstanceState& s) {
                  s.transition.seam_ticks = 0;
                }));  // amid a change of graphs
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  check_refused(stage, changed([](world::InstanceState& s) { s.remainder_s = kNotANumber; }));
  check_refused(stage, changed([](world::InstanceState& s) { s.poses.without_pose_s = kNotANumber; }));
  check_refused(
      stage, changed([](world::InstanceState& s) { s.poses.time_scale = static_cast<float>(kNotANumber); }));
  const std::vector<std::byte> right = changed([](world::InstanceState& s) { s.held_s = 2; });
  CHECK(stage.world.restore_state(stage.blocks[0], right).ok());
}

TEST_CASE("save_refuses_a_span_that_is_too_small") {
  Stage stage;
  std::vector<std::byte> small(stage.world.state_bytes(stage.blocks[0]) - 1);
  CHECK(stage.world.save_state(stage.blocks[0], small).code == StatusCode::kInvalidArgument);
}

TEST_CASE("what_follows_a_restore_has_the_same_bits") {
  Stage stage;
  play_hashes(stage, 77);
  const std::vector<std::byte> saved = stage.save();
  const double time_s = stage.time_s;
  const std::vector<float> seen = stage.read();
  const std::vector<uint64_t> first = play_hashes(stage, 90);
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  CHECK(stage.read() == seen);
  stage.time_s = time_s;
  CHECK(play_hashes(stage, 90) == first);
}

TEST_CASE("snapshot_goes_over_to_another_instance_in_another_world") {
  Stage stage, other;
  stage.play(scenes::walk, 1);
  other.play([](double t) { return scenes::shake(t); }, 0.3);
  REQUIRE(other.world.restore_state(other.blocks[0], stage.save()).ok());
  other.time_s = stage.time_s;
  CHECK(play_hashes(other, 30) == play_hashes(stage, 30));
}

TEST_CASE("pose_set_but_not_stepped_is_part_of_the_snapshot") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  stage.pose(stage.blocks[0], scenes::walk(0.6));
  const std::vector<std::byte> saved = stage.save();
  stage.world.step(static_cast<float>(kFrame_s));
  const std::vector<float> first = stage.read();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  stage.world.step(static_cast<float>(kFrame_s));
  CHECK(stage.read() == first);
}

TEST_CASE("rollback_while_fading_and_blending_keeps_bits") {
  Stage stage(1, {.budget_mode = BudgetMode::kWorkUnits});
  stage.play(scenes::walk, 1);
  const auto interrupted = [&] {
    std::vector<uint64_t> hashes;
    for (int f = 0; f < 60; ++f) {
      REQUIRE(stage.world.set_budget_us(f % 30 < 20 ? 1e-6f : std::numeric_limits<float>::infinity()).ok());
      stage.step(scenes::walk, kFrame_s);
      hashes.push_back(test::hash_of(stage.read()));
    }
    return hashes;
  };
  interrupted();
  const std::vector<std::byte> saved = stage.save();
  const double time_s = stage.time_s;
  const std::vector<uint64_t> first = interrupted();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  stage.time_s = time_s;
  CHECK(interrupted() == first);
}

TEST_CASE("what_is_restored_is_planned_by_what_it_was_saved_as") {
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits});
  stage.add(1000);
  stage.add(1);
  REQUIRE(stage.world.set_budget_us(1.05f * test::tier_cost_us(Tier::kNetwork)).ok());
  stage.play(scenes::walk, 1);
  REQUIRE(stage.report(0).tier == Tier::kNetwork);
  REQUIRE(stage.report(1).tier != Tier::kNetwork);
  const std::vector<std::byte> first = stage.save(0), second = stage.save(1);
  REQUIRE(stage.world.restore_state(stage.blocks[0], second).ok());
  REQUIRE(stage.world.restore_state(stage.blocks[1], first).ok());
  stage.world.step(static_cast<float>(kFrame_s));
  CHECK(stage.report(0).tier != Tier::kNetwork);
  CHECK(stage.report(1).tier == Tier::kNetwork);
}

TEST_CASE("a_crowd_rolled_back_gets_the_same_tiers_and_bits_again") {
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits}, test::levels_pack());
  for (int i = 0; i < 6; ++i) stage.add(static_cast<float>(1 + i));
  constexpr int kBefore = 70, kAfter = 200;
  play_crowd(stage, 0, kBefore);
  std::vector<std::vector<std::byte>> saved;
  for (size_t i = 0; i < stage.blocks.size(); ++i) saved.push_back(stage.save(i));
  const double time_s = stage.time_s;
  const std::vector<Given> first = play_crowd(stage, kBefore, kAfter);
  for (size_t i = 0; i < saved.size(); ++i)
    REQUIRE(stage.world.restore_state(stage.blocks[i], saved[i]).ok());
  stage.time_s = time_s;
  const std::vector<Given> again = play_crowd(stage, kBefore, kAfter);
  CHECK(again == first);
  std::set<std::pair<Tier, uint32_t>> had;
  for (const Given& given : first) had.emplace(given.tier, given.level);
  CHECK(had.size() >= 5);  // the budget did make them change
}

TEST_CASE("what_was_reset_and_rolled_back_costs_and_gets_the_same_again") {
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits}, test::levels_pack());
  for (int i = 0; i < 3; ++i) stage.add(static_cast<float>(1 + i));
  play_crowd(stage, 0, 40);
  for (const InstanceId block : stage.blocks) REQUIRE(stage.world.reset(block).ok());
  std::vector<std::vector<std::byte>> saved;
  for (size_t i = 0; i < stage.blocks.size(); ++i) saved.push_back(stage.save(i));
  const double time_s = stage.time_s;
  REQUIRE(stage.world.set_budget_us(0.1f).ok());
  const float first_us = (stage.step(scenes::walk, kFrame_s), stage.report(0).planned_us);
  for (size_t i = 0; i < saved.size(); ++i)
    REQUIRE(stage.world.restore_state(stage.blocks[i], saved[i]).ok());
  stage.time_s = time_s;
  stage.step(scenes::walk, kFrame_s);
  CHECK(stage.report(0).planned_us == first_us);
}

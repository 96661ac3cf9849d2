// test_tier_limit.cpp  An instance that may have no better tier than it is told.
#include <limits>

#include "baker/pack/pack_writer.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kAll = std::numeric_limits<float>::infinity();

WorldDef in_work_units() { return {.budget_mode = BudgetMode::kWorkUnits}; }

void limit(Stage& stage, Tier best, size_t index = 0) {
  REQUIRE(stage.world.set_tier_limit(stage.blocks[index], best).ok());
}

// Largest change of a vertex's displacement from one frame to the next.
double largest_change_m(Stage& stage, int frames) {
  std::vector<float> before = stage.read(0, Space::kBind);
  double largest = 0;
  for (int f = 0; f < frames; ++f) {
    stage.step(scenes::walk, kFrame_s);
    std::vector<float> now = stage.read(0, Space::kBind);
    largest = std::max(largest, test::largest_distance(before, now));
    before = std::move(now);
  }
  return largest;
}

double displaced_m(const Stage& stage) { return test::largest_length(stage.read(0, Space::kBind)); }

// Whose modes are hardly better than skinning, so that no budget would buy them.
scenes::PackBytes poor_modes() {
  pack::PackView view;
  REQUIRE(pack::open_pack(test::block_pack().bytes(), &view).ok());
  std::vector<pack::TierRecord> tiers(view.tiers.begin(), view.tiers.end());
  for (pack::TierRecord& tier : tiers)
    tier.error_ratio = tier.tier == static_cast<uint32_t>(Tier::kNetwork) ? 0.1f
                       : tier.tier == static_cast<uint32_t>(Tier::kModal) ? 0.99f
                                                                          : 1.0f;
  baker::PackWriter writer = baker::PackWriter::from_pack(test::block_pack().bytes());
  writer.section(pack::SectionKind::kTiers, tiers);
  const std::vector<std::byte> bytes = writer.finish();
  return {bytes.data(), bytes.size()};
}

// Walks for two seconds, then stands for good.
scenes::BlockPose walk_and_stand(double time_s) { return scenes::walk(std::min(time_s, 2.0)); }

void put_to_rest(Stage& stage) {
  stage.play(walk_and_stand, 12);
  REQUIRE(stage.report().dormant);
}

}  // namespace

TEST_CASE("a_limit_that_is_no_tier_to_be_had_is_refused") {
  Stage stage;
  stage.play(scenes::walk, 0.5);
  limit(stage, Tier::kModal);
  const std::vector<std::byte> before = stage.save();
  for (const Tier bad : {Tier::kExtrapolate, Tier{3}, Tier{5}, Tier{0x10002}, Tier{0xffffffff}})
    CHECK(stage.world.set_tier_limit(stage.blocks[0], bad).code == StatusCode::kInvalidArgument);
  CHECK(stage.world.set_tier_limit({}, Tier::kModal).code == StatusCode::kStaleId);
  CHECK(World().set_tier_limit(stage.blocks[0], Tier::kModal).code == StatusCode::kInvalidArgument);
  CHECK(stage.save() == before);
}

TEST_CASE("limited_to_modes_it_moves_as_one_whose_asset_has_no_network") {
  for (const double fps : {60.0, 144.0}) {
    Stage limited, without(1, {}, test::weightless_pack());
    limit(limited, Tier::kModal);
    for (int f = 0; f < 300; ++f) {
      limited.step(scenes::walk, 1 / fps);
      without.step(scenes::walk, 1 / fps);
      REQUIRE(limited.read() == without.read());
      CHECK(limited.report().why == TierReason::kBest);
      CHECK(limited.report().tier == without.report().tier);
    }
    CHECK(limited.report().tier == Tier::kModal);
  }
}

TEST_CASE("a_limit_changes_nothing_for_others") {
  Stage both(2), alone;
  limit(both, Tier::kModal, 1);
  for (int f = 0; f < 120; ++f) {
    both.step(scenes::walk, kFrame_s);
    alone.step(scenes::walk, kFrame_s);
    REQUIRE(both.read(0) == alone.read(0));
  }
  CHECK(both.report(0).tier == Tier::kNetwork);
  CHECK(both.report(1).tier == Tier::kModal);
}

TEST_CASE("the_network_goes_in_the_next_tick_and_comes_back_without_a_jump") {
  Stage stage;
  stage.play(scenes::walk, 2);
  const double usual_m = largest_change_m(stage, 120);
  for (int change = 0; change < 4; ++change) {
    limit(stage, change % 2 == 0 ? Tier::kModal : Tier::kNetwork);
    double changed_m = largest_change_m(stage, 1);
    CHECK(stage.report().tier == (change % 2 == 0 ? Tier::kModal : Tier::kNetwork));
    changed_m = std::max(changed_m, largest_change_m(stage, 60 + 7 * change));
    CHECK(changed_m < 1.5 * usual_m);
  }
}

// Down and up again.
TEST_CASE("limited_to_skinning_it_moves_as_under_a_budget_of_0") {
  Stage limited, unpaid;
  const auto play = [&](double seconds) {
    for (int f = 0; f < seconds / kFrame_s; ++f) {
      limited.step(scenes::walk, kFrame_s);
      unpaid.step(scenes::walk, kFrame_s);
      REQUIRE(limited.read() == unpaid.read());
      REQUIRE(limited.report().tier == unpaid.report().tier);
    }
  };
  play(1);
  REQUIRE(displaced_m(limited) > 0.005);
  limit(limited, Tier::kSkinning);
  REQUIRE(unpaid.world.set_budget_us(0).ok());
  play(0.05);
  CHECK(displaced_m(limited) > 0.001);  // it fades
  play(3);
  CHECK(displaced_m(limited) == 0);
  CHECK(limited.report().tier == Tier::kSkinning);
  CHECK(limited.report().why == TierReason::kBest);  // it waits for nothing
  limit(limited, Tier::kNetwork);
  REQUIRE(unpaid.world.set_budget_us(kAll).ok());
  play(2);
  CHECK(limited.report().tier == Tier::kNetwork);
}

TEST_CASE("it_comes_back_from_skinning_without_a_jump") {
  Stage stage;
  stage.play(scenes::walk, 2);
  const double usual_m = largest_change_m(stage, 120);
  for (const Tier best : {Tier::kSkinning, Tier::kModal, Tier::kSkinning, Tier::kNetwork}) {
    limit(stage, best);
    CHECK(largest_change_m(stage, 77) < 1.5 * usual_m);
    CHECK(stage.report().tier == best);
  }
}

TEST_CASE("a_limit_holds_under_every_budget_and_what_it_leaves_goes_to_others") {
  const float network_us = test::tier_cost_us(Tier::kNetwork), modal_us = test::tier_cost_us(Tier::kModal);
  Stage stage(2, in_work_units());
  limit(stage, Tier::kModal);
  for (const float budget_us : {1.05f * (network_us + modal_us), 3 * network_us, kAll, 0.0f,
                                0.7f * network_us, 1.05f * (network_us + modal_us)}) {
    REQUIRE(stage.world.set_budget_us(budget_us).ok());
    for (int f = 0; f < 180; ++f) {
      stage.step(scenes::walk, kFrame_s);
      REQUIRE(stage.report(0).tier != Tier::kNetwork);
    }
  }
  CHECK(stage.report(0).tier == Tier::kModal);
  CHECK(stage.report(1).tier == Tier::kNetwork);
  limit(stage, Tier::kSkinning);
  REQUIRE(stage.world.set_budget_us(1.05f * network_us).ok());
  stage.play(scenes::walk, 3);
  CHECK(stage.report(0).tier == Tier::kSkinning);
  CHECK(stage.report(0).why == TierReason::kBest);
  CHECK(stage.report(1).tier == Tier::kNetwork);
}

// By a clock, too, which keeps fronts at what tiers cost now.
TEST_CASE("modes_that_no_budget_would_buy_are_had_at_the_limit") {
  const scenes::PackBytes pack = poor_modes();
  for (const BudgetMode mode : {BudgetMode::kWorkUnits, BudgetMode::kTime}) {
    Stage stage(1, {.budget_mode = mode}, pack);
    stage.play(scenes::walk, 0.5);
    REQUIRE(stage.report().tier == Tier::kNetwork);
    limit(stage, Tier::kModal);
    stage.play(scenes::walk, 0.5);
    CHECK(stage.report().tier == Tier::kModal);
    CHECK(stage.report().why == TierReason::kBest);
    REQUIRE(stage.world.set_budget_us(1e6f).ok());
    stage.play(scenes::walk, 0.5);
    CHECK(stage.report().tier == Tier::kModal);
  }
}

TEST_CASE("a_snapshot_holds_the_limit") {
  for (const Tier best : {Tier::kModal, Tier::kSkinning}) {
    Stage stage(1, in_work_units());
    stage.play(scenes::walk, 1);
    const std::vector<std::byte> whole = stage.save();
    limit(stage, best);
    stage.step(scenes::walk, kFrame_s);
    const std::vector<std::byte> limited = stage.save();
    const auto tier_after = [&](const std::vector<std::byte>& bytes) {
      REQUIRE(stage.world.restore_state(stage.blocks[0], bytes).ok());
      stage.play(scenes::walk, 0.5);
      return stage.report().tier;
    };
    CHECK(tier_after(whole) == Tier::kNetwork);
    CHECK(tier_after(limited) == best);
  }
}

TEST_CASE("a_reset_and_another_asset_keep_the_limit") {
  const scenes::PackBytes other = poor_modes();
  Stage stage;
  limit(stage, Tier::kModal);
  stage.play(scenes::walk, 0.5);
  REQUIRE(stage.world.reset(stage.blocks[0]).ok());
  stage.play(scenes::walk, 0.5);
  CHECK(stage.report().tier == Tier::kModal);
  AssetId by;
  REQUIRE(stage.world.load_asset(other.bytes(), &by).ok());
  REQUIRE(stage.world.replace_asset(stage.asset, by).ok());
  stage.play(scenes::walk, 0.5);
  CHECK(stage.report().tier == Tier::kModal);
  limit(stage, Tier::kNetwork);
  stage.play(scenes::walk, 0.5);
  CHECK(stage.report().tier == Tier::kNetwork);
}

// A step without a tick must not put it back to sleep as it was.
TEST_CASE("a_dormant_one_obeys_and_comes_back") {
  for (const double fps : {60.0, 144.0}) {
    Stage stage(1, in_work_units());
    put_to_rest(stage);
    for (const Tier best : {Tier::kModal, Tier::kSkinning, Tier::kModal, Tier::kNetwork}) {
      CAPTURE(fps, static_cast<uint32_t>(best));
      limit(stage, best);
      stage.pose(stage.blocks[0], walk_and_stand(2));
      stage.world.step(0);
      stage.play(walk_and_stand, 0.1, fps);
      CHECK(stage.report().tier == best);
      stage.play(walk_and_stand, 8, fps);
      CHECK(stage.report().tier == best);
      CHECK(stage.report().dormant == (best != Tier::kSkinning));
      CHECK((displaced_m(stage) == 0) == (best == Tier::kSkinning));
    }
  }
}

TEST_CASE("a_limit_that_is_set_again_wakes_nobody") {
  Stage stage(1, in_work_units());
  put_to_rest(stage);
  limit(stage, Tier::kNetwork);
  CHECK(stage.step(walk_and_stand, kFrame_s).instances_dormant == 1);
}

TEST_CASE("who_comes_into_view_obeys_what_was_set_while_hidden") {
  Stage stage;
  stage.play(scenes::walk, 1);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], true).ok());
  stage.play(scenes::walk, 0.5);
  limit(stage, Tier::kModal);
  REQUIRE(stage.world.set_hidden(stage.blocks[0], false).ok());
  stage.play(scenes::walk, 0.5);
  CHECK(stage.report().tier == Tier::kModal);
}

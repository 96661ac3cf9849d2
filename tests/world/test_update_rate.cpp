// test_update_rate.cpp  Ticks that are not simulated whole: near those that are, without jumps, in turns.
#include "world/update_rate.hpp"

#include <memory>

#include "tests/world/told_block.hpp"
#include "world/plan_row.hpp"
#include "world/sleep.hpp"
#include "world/snapshot.hpp"

using namespace sinew;

namespace {

class Block : public test::ToldBlock {
 public:
  explicit Block(const scenes::PackBytes& pack = test::block_pack(), uint32_t made_before = 0)
      : ToldBlock(pack, {}, made_before) {}
  void tick(const test::Motion& motion, Tier tier, uint32_t every) {
    ToldBlock::tick(motion, {.tier = tier, .every = every});
  }
  void play(const test::Motion& motion, Tier tier, uint32_t every, int ticks) {
    ToldBlock::play(motion, {.tier = tier, .every = every}, ticks);
  }
};

struct Apart {
  double mean_m = 0, of_shown = 0;
};

// Over two seconds of walking and shaking.
Apart apart_from_every_tick(Tier tier, uint32_t every) {
  double sum = 0, shown = 0, count = 0;
  for (const test::Motion& motion :
       {test::Motion(scenes::walk), test::Motion([](double t) { return scenes::shake(t); })}) {
    Block whole, fewer;
    for (int t = 0; t < 180; ++t) {
      whole.tick(motion, tier, 1);
      fewer.tick(motion, tier, every);
      const std::vector<float> a = whole.shown(), b = fewer.shown();
      for (size_t v = 0; v < a.size(); v += 3) {
        sum += std::hypot(a[v] - b[v], a[v + 1] - b[v + 1], a[v + 2] - b[v + 2]);
        shown += std::hypot(a[v], a[v + 1], a[v + 2]);
        count += 1;
      }
    }
  }
  return {sum / count, sum / shown};
}

constexpr Tier kRated[] = {Tier::kSpring, Tier::kModal};

}  // namespace

TEST_CASE("networks_contacts_and_rods_are_simulated_in_every_tick") {
  Block block;
  block.play(scenes::walk, Tier::kNetwork, 2, 3);
  CHECK(world::every_of(block.instance()) == 1);
  block.play(scenes::walk, Tier::kModal, 2, 3);
  CHECK(world::every_of(block.instance()) == 2);
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  Block with_rods(pack);
  with_rods.play(scenes::walk, Tier::kModal, 2, 3);
  CHECK(world::every_of(with_rods.instance()) == 1);
}

// Walking, and shaking near resonance. A tick late at 3.5 Hz is 0.37 rad, and so 0.3 or so of what is shown:
// without what is missed being made up it is 0.2.
TEST_CASE("every_second_tick_is_near_to_all_of_them") {
  for (const Tier tier : kRated) {
    const Apart two = apart_from_every_tick(tier, 2);
    INFO(static_cast<int>(tier) << ": of what is shown " << two.of_shown);
    CHECK(two.of_shown < 0.1);
    CHECK(two.of_shown > 1e-4);  // they are fewer
  }
}

TEST_CASE("a_block_that_stands_still_has_no_displacement_at_any_rate") {
  for (const Tier tier : kRated) {
    for (const uint32_t every : {1u, 2u}) {
      Block block;
      block.play([](double) { return scenes::bind_pose(); }, tier, every, 30);
      CHECK(test::largest_length(block.shown()) < 1e-6);
    }
  }
}

// A static load: rounding of other sums in another order is all that is left between them.
TEST_CASE("at_rest_in_a_bent_pose_all_rates_end_in_the_same_place") {
  const auto bent = [](double time_s) { return scenes::bent_pose(0.3 * std::min(1.0, time_s)); };
  for (const Tier tier : kRated) {
    Block whole;
    whole.play(bent, tier, 1, 600);
    {
      Block fewer;
      fewer.play(bent, tier, 2, 600);
      INFO(test::largest_length(whole.shown()));
      CHECK(test::largest_distance(whole.shown(), fewer.shown()) <
            1e-3 * test::largest_length(whole.shown()));
    }
  }
}

// How much more two blocks, one of which changes, are apart from one tick to the next: 0.3 % of the height is
// the project's bound.
TEST_CASE("a_change_of_rate_makes_no_jump") {
  for (const Tier tier : kRated) {
    for (const auto& [from, to] : {std::pair{1u, 2u}, {2u, 1u}}) {
      double worst = 0;
      for (int at = 70; at < 110; at += 7) {
        Block stays, changes;
        stays.play(scenes::walk, tier, from, at);
        changes.play(scenes::walk, tier, from, at);
        std::vector<float> gap(stays.shown().size());

        for (int t = 0; t < 12; ++t) {
          stays.tick(scenes::walk, tier, from);
          changes.tick(scenes::walk, tier, to);
          const std::vector<float> a = stays.shown(), b = changes.shown();
          std::vector<float> now(a.size());
          for (size_t i = 0; i < a.size(); ++i) now[i] = b[i] - a[i];
          worst = std::max(worst, test::largest_distance(now, gap));
          gap = now;
        }
      }
      INFO(static_cast<int>(tier) << " from every " << from << " to every " << to << ": " << worst << " m of "
                                  << Block().height_m());
      CHECK(worst < 0.003 * static_cast<double>(Block().height_m()));
    }
  }
}

TEST_CASE("instances_take_turns") {
  Block first(test::block_pack(), 0), second(test::block_pack(), 1);
  for (int t = 0; t < 20; ++t) {
    first.tick(scenes::walk, Tier::kModal, 2);
    second.tick(scenes::walk, Tier::kModal, 2);
    if (t > 2) CHECK(first.instance().heard_now != second.instance().heard_now);
  }
}

TEST_CASE("a_block_between_its_ticks_is_restored_to_the_same_bits") {
  for (const Tier tier : kRated) {
    for (int more = 0; more < 2; ++more) {
      Block saved;
      saved.play(scenes::walk, tier, 2, 60 + more);
      std::vector<std::byte> bytes(world::snapshot_bytes(saved.instance()));
      REQUIRE(world::save(saved.instance(), bytes).ok());
      Block other;
      other.play(scenes::walk, tier, 2, 60 + more);
      for (float* heard : other.instance().heard) std::fill_n(heard, 3, 1.0f);
      REQUIRE(world::restore(other.instance(), bytes).ok());
      saved.play(scenes::walk, tier, 2, 20);
      other.play(scenes::walk, tier, 2, 20);
      CHECK(test::hash_of(saved.shown()) == test::hash_of(other.shown()));
    }
  }
}

// By ticks, not by those that are simulated whole.
TEST_CASE("a_block_at_rest_falls_asleep_as_soon_at_any_rate") {
  const auto stop = [](double t) { return scenes::shake(std::min(t, 1.0)); };
  int asleep_after[2] = {};
  for (const uint32_t every : {1u, 2u}) {
    Block block;
    block.sleep_tolerance = 5e-3f;
    int& ticks = asleep_after[every - 1];
    for (; ticks < 1200 && !world::is_asleep(block.instance(), 0); ++ticks)
      block.tick(stop, Tier::kModal, every);
  }
  CHECK(asleep_after[0] < 1200);
  CHECK(std::abs(asleep_after[0] - asleep_after[1]) < 40);  // two swings: of which one is the first quiet
}

// What the scheduler asks of a block is what it was saved as.
TEST_CASE("a_restored_block_is_planned_at_the_rate_it_was_saved_at") {
  Block block;
  block.play(scenes::walk, Tier::kModal, 2, 60);
  std::vector<std::byte> bytes(world::snapshot_bytes(block.instance()));
  REQUIRE(world::save(block.instance(), bytes).ok());
  block.play(scenes::walk, Tier::kModal, 1, 4);
  REQUIRE(world::restore(block.instance(), bytes).ok());
  world::PlanRow row;
  world::copy_to_row(block.instance(), &row);
  CHECK(row.every == 2);
}

// test_rod_surface.cpp  What a character's rods touch follows its tier: skins, or the capsules about its
// bones.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "character/asset/affords_surface.hpp"
#include "character/asset/open_asset.hpp"
#include "character/life/create_instance.hpp"
#include "character/rest/asleep.hpp"
#include "character/rest/rod_sleep.hpp"
#include "character/transition/change_level.hpp"
#include "tests/scenes/half_spaces.hpp"
#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"
#include "world/step/fold.hpp"

using namespace sinew;
using scenes::kTail;
using scenes::TailedPose;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr double kSkin_m = 0.37;  // over the ground: above the bar, that the tail falls on without it
constexpr double kOnSkin_m = kSkin_m + 0.9 * scenes::kTailRadius_m;  // of its bones' ends
constexpr uint64_t kBody = 7;

// A floor that is told of pushes.
struct Skin : scenes::HalfSpaces {
  std::atomic<uint32_t> asked{0}, pushed{0}, strange{0};
  explicit Skin(double height_m = kSkin_m) { walls = {{{0, height_m, 0}, {0, 1, 0}}}; }
  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override {
    ++asked;
    const uint32_t found = HalfSpaces::find(probes, dt_s, hits);
    for (ContactHit& hit : hits.first(std::min<size_t>(found, hits.size()))) hit.body = kBody;
    return found;
  }
  void push(const ContactHit& hit, const double (&)[3], const float (&)[3]) noexcept override {
    ++pushed;
    strange += hit.body != kBody;
  }
};

const scenes::RodMatter kLimp{.sag = 1, .young_modulus_pa = 1e5, .bar = true};

const scenes::PackBytes& tailed_pack() {
  static const scenes::PackBytes pack =
      scenes::soft_block({.nodes = 40, .rods = kLimp, .coarser_nodes = {10}});
  return pack;
}

float baked_us(Tier tier, uint32_t level) {
  pack::PackView view;
  REQUIRE(pack::open_pack(tailed_pack().bytes(), &view).ok());
  for (const pack::TierRecord& record : view.tiers)
    if (record.tier == static_cast<uint32_t>(tier) && record.level == level) return record.cost_us;
  FAIL("no such tier");
  return 0;
}

constexpr WorldDef kInUnits{.budget_mode = BudgetMode::kWorkUnits};

struct SurfaceStage : Stage {
  TailedPose pose = scenes::with_rods(scenes::bind_pose());

  explicit SurfaceStage(const ContactDef& contacts, const WorldDef& def = kInUnits)
      : Stage(0, def, tailed_pack()) {
    add_with(contacts);
  }
  void add_with(const ContactDef& contacts) {
    InstanceId made;
    REQUIRE(world.create_instance({.asset = asset, .contacts = contacts}, &made).ok());
    blocks.push_back(made);
  }
  FrameReport step_pose() {
    for (const InstanceId id : blocks) REQUIRE(world.set_pose(id, pose.pose()).ok());
    return world.step(static_cast<float>(kFrame_s));
  }
  void hold(int frames) {
    for (int f = 0; f < frames; ++f) step_pose();
  }
  // What pays for this tier and for none above.
  void set_tier(Tier tier, uint32_t level) {
    const bool best = tier == Tier::kNetwork && level == 0;
    REQUIRE(world.set_budget_us(best ? INFINITY : 1.01f * baked_us(tier, level)).ok());
  }
  // Of the tail's bones' beginnings.
  double lowest_m(size_t index = 0) const {
    std::vector<Matrix34> joints(info.joint_count);
    REQUIRE(world.read_joint_matrices(blocks[index], joints).ok());
    double least = 1;
    for (uint32_t j = kTail + 1; j < kTail + 4; ++j)
      least = std::min(least, static_cast<double>(joints[j].m[1][3]));
    return least;
  }
};

}  // namespace

TEST_CASE("a_surface_that_is_the_source_is_refused_and_one_of_a_character_without_rods_is_not_asked") {
  Skin skin;
  SurfaceStage stage({.own_body = true, .surface = &skin});
  InstanceId made;
  const Status status = stage.world.create_instance(
      {.asset = stage.asset, .contacts = {.source = &skin, .surface = &skin}}, &made);
  CHECK(status.code == StatusCode::kInvalidArgument);
  CHECK(made == InstanceId{});
  Stage bald(1);
  REQUIRE(bald.world.create_instance({.asset = bald.asset, .contacts = {.surface = &skin}}, &made).ok());
  bald.blocks.push_back(made);
  bald.play(scenes::walk, 1);
  CHECK(skin.asked == 0);
  CHECK_FALSE(bald.report(1).rods_touch_surface);
  CHECK(bald.world.state_bytes(made) == bald.world.state_bytes(bald.blocks[0]));
}

TEST_CASE("rods_lie_on_skin_in_tiers_that_afford_it_and_on_capsules_in_all_others") {
  // The first is never bought here: rods cost most, and hardly less on it.
  CHECK_FALSE(world::affords_surface(Tier::kExtrapolate, 0));
  CHECK(world::affords_surface(Tier::kModal, 0));
  const std::pair<Tier, uint32_t> all[] = {{Tier::kNetwork, 0}, {Tier::kNetwork, 1}, {Tier::kModal, 1}};
  for (const auto& [tier, level] : all) {
    const bool affords = level == 0;
    CHECK(world::affords_surface(tier, level) == affords);
    Skin skin;
    SurfaceStage stage({.own_body = true, .surface = &skin});
    stage.set_tier(tier, level);
    stage.hold(120);
    const InstanceReport report = stage.report();
    REQUIRE(report.tier == tier);
    REQUIRE(report.graph_level == level);
    CHECK(report.rods_touch_surface == affords);
    CHECK((skin.asked > 0) == affords);
    CHECK((stage.lowest_m() > kOnSkin_m) == affords);
    CHECK(stage.lowest_m() > kSkin_m - 0.03);  // the bar's top is two centimetres below
    CHECK(report.rod_contacts > 0);
  }
}

TEST_CASE("what_rods_touch_changes_with_the_tier_and_back_as_often_as_it_does") {
  Skin skin;
  SurfaceStage stage({.own_body = true, .surface = &skin});
  for (int change = 0; change < 4; ++change) {
    stage.set_tier(Tier::kNetwork, static_cast<uint32_t>(change % 2));
    stage.hold(240);
    CHECK(stage.report().rods_touch_surface == (change % 2 == 0));
    CHECK((stage.lowest_m() > kOnSkin_m) == (change % 2 == 0));
  }
  CHECK(stage.report().rod_recoveries == 0);
}

// Half the tail lies four centimetres in it.
TEST_CASE("what_a_change_leaves_inside_of_the_skin_is_brought_out_by_degrees") {
  constexpr double kMost = 0.003;  // of the height, a frame
  Skin skin(kSkin_m + 0.05);
  SurfaceStage stage({.own_body = true, .surface = &skin});
  stage.set_tier(Tier::kNetwork, 1);
  stage.hold(240);
  const double before_m = stage.lowest_m();
  REQUIRE(before_m < kOnSkin_m + 0.01);
  stage.set_tier(Tier::kNetwork, 0);
  double last_m = before_m;
  for (int f = 0; f < 600; ++f) {
    stage.step_pose();
    CHECK(std::abs(stage.lowest_m() - last_m) < kMost * static_cast<double>(stage.info.height_m));
    last_m = stage.lowest_m();
  }
  CHECK(last_m > kOnSkin_m + 0.05);
}

TEST_CASE("without_an_own_body_nothing_stands_in_the_place_of_the_skin") {
  Skin skin;
  SurfaceStage stage({.surface = &skin});
  stage.hold(120);
  CHECK(stage.lowest_m() > kOnSkin_m);
  stage.set_tier(Tier::kNetwork, 1);
  stage.hold(240);
  CHECK(stage.report().rod_contacts == 0);
  CHECK(stage.lowest_m() < kSkin_m - 0.05);
}

TEST_CASE("skin_gives_nothing_back_and_a_source_beside_it_is_told_of_its_own_contacts_alone") {
  Skin skin, floor(kSkin_m - 0.01), low(-1);
  SurfaceStage on_skin({.source = &low, .tissue = false, .surface = &skin}),
      on_floor({.source = &floor, .tissue = false, .surface = &low});
  on_skin.hold(120);
  on_floor.hold(120);
  CHECK(on_skin.lowest_m() > kOnSkin_m);
  CHECK(on_floor.lowest_m() > kOnSkin_m - 0.01);
  CHECK(skin.pushed == 0);
  CHECK(low.pushed == 0);
  CHECK(floor.pushed > 0);
  CHECK(floor.strange == 0);
}

TEST_CASE("a_rollback_over_changes_of_what_rods_touch_has_the_same_bits") {
  Skin skin;
  SurfaceStage stage({.own_body = true, .surface = &skin});
  stage.hold(60);
  std::vector<std::byte> saved = stage.save(), seen[2];
  for (std::vector<std::byte>& end : seen) {
    REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
    uint32_t changes = 0;
    for (int f = 0; f < 90; ++f) {
      const bool was = stage.report().rods_touch_surface;
      stage.set_tier(Tier::kNetwork, f / 30 == 1 ? 1 : 0);
      stage.step_pose();
      changes += f > 0 && stage.report().rods_touch_surface != was;
    }
    CHECK(changes == 2);
    end = stage.save();
  }
  CHECK(seen[0] == seen[1]);
  SurfaceStage other({.own_body = true});
  CHECK(other.world.restore_state(other.blocks[0], saved).code == StatusCode::kCorrupt);
  Skin floor(-1);
  SurfaceStage asks({.source = &floor, .own_body = true, .surface = &skin}),
      does_not({.source = &floor, .rods = false, .own_body = true, .surface = &skin});
  CHECK(does_not.world.restore_state(does_not.blocks[0], asks.save()).code == StatusCode::kCorrupt);
}

TEST_CASE("rods_on_skin_have_the_same_bits_on_any_number_of_workers") {
  std::vector<std::byte> seen[2];
  for (int workers = 0; workers < 2; ++workers) {
    scenes::ThreadPool pool(4);
    WorldDef def = kInUnits;
    if (workers) def.tasks = pool.hook();
    Skin skin;
    SurfaceStage stage({.own_body = true, .surface = &skin}, def);
    for (int i = 0; i < 4; ++i) stage.add_with({.own_body = true, .surface = &skin});
    stage.hold(60);
    stage.set_tier(Tier::kNetwork, 1);  // for one of them
    stage.hold(60);
    for (size_t i = 0; i < stage.blocks.size(); ++i) {
      const std::vector<std::byte> state = stage.save(i);
      seen[workers].insert(seen[workers].end(), state.begin(), state.end());
    }
  }
  CHECK(seen[0] == seen[1]);
}

TEST_CASE("rods_at_rest_away_from_skin_sleep_in_every_tier_and_wake_as_it_comes_near") {
  Skin skin(-0.5);
  SurfaceStage stage({.surface = &skin});
  stage.hold(1500);
  CHECK(stage.report().rods_asleep > 0);
  CHECK(stage.report().rods_touch_surface);
  CHECK_FALSE(stage.report().dormant);
  const double hangs_m = stage.lowest_m();
  for (int f = 0; f <= 60; ++f) {
    skin.walls[0].point_m[1] = hangs_m + 0.05 - 0.1 * (1 - f / 60.0);
    skin.walls[0].velocity_m_s[1] = f < 60 ? 0.1f : 0;
    stage.step_pose();
  }
  stage.hold(2);
  CHECK(stage.report().rods_asleep == 0);
  CHECK(stage.lowest_m() > hangs_m + 0.05);
}

TEST_CASE("rods_asleep_ask_of_skin_a_rod_at_a_time_and_wake_where_capsules_take_its_place") {
  Skin skin(-0.5);
  SurfaceStage stage({.own_body = true, .surface = &skin});
  stage.hold(1500);
  REQUIRE(stage.report().rods_asleep > 0);
  skin.asked = 0;
  stage.hold(10);
  CHECK(skin.asked == 10 * stage.report().rods_asleep);
  stage.set_tier(Tier::kNetwork, 1);
  stage.hold(2);
  CHECK_FALSE(stage.report().rods_touch_surface);
  CHECK(stage.report().rods_asleep == 0);
}

// ---- what it costs, seen through a clock that only skins turn ----

namespace {

struct Clock {
  std::atomic<uint64_t> now_ns{0};
  ClockHook hook() {
    const auto look = [](void* context) -> uint64_t { return static_cast<Clock*>(context)->now_ns += 100; };
    return {.now_ns = look, .context = this};
  }
};

struct DearSkin : Skin {
  Clock& clock;
  uint64_t takes_ns = 500'000;
  explicit DearSkin(Clock& turned) : clock(turned) {}
  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override {
    clock.now_ns += takes_ns;
    return Skin::find(probes, dt_s, hits);
  }
};

}  // namespace

TEST_CASE("a_budget_that_does_not_pay_for_skin_gets_capsules_and_is_hardly_exceeded_to_try_again") {
  for (const bool walks : {false, true}) {
    for (const float budget_us : {100.0f, 600.0f, 20000.0f}) {  // a tick on skin takes a thousand or two
      Clock clock;
      DearSkin skin(clock);
      SurfaceStage stage({.own_body = true, .surface = &skin}, {.clock = clock.hook()});
      REQUIRE(stage.world.set_budget_us(budget_us).ok());
      stage.hold(120);
      uint32_t on_skin = 0, over = 0, simulated = 0;
      for (int f = 0; f < 1200; ++f) {
        if (walks) stage.pose = scenes::with_rods(scenes::walk(f * kFrame_s));
        over += stage.step_pose().over_budget;
        on_skin += stage.report().rods_touch_surface;
        simulated += stage.report().tier == Tier::kNetwork;
      }
      CHECK(simulated > 1180);
      CHECK((budget_us > 1000 ? on_skin > 1180 : on_skin < 24));
      CHECK(over < 24);
    }
  }
}

// It is tried again after two seconds, so that it may change once a second; without that it did three times.
TEST_CASE("near_its_price_skin_is_not_taken_and_left_all_the_time") {
  for (const float budget_us : {500.0f, 1000.0f, 1500.0f, 2000.0f, 2500.0f, 3000.0f, 4000.0f}) {
    Clock clock;
    DearSkin skin(clock);
    SurfaceStage stage({.own_body = true, .surface = &skin}, {.clock = clock.hook()});
    REQUIRE(stage.world.set_budget_us(budget_us).ok());
    stage.hold(120);
    uint32_t changes = 0, over = 0;
    bool had = stage.report().rods_touch_surface;
    for (int f = 0; f < 2400; ++f) {
      stage.pose = scenes::with_rods(scenes::walk(f * kFrame_s));
      over += stage.step_pose().over_budget;
      const bool has = stage.report().rods_touch_surface;
      changes += has != std::exchange(had, has);
    }
    INFO(budget_us);
    CHECK(changes < 40);
    CHECK(over < 48);
  }
}

TEST_CASE("skin_that_was_too_dear_and_is_cheap_now_is_touched_again") {
  Clock clock;
  DearSkin skin(clock);
  SurfaceStage stage({.own_body = true, .surface = &skin}, {.clock = clock.hook()});
  REQUIRE(stage.world.set_budget_us(300).ok());
  stage.hold(300);
  REQUIRE_FALSE(stage.report().rods_touch_surface);
  skin.takes_ns = 1000;
  stage.hold(1800);
  CHECK(stage.report().rods_touch_surface);
}

// A step in which a tick took a tenth of what it should have.
TEST_CASE("who_sleeps_on_skin_is_priced_so_and_who_is_on_capsules_is_not") {
  for (const uint32_t level : {0u, 1u}) {
    Skin skin;
    world::WorldState state;
    REQUIRE(world::reserve(state, {.max_assets = 1, .max_instances = 1}));
    world::Asset opened;
    REQUIRE(world::open_asset(tailed_pack().bytes(), &opened).ok());
    world::Asset& asset = *state.assets.find(state.assets.create(std::move(opened)));
    world::Instance made;
    REQUIRE(world::make_instance(asset, {.contacts = {.surface = &skin}}, &made).ok());
    world::Instance& block = *state.instances.find(state.instances.create(std::move(made)));
    block.plan = {.decision = {.level = level, .tier = Tier::kModal}, .ticks = {.ticks = 1}};
    block.state->tier = Tier::kModal;
    block.state->rods.quiet_ticks = world::kRodsQuietTicks;
    world::change_level(block, level);
    world::keep_row(state, 0);
    const float tick_us = asset.surface_costs.cost.of(Tier::kModal, level).estimate_us();
    block.times.drive_ns = static_cast<uint64_t>(100 * tick_us);
    FrameReport report;
    world::fold_results(state, report);
    CHECK((block.cost_factor < 1) == (level == 0));
    block.state->tier = block.plan.decision.tier = Tier::kExtrapolate;
    world::keep_row(state, 0);
    world::fold_results(state, report);
    CHECK(block.cost_factor == 1);
  }
}

TEST_CASE("rods_asleep_on_skin_sleep_on_over_a_tick_that_was_cut") {
  Skin skin(-0.5);
  SurfaceStage stage({.own_body = true, .surface = &skin});
  stage.hold(1500);
  const uint32_t asleep = stage.report().rods_asleep;
  REQUIRE(asleep > 0);
  REQUIRE(stage.world.set_budget_us(1e-6f).ok());
  stage.step_pose();
  REQUIRE(stage.report().tier == Tier::kExtrapolate);
  REQUIRE(stage.world.set_budget_us(INFINITY).ok());
  stage.hold(2);
  CHECK(stage.report().rods_asleep == asleep);
}

TEST_CASE("those_who_have_no_skin_to_touch_are_not_charged_for_it") {
  Clock clock;
  DearSkin skin(clock);
  SurfaceStage stage({.own_body = true, .surface = &skin}, {.clock = clock.hook()});
  for (int i = 0; i < 3; ++i) stage.add_with({.own_body = true});
  REQUIRE(stage.world.set_budget_us(300).ok());
  stage.hold(300);
  CHECK_FALSE(stage.report().rods_touch_surface);
  for (size_t i = 1; i < 4; ++i) {
    CHECK(stage.report(i).tier == Tier::kNetwork);
    CHECK(stage.report(i).graph_level == 0);
  }
}

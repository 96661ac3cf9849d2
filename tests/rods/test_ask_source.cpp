// test_ask_source.cpp  A contact source: what of its hits is taken, that it replaces an obstacle, that what
// it is told keeps the momentum, and that nothing fast gets through.
#include "tests/pack/count_allocations.hpp"
#include "tests/rods/passing_scenes.hpp"

using namespace sinew;

namespace {

constexpr rods::ColliderSettings kAsks = {.rods_collide = false, .source_capacity = 256};
constexpr test::RodSettings kFloating = {.gravity_m_s2 = {0, 0, 0}};

// Answers with what it is given, for every probe.
struct Told : ContactSource {
  std::vector<ContactHit> hits;
  uint32_t asked = 0;
  std::vector<ContactProbe> last;
  uint32_t find(std::span<const ContactProbe> probes, float, std::span<ContactHit> out) noexcept override {
    last.assign(probes.begin(), probes.end());
    ++asked;
    std::copy_n(hits.begin(), std::min(out.size(), hits.size()), out.begin());
    return static_cast<uint32_t>(hits.size());
  }
};

// Stops all that falls, a twentieth of a metre below; asked again, says that it begins deep, until it is
// asked with less than so much of the first radius: then something is a tenth of a millimetre away.
struct DeepWhenAskedAgain : ContactSource {
  float until = 0.25f;
  std::vector<float> radii_m;  // of each question
  uint32_t find(std::span<const ContactProbe> probes, float, std::span<ContactHit> out) noexcept override {
    radii_m.push_back(probes[0].radius_m);
    const float radius_m = radii_m.back();
    out[0] = {};
    out[0].normal[1] = 1;
    out[0].gap_m = radius_m < until * radii_m[0] ? 1e-4
                   : radii_m.size() == 1         ? 0.05
                                                 : -0.5 * static_cast<double>(radius_m);
    return 1;
  }
};

// Stops the first segment two centimetres below, and says nothing when it is asked again.
struct StopsTheFirst : ContactSource {
  std::vector<size_t> probes;  // of each question
  uint32_t find(std::span<const ContactProbe> asked, float, std::span<ContactHit> out) noexcept override {
    probes.push_back(asked.size());
    out[0] = {};
    out[0].normal[1] = 1;
    out[0].gap_m = 0.02;
    return probes.size() == 1 ? 1 : 0;
  }
};

std::vector<ContactHit> bad_hits() {
  std::vector<ContactHit> bad(12);
  for (ContactHit& hit : bad) hit.gap_m = -0.005;
  bad[0].probe = 10;
  bad[1].probe = ~0u;
  bad[2].along = 1.5f;
  bad[3].along = std::nanf("");
  bad[4].gap_m = std::nan("");
  bad[5].gap_m = HUGE_VAL;
  bad[6].normal[1] = 0;
  bad[7].normal[0] = std::nanf("");
  bad[8].velocity_m_s[2] = HUGE_VALF;
  bad[9].friction = -1;
  bad[10].restitution = 1.5f;
  bad[11].restitution = std::nanf("");
  return bad;
}

struct Run {
  test::RodBatch batch;
  rods::RodCollider collider;
};
Run run_of(const std::vector<test::Segments>& rods, const test::RodSettings& settings = {},
           const rods::ColliderSettings& contacts = kAsks) {
  Run run = {test::batch_of(rods, settings), {}};
  run.collider = test::collider_of(run.batch, contacts);
  return run;
}

}  // namespace

TEST_CASE("bad_hits_are_left_out_and_counted_and_a_source_without_room_is_refused") {
  Told source;
  Run without = run_of({test::lying_rod(0.05)}, {}, {});
  const Status status = without.collider.set_source(&source);
  CHECK(status.code == StatusCode::kOutOfCapacity);
  CHECK_THAT(status.message, Catch::Contains("source_capacity"));
  test::step(without.batch, without.collider);
  CHECK(source.asked == 0);
  REQUIRE(without.collider.set_source(nullptr).ok());

  source.hits = bad_hits();
  Run run = run_of({test::lying_rod(0.05)}, kFloating, {.rods_collide = false, .source_capacity = 13});
  REQUIRE(run.collider.set_source(&source, 7).ok());
  test::RodReport report = test::step(run.batch, run.collider);
  CHECK(source.asked == 1);
  CHECK(source.last.size() == 10);
  CHECK(source.last[3].owner == 7);
  CHECK(source.last[3].radius_m == 0.01f);
  CHECK(source.last[3].start_m[1][0] == Approx(0.4).margin(1e-7));
  CHECK(report.bad_hits == source.hits.size());
  CHECK(report.contacts == 0);
  CHECK(rods::length(test::mean_velocity(run.batch, 0)) < 1e-6);
  // A good one among them is taken; what it has found beyond the room is counted.
  source.hits.insert(source.hits.begin() + 4, ContactHit{.probe = 3, .gap_m = -0.005});
  source.hits.resize(20);
  report = test::step(run.batch, run.collider);
  CHECK(report.bad_hits == 12);
  CHECK(report.contacts == 1);
  CHECK(report.contacts_dropped == 7);
  CHECK(run.batch.velocity(0, 3).linear_m_s[1] > 0.01f);
  REQUIRE(run.collider.set_source(nullptr).ok());
  CHECK(test::step(run.batch, run.collider).contacts == 0);
}

TEST_CASE("hits_beyond_source_capacity_are_dropped_and_counted_over_all_groups") {
  std::vector<test::Segments> strands;
  for (int i = 0; i < 18; ++i) strands.push_back(test::lying_rod(0.05 * i));  // two groups of 16
  Run run = run_of(strands, kFloating, {.rods_collide = false, .source_capacity = 5});
  Told source;
  for (uint32_t i = 0; i < 3; ++i) source.hits.push_back({.probe = i, .gap_m = 0.001});
  REQUIRE(run.collider.set_source(&source).ok());
  const test::RodReport report = test::step(run.batch, run.collider);
  CHECK(source.asked == 2);
  CHECK(report.contacts == 5);
  CHECK(report.contacts_dropped == 1);
  CHECK(report.bad_hits == 0);
}

TEST_CASE("a_fixed_segment_is_no_probe") {
  test::Segments rod = test::lying_rod(0.05);
  rod[0].fixed = true;
  Run run = run_of({rod});
  Told source;
  REQUIRE(run.collider.set_source(&source).ok());
  test::step(run.batch, run.collider);
  CHECK(source.last.size() == 9);
  CHECK(source.last[0].start_m[0][0] == Approx(0.1).margin(1e-7));
}

TEST_CASE("a_source_of_a_capsule_holds_a_rod_as_the_capsule_does") {
  const rods::Capsule bar = {.ends_m = {{0.5, 0, -1}, {0.5, 0, 1}}, .radius_m = 0.05f, .friction = 1};
  Run own = run_of({test::lying_rod(0.2)}), asked = run_of({test::lying_rod(0.2)});
  REQUIRE(own.collider.set_capsules({&bar, 1}).ok());
  test::CapsuleSource source({bar});
  REQUIRE(asked.collider.set_source(&source).ok());
  int compared = 0;
  bool ended = true, ended_before;
  for (int i = 0; i < 90; ++i) {
    // Each step from the same state: two bones on a bar with a friction of 1 stick or slide by a hair, and
    // the same scene begun a tenth of a micrometre higher ends half a millimetre off.
    REQUIRE(asked.batch.take_state(own.batch).ok());
    const test::RodReport one = test::step(own.batch, own.collider),
                          other = test::step(asked.batch, asked.collider);
    CHECK(other.deepest_penetration < 0.05f);
    // Or goes on from forces that depend on their start.
    ended_before = ended, ended = one.contacts_unconverged + other.contacts_unconverged == 0;
    if (!ended || !ended_before) continue;
    ++compared;
    // Both find one contact a segment, of the same normal up to how far the bar's own sweep is advanced.
    CHECK(asked.batch.pose(0, 4).position_m[1] == Approx(own.batch.pose(0, 4).position_m[1]).margin(1e-4));
  }
  CHECK(compared >= 70);
  CHECK(test::end_of(own.batch, test::lying_rod(0.2), 4)[1] > 0.06);
}

TEST_CASE("what_a_source_is_pushed_with_is_minus_what_the_rods_felt") {
  // Two rods thrown onto a floor that slides along them; without gravity, it alone changes their momentum.
  Run run = run_of({test::lying_rod(0.03), test::lying_rod(0.1)}, kFloating);
  test::FloorSource floor(0.4f, {1, 0, 0});
  REQUIRE(run.collider.set_source(&floor).ok());
  test::throw_rod(run.batch, 0, 0.2f, -3, 0);
  test::throw_rod(run.batch, 1, 0, -2, 0);
  const double mass = 10 * rods::segment_inertia(test::lying_rod(0)[0]).mass_kg;
  const auto momentum = [&] {
    return rods::scaled(mass,
                        rods::sum(test::mean_velocity(run.batch, 0), test::mean_velocity(run.batch, 1)));
  };
  const rods::Vector before = momentum();
  for (int i = 0; i < 20; ++i) CHECK(test::step(run.batch, run.collider).unconverged == 0);
  const rods::Vector given = rods::difference(momentum(), before);
  CHECK(given[1] > 4.9 * mass);
  CHECK(given[0] > 0.5 * mass);
  // The 1 %.
  CHECK(rods::length(rods::sum(given, floor.pushed)) < 0.01 * rods::length(given));
  CHECK(floor.lowest_m > -0.001);  // points are where the rods touch: within a tenth of their radius
  CHECK(floor.highest_m < 0.001);
}

// Groups whose strands have all converged give their places to what comes next: twelve where eight at a time
// go on, half of them lying still while the other half is thrown down beside them.
TEST_CASE("what_strands_come_to_and_push_does_not_depend_on_which_groups_end_before_theirs") {
  constexpr uint32_t kGroups = 12, kWidth = 16, kStrands = kGroups * kWidth;
  const auto is_thrown = [](uint32_t group, bool in_turn) {
    return in_turn ? group % 2 == 1 : group >= kGroups / 2;
  };
  std::vector<rods::Vector> ends[2];
  rods::Vector pushed[2];
  for (const bool in_turn : {false, true}) {
    std::vector<test::Segments> rods;
    for (uint32_t s = 0; s < kStrands; ++s) {
      rods.push_back(test::lying_rod(is_thrown(s / kWidth, in_turn) ? 0.1 + 1e-3 * (s % kWidth) : 0.01));
    }
    Run run = run_of(rods, {}, {.rods_collide = false, .source_capacity = 32 * kStrands});
    test::FloorSource floor(0.4f, {});
    REQUIRE(run.collider.set_source(&floor).ok());
    for (uint32_t s = 0; s < kStrands; ++s) {
      if (is_thrown(s / kWidth, in_turn)) test::throw_rod(run.batch, s, 0.2f, -2, 0.1f);
    }
    for (int i = 0; i < 8; ++i) test::step(run.batch, run.collider);
    for (const bool thrown : {false, true}) {
      for (uint32_t s = 0; s < kStrands; ++s) {
        if (is_thrown(s / kWidth, in_turn) == thrown) {
          ends[in_turn].push_back(test::end_of(run.batch, rods[s], 9));
        }
      }
    }
    pushed[in_turn] = floor.pushed;
  }
  CHECK(ends[0] == ends[1]);  // to the bit
  // Added up in another order.
  CHECK(test::distance(pushed[0], pushed[1]) < 1e-6 * rods::length(pushed[0]));
}

// Of forces that did not settle no more is handed on than what moved the strand.
TEST_CASE("a_strand_that_does_not_converge_pushes_no_more_than_it_was_moved") {
  Run run = run_of({test::crossing_rod(0.5, 0.1)}, {.max_iterations = 2, .gravity_m_s2 = {0, 0, 0}});
  test::FloorSource floor(0.4f, {1, 0, 0});  // rolls it, by more than a radian a step
  REQUIRE(run.collider.set_source(&floor).ok());
  test::throw_rod(run.batch, 0, 0, -2, 0);
  const double mass = 10 * rods::segment_inertia(test::lying_rod(0)[0]).mass_kg;
  uint32_t unconverged = 0;
  for (int i = 0; i < 20; ++i) {
    const rods::Vector before = test::mean_velocity(run.batch, 0);
    floor.pushed = {};
    unconverged += test::step(run.batch, run.collider).contacts_unconverged;
    const double moved = rods::length(rods::difference(test::mean_velocity(run.batch, 0), before));
    CHECK(rods::length(floor.pushed) <= 1.01 * mass * moved + 1e-6);
  }
  CHECK(unconverged > 0);
}

// Else what a step began deep in would go through at once.
TEST_CASE("what_begins_in_the_core_that_is_looked_at_again_is_stopped_by_a_smaller_one") {
  Run run = run_of({test::lying_rod(0.5)}, kFloating);
  DeepWhenAskedAgain source;
  REQUIRE(run.collider.set_source(&source).ok());
  test::throw_rod(run.batch, 0, 0, -50, 0);
  const double height_m = run.batch.pose(0, 0).position_m[1];
  const test::RodReport report = test::step(run.batch, run.collider);
  REQUIRE(source.radii_m.size() == 3);
  CHECK(source.radii_m[1] == Approx(0.5 * source.radii_m[0]));
  CHECK(source.radii_m[2] == Approx(0.8 * 0.5 * source.radii_m[1]));  // four fifths of where its axis was
  CHECK(report.contacts_unconverged == 1);
  CHECK(run.batch.pose(0, 0).position_m[1] == Approx(height_m).margin(1e-6));
}

// Where it does, only what ended elsewhere than it was looked for.
TEST_CASE("of_a_strand_that_does_not_converge_all_that_moves_far_is_looked_at_again") {
  const auto asked_again = [](uint32_t max_iterations) {
    Run run = run_of({test::lying_rod(0.5)}, {.max_iterations = max_iterations, .gravity_m_s2 = {0, 0, 0}});
    StopsTheFirst source;
    REQUIRE(run.collider.set_source(&source).ok());
    test::throw_rod(run.batch, 0, 0, -3, 0);
    test::step(run.batch, run.collider);
    REQUIRE(source.probes.size() == 2);
    CHECK(source.probes[0] == 10);
    return source.probes[1];
  };
  CHECK(asked_again(1) == 10);
  CHECK(asked_again(12) < 10);
}

TEST_CASE("what_begins_in_every_core_is_looked_at_three_times_and_goes_on") {
  Run run = run_of({test::lying_rod(0.5)}, kFloating);
  DeepWhenAskedAgain source;
  source.until = 0;
  REQUIRE(run.collider.set_source(&source).ok());
  test::throw_rod(run.batch, 0, 0, -50, 0);
  const double height_m = run.batch.pose(0, 0).position_m[1];
  test::step(run.batch, run.collider);
  CHECK(source.radii_m.size() == 4);
  CHECK(run.batch.pose(0, 0).position_m[1] < height_m - 0.04);
}

TEST_CASE("of_a_thousand_rods_at_fifty_metres_a_second_none_passes_through_a_source_s_capsule") {
  const test::Passes passes = test::rods_at_a_bar(1000, test::Through::kSource);
  CHECK(passes.passed == 0);
  CHECK(passes.hit > 900);
}

TEST_CASE("a_step_that_asks_a_source_allocates_nothing") {
  Run run = run_of({test::lying_rod(0.011), test::crossing_rod(0.5, 0.012)});
  test::FloorSource floor(0.5f, {0, 0, 0});
  REQUIRE(run.collider.set_source(&floor).ok());
  CHECK(test::step(run.batch, run.collider).contacts > 10);
  const size_t before = test::allocation_count();
  for (int i = 0; i < 10; ++i) (void)run.batch.step(test::kFrame_s, &run.collider, nullptr);
  CHECK(test::allocation_count() == before);
}

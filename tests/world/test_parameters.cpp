// test_parameters.cpp  How parts swing, changed by an engine between steps.
#include <limits>
#include <numbers>
#include <string>

#include "character/parameters/tuned_parts.hpp"
#include "character/parameters/tuning_state.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::kTail;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kGlideFrames = 60;  // more than any change takes

// ---- refusals ----

struct Bad {
  std::string name;
  PartParameters parameters;
  StatusCode code;
};

std::vector<Bad> bad_parameters() {
  struct Field {
    const char* name;
    float PartParameters::*field;
    float below, above;
  };
  const Field fields[] = {{"intensity", &PartParameters::intensity, -0.1f, 2.1f},
                          {"stiffness", &PartParameters::stiffness, 0.009f, 101},
                          {"damping", &PartParameters::damping, -0.1f, 101},
                          {"displacement", &PartParameters::displacement, -0.1f, 4.1f}};
  std::vector<Bad> all;
  for (const Field& f : fields)
    for (const float value : {f.below, f.above, INFINITY, kNan}) {
      PartParameters bad;
      bad.*f.field = value;
      all.push_back({f.name, bad, std::isnan(value) ? StatusCode::kNotFinite : StatusCode::kInvalidArgument});
    }
  return all;
}

// ---- a free swing ----

// One number a frame, about which something swings.
using Track = std::vector<double>;

// Times at which it goes up through zero, in frames.
std::vector<double> risings(const Track& track) {
  std::vector<double> at;
  for (size_t f = 1; f < track.size(); ++f)
    if (track[f - 1] < 0 && track[f] >= 0)
      at.push_back(static_cast<double>(f) - track[f] / (track[f] - track[f - 1]));
  return at;
}

double frequency_hz(const Track& track) {
  const std::vector<double> at = risings(track);
  REQUIRE(at.size() >= 3);
  return 60 * static_cast<double>(at.size() - 1) / (at.back() - at.front());
}

// By the logarithm of how large it is in two cycles.
double damping_ratio(const Track& track) {
  constexpr size_t kCycles = 2;  // from one to the other
  const std::vector<double> at = risings(track);
  REQUIRE(at.size() >= kCycles + 2);
  const auto energy = [&](size_t cycle) {
    double sum = 0;
    for (auto f = static_cast<size_t>(at[cycle]); f < static_cast<size_t>(at[cycle + 1]); ++f)
      sum += track[f] * track[f];
    return sum;
  };
  const double decrement = std::log(energy(0) / energy(kCycles)) / (4 * std::numbers::pi * kCycles);
  return decrement / std::sqrt(1 + decrement * decrement);
}

// A push of 4 cm along x within a tenth of a second.
scenes::BlockPose pushed(double time_s) {
  const double t = std::clamp((time_s - 2) / 0.1, 0.0, 1.0);
  return scenes::bent_pose(0, 0.04 * t * t * (3 - 2 * t));
}

// How the block's top swings along x after that push, once the faster modes have died down.
Track swing_of(const PartParameters& parameters, size_t skipped = 140) {
  Stage stage(1, {.sleep_tolerance = 0}, test::weightless_pack());
  REQUIRE(stage.world.set_parameters(stage.blocks[0], parameters).ok());
  const std::vector<float> bind = stage.read();
  size_t top = 0;
  for (size_t v = 0; v < bind.size(); v += 3)
    if (bind[v + 1] > bind[top + 1]) top = v;
  Track track;
  for (size_t f = 0; f < 400; ++f) {
    stage.step(pushed, kFrame_s);
    if (f > skipped) track.push_back(static_cast<double>(stage.read(0, Space::kBind)[top]));
  }
  return track;
}

// How far the tail's last bone is from its pose, along x.
Track tail_swing_of(const PartParameters& parameters) {
  static const scenes::PackBytes pack =
      scenes::soft_block({.network = false, .rods = scenes::RodMatter{.gravity = 0}});
  Stage stage(1, {.sleep_tolerance = 0}, pack);
  for (uint32_t rod = 0; rod < 3; ++rod)
    REQUIRE(stage.world.set_rod_parameters(stage.blocks[0], rod, parameters).ok());
  Track track;
  std::vector<Matrix34> joints(stage.info.joint_count);
  for (int f = 1; f < 700; ++f) {
    const scenes::TailedPose pose = scenes::with_rods(pushed(f * kFrame_s));
    REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
    stage.world.step(static_cast<float>(kFrame_s));
    REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
    if (f > 150)
      track.push_back(static_cast<double>(joints[kTail + 3].m[0][3] - pose.joints[kTail + 3].m[0][3]));
  }
  return track;
}

// ---- jumps ----

// Largest motion of any vertex from one frame to the next, pose left out, from the second second on.
// change: called before each frame.
template <class Change>
double largest_step_m(Stage& stage, double fps, double seconds, Change change) {
  double largest = 0;
  stage.time_s = 0;
  std::vector<float> last;
  for (int f = 0; f < static_cast<int>(seconds * fps); ++f) {
    change(f / fps);
    stage.time_s += 1 / fps;
    const scenes::TailedPose pose = scenes::with_rods(scenes::walk(stage.time_s));
    REQUIRE(stage.world
                .set_pose(stage.blocks[0], {std::span(pose.joints).first(stage.info.joint_count), pose.root})
                .ok());
    stage.world.step(static_cast<float>(1 / fps));
    std::vector<float> now = stage.read();
    if (f > fps) largest = std::max(largest, test::largest_distance(now, last));
    last = std::move(now);
  }
  return largest;
}

struct Sweep {
  const char* name;
  PartParameters low, high;
};

std::vector<Sweep> sweeps() {
  PartParameters off, soft{.stiffness = 0.01f}, tight{.stiffness = 100};
  off.enabled = false;
  return {{"intensity", {.intensity = 0}, {.intensity = 2}},
          {"stiffness", soft, tight},
          {"damping", {.damping = 0}, {.damping = 100}},
          {"displacement", {.displacement = 0}, {.displacement = 4}},
          {"enabled", off, {}},
          {"all", {0, 0.01f, 0, 0, true}, {2, 100, 100, 4, true}},
          {"all the other way", {0, 100, 0, 4, true}, {2, 0.01f, 100, 0, true}}};
}

// Each number goes its own pace, so that on their way all together may be as lively as any mixture.
PartParameters liveliest_of(const Sweep& sweep) {
  const PartParameters &a = sweep.low, &b = sweep.high;
  return {std::max(a.intensity, b.intensity), std::min(a.stiffness, b.stiffness),
          std::min(a.damping, b.damping), std::max(a.displacement, b.displacement), true};
}

// The sweep's largest step, over that of the liveliest that it passes, and of the baked.
double jump_ratio(const scenes::PackBytes& pack, const Sweep& sweep, double fps) {
  constexpr double kSeconds = 10, kEach_s = 1.3;
  const auto steady_m = [&](const PartParameters& parameters) {
    Stage stage(1, {}, pack);
    REQUIRE(stage.world.set_parameters(stage.blocks[0], parameters).ok());
    return largest_step_m(stage, fps, kSeconds, [](double) {});
  };
  const double usual_m =
      std::max({steady_m({}), steady_m(sweep.low), steady_m(sweep.high), steady_m(liveliest_of(sweep))});
  Stage stage(1, {}, pack);
  const double swept_m = largest_step_m(stage, fps, kSeconds, [&](double time_s) {
    const bool high = static_cast<int>(time_s / kEach_s) % 2 == 1;
    REQUIRE(stage.world.set_parameters(stage.blocks[0], high ? sweep.high : sweep.low).ok());
  });
  return swept_m / usual_m;
}

}  // namespace

TEST_CASE("parameters_that_are_none_are_refused_and_change_nothing") {
  Stage stage(1, {}, test::tailed_pack());
  World& world = stage.world;
  const InstanceId block = stage.blocks[0];
  stage.world.step(static_cast<float>(kFrame_s));
  const std::vector<std::byte> before = stage.save();
  const auto refused = [](const Status& status, const Bad& bad) {
    CHECK(status.code == bad.code);
    CHECK(std::string(status.message).find(bad.name) != std::string::npos);
  };
  for (const Bad& bad : bad_parameters()) {
    INFO(bad.name);
    refused(world.set_parameters(block, bad.parameters), bad);
    refused(world.set_region_parameters(block, 1, bad.parameters), bad);
    refused(world.set_rod_parameters(block, 2, bad.parameters), bad);
  }
  PartParameters out{.intensity = 7};
  CHECK(world.set_region_parameters(block, 2, {}).code == StatusCode::kInvalidArgument);
  CHECK(world.set_rod_parameters(block, 3, {}).code == StatusCode::kInvalidArgument);
  CHECK(world.region_parameters(block, 2, &out).code == StatusCode::kInvalidArgument);
  CHECK(world.rod_parameters(block, 3, &out).code == StatusCode::kInvalidArgument);
  CHECK(world.parameters(block, nullptr).code == StatusCode::kInvalidArgument);
  CHECK(world.set_parameters({}, {}).code == StatusCode::kStaleId);
  CHECK(world.set_region_parameters({}, 0, {}).code == StatusCode::kStaleId);
  CHECK(world.set_rod_parameters({}, 0, {}).code == StatusCode::kStaleId);
  CHECK(world.parameters({}, &out).code == StatusCode::kStaleId);
  CHECK(stage.faults.faults == 4);
  CHECK(out.intensity == 7);
  CHECK(stage.save() == before);
  World null;
  CHECK(null.set_parameters(block, {}).code == StatusCode::kInvalidArgument);
  CHECK(null.parameters(block, &out).code == StatusCode::kInvalidArgument);
}

TEST_CASE("what_was_set_is_told_and_parts_have_names") {
  Stage stage(1, {}, test::tailed_pack());
  const InstanceId block = stage.blocks[0];
  const PartParameters all{.intensity = 0.5f}, region{.stiffness = 3}, rod{.damping = 2, .enabled = false};
  REQUIRE(stage.world.set_parameters(block, all).ok());
  REQUIRE(stage.world.set_region_parameters(block, 1, region).ok());
  REQUIRE(stage.world.set_rod_parameters(block, 0, rod).ok());
  PartParameters out;
  REQUIRE(stage.world.parameters(block, &out).ok());
  CHECK(out.intensity == 0.5f);
  REQUIRE(stage.world.region_parameters(block, 1, &out).ok());
  CHECK(out.stiffness == 3);
  REQUIRE(stage.world.rod_parameters(block, 0, &out).ok());
  CHECK((out.damping == 2 && !out.enabled));
  REQUIRE(stage.world.region_parameters(block, 0, &out).ok());
  CHECK((out.stiffness == 1 && out.enabled));
}

TEST_CASE("defaults_that_are_set_give_the_bits_of_what_was_never_set") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  Stage set(1, {}, pack), never(1, {}, pack);
  for (int f = 1; f <= 240; ++f) {
    REQUIRE(set.world.set_parameters(set.blocks[0], {}).ok());
    REQUIRE(set.world.set_region_parameters(set.blocks[0], 0, {}).ok());
    REQUIRE(set.world.set_rod_parameters(set.blocks[0], 0, {}).ok());
    const scenes::TailedPose pose = scenes::with_rods(scenes::walk(f * kFrame_s));
    for (Stage* stage : {&set, &never}) {
      REQUIRE(stage->world.set_pose(stage->blocks[0], pose.pose()).ok());
      stage->world.step(0.013f);
    }
    REQUIRE(set.read() == never.read());
  }
  CHECK(set.save() == never.save());
}

// Between the peaks of a swing of modes: a tick's recurrence is exact, what is left are faster modes.
TEST_CASE("a_soft_part_s_frequency_goes_with_the_root_of_its_stiffness") {
  const double baked_hz = frequency_hz(swing_of({}));
  CHECK(baked_hz == Approx(3.5).epsilon(0.02));
  for (const float stiffness : {0.25f, 0.5f, 2.0f, 4.0f}) {
    INFO(stiffness);
    CHECK(frequency_hz(swing_of({.stiffness = stiffness})) ==
          Approx(std::sqrt(double{stiffness}) * baked_hz).epsilon(0.02));
  }
}

// Of a chain of stiff pieces under an implicit step, which slows quick swings a little.
TEST_CASE("a_rod_s_frequency_goes_with_the_root_of_its_stiffness") {
  const double baked_hz = frequency_hz(tail_swing_of({}));
  for (const float stiffness : {0.25f, 0.5f, 2.0f, 4.0f}) {
    INFO(stiffness);
    CHECK(frequency_hz(tail_swing_of({.stiffness = stiffness})) ==
          Approx(std::sqrt(double{stiffness}) * baked_hz).epsilon(0.05));
  }
}

TEST_CASE("a_soft_part_s_damping_ratio_is_as_many_times_the_baked_at_every_stiffness") {
  for (const float stiffness : {0.5f, 1.0f, 2.0f})
    for (const float damping : {0.3f, 1.0f, 2.0f}) {
      INFO(stiffness << " " << damping);
      CHECK(damping_ratio(swing_of({.stiffness = stiffness, .damping = damping})) ==
            Approx(0.1 * double{damping}).epsilon(0.2));
    }
}

TEST_CASE("a_rod_that_is_damped_more_comes_to_rest_sooner") {
  const double baked = damping_ratio(tail_swing_of({}));
  CHECK(damping_ratio(tail_swing_of({.damping = 4})) > 1.2 * baked);
  CHECK(damping_ratio(tail_swing_of({.damping = 0})) < baked);
}

TEST_CASE("at_intensity_0_what_is_shown_is_the_pose_and_half_of_it_is_half") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  for (const float intensity : {0.0f, 0.5f, 2.0f}) {
    Stage stage(1, {}, pack), usual(1, {}, pack);
    REQUIRE(stage.world.set_parameters(stage.blocks[0], {.intensity = intensity}).ok());
    double most_m = 0, off_m = 0;
    for (int f = 1; f <= 120; ++f) {
      const scenes::TailedPose pose = scenes::with_rods(scenes::walk(f * kFrame_s));
      for (Stage* each : {&stage, &usual}) {
        REQUIRE(each->world.set_pose(each->blocks[0], pose.pose()).ok());
        each->world.step(static_cast<float>(kFrame_s));
      }
      if (f < kGlideFrames) continue;
      const std::vector<float> now = stage.read(0, Space::kBind);
      std::vector<float> share = usual.read(0, Space::kBind);
      for (float& x : share) x *= intensity;
      most_m = std::max(most_m, test::largest_length(now));
      off_m = std::max(off_m, test::largest_distance(now, share));
      if (intensity == 0) {
        const std::vector<float> joints = test::joints_of(stage);
        for (size_t j = 0; j < stage.info.joint_count; ++j)
          for (size_t k = 0; k < 12; ++k)
            CHECK(std::abs(joints[12 * j + k] - (&pose.joints[j].m[0][0])[k]) < 3e-6f);
      }
    }
    INFO(intensity);
    if (intensity == 0)
      CHECK(most_m == 0);
    else
      CHECK(most_m > 0.005);
    CHECK(off_m < 1e-6);
  }
}

TEST_CASE("a_part_that_is_off_fades_costs_no_tick_and_comes_back_from_rest") {
  Stage stage;
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 0, {.enabled = false}).ok());
  stage.play(scenes::walk, 1.5);
  const uint32_t vertices = stage.info.vertex_count;
  // The block's left half is the first region.
  const auto left_m = [&] {
    const std::vector<float> delta = stage.read(0, Space::kBind), bind = stage.read();
    double most = 0;
    for (uint32_t v = 0; v < vertices; ++v)
      most = std::max(most, std::hypot(double{delta[3 * v]}, double{delta[3 * v + 1]}));
    return most;
  };
  CHECK(left_m() > 0);  // the other one swings
  CHECK(stage.report().regions_asleep == 1);
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 1, {.enabled = false}).ok());
  stage.play(scenes::walk, 2);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) == 0);
  CHECK(stage.report().tier == Tier::kSkinning);  // all of it is off
  CHECK(stage.report().planned_us < 1);
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 1, {}).ok());
  stage.play(scenes::walk, 2);
  CHECK(stage.report().tier == Tier::kNetwork);
  CHECK(stage.report().regions_asleep == 1);
  CHECK(test::largest_length(stage.read(0, Space::kBind)) > 0.005);
}

TEST_CASE("rods_that_are_off_are_at_their_pose_and_not_stepped") {
  Stage stage(1, {}, test::tailed_pack());
  for (uint32_t rod = 0; rod < 3; ++rod)
    REQUIRE(stage.world.set_rod_parameters(stage.blocks[0], rod, {.enabled = false}).ok());
  scenes::TailedPose pose;
  const auto play = [&](int frames) {
    for (int f = 0; f < frames; ++f) {
      stage.time_s += kFrame_s;
      pose = scenes::with_rods(scenes::walk(stage.time_s));
      REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
      stage.world.step(static_cast<float>(kFrame_s));
    }
  };
  const auto off_m = [&] {
    const std::vector<float> joints = test::joints_of(stage);
    double most = 0;
    for (size_t j = 0; j < stage.info.joint_count; ++j)
      for (size_t row = 0; row < 3; ++row)
        most = std::max(most, std::abs(double{joints[12 * j + 4 * row + 3] - pose.joints[j].m[row][3]}));
    return most;
  };
  play(120);
  CHECK(off_m() < 3e-6);
  CHECK(stage.report().rods_asleep == 3);
  CHECK(stage.report().rod_iterations == 0);
  REQUIRE(stage.world.set_rod_parameters(stage.blocks[0], 0, {}).ok());
  play(60);
  CHECK(off_m() > 1e-3);
  CHECK(stage.report().rod_recoveries == 0);
  CHECK(stage.report().rod_iterations > 0);
}

// A node's displacement stays below the share of the baked limit, and vertices follow nodes.
TEST_CASE("what_is_shown_stays_below_the_share_of_the_largest_displacement") {
  pack::PackView view;
  REQUIRE(pack::open_pack(test::weightless_pack().bytes(), &view).ok());
  const double limit_m = double{view.regions[0].displacement_limit_m};
  const auto farthest_m = [](float displacement) {
    Stage stage(1, {}, test::weightless_pack());
    REQUIRE(stage.world.set_parameters(stage.blocks[0], {.displacement = displacement}).ok());
    double most = 0;
    for (int f = 0; f < 180; ++f) {
      stage.step([](double t) { return scenes::shake(t, 6); }, kFrame_s);
      if (f > kGlideFrames) most = std::max(most, test::largest_length(stage.read(0, Space::kBind)));
    }
    return most;
  };
  CHECK(farthest_m(0) == 0);
  CHECK(farthest_m(0.1f) < 0.1 * limit_m * 1.05);
  CHECK(farthest_m(0.1f) > 0.05 * limit_m);
  CHECK(farthest_m(4) > farthest_m(1));
}

TEST_CASE("no_sweep_from_extreme_to_extreme_makes_a_vertex_jump") {
  const scenes::PackBytes rods = scenes::soft_block({.network = false, .rods = scenes::RodMatter{}});
  // All at once of rods as soft as that: their bones turn by more than half a turn against their pose, of
  // which no share can be told without a step.
  const auto of_stiff_rods = [](Sweep sweep) {
    constexpr float kLeast = 0.3f;
    const bool all = std::string(sweep.name).starts_with("all");
    for (PartParameters* each : {&sweep.low, &sweep.high})
      if (all) each->stiffness = std::max(each->stiffness, kLeast);
    return sweep;
  };
  for (const double fps : {60.0, 240.0})
    for (const Sweep& sweep : sweeps()) {
      const double of_network = jump_ratio(test::block_pack(), sweep, fps),
                   of_rods = jump_ratio(rods, of_stiff_rods(sweep), fps);
      INFO(sweep.name << " at " << fps << " frames a second: " << of_network << ", with rods " << of_rods);
      CHECK(of_network < 1.5);
      CHECK(of_rods < 1.5);
    }
}

TEST_CASE("extremes_stay_finite_in_a_wild_motion") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  for (const float stiffness : {0.01f, 100.0f})
    for (const float damping : {0.0f, 100.0f}) {
      Stage stage(1, {}, pack);
      REQUIRE(stage.world.set_parameters(stage.blocks[0], {2, stiffness, damping, 4, true}).ok());
      for (int f = 1; f < 400; ++f) {
        const scenes::TailedPose pose = scenes::with_rods(scenes::shake(f * kFrame_s, 4));
        REQUIRE(stage.world.set_pose(stage.blocks[0], pose.pose()).ok());
        stage.world.step(static_cast<float>(kFrame_s));
        REQUIRE(test::all_finite(stage.read()));
      }
      INFO(stiffness << " " << damping);
      CHECK(stage.report().restarts == 0);
      CHECK(stage.report().fallbacks == 0);
      CHECK(stage.report().rod_recoveries == 0);
    }
}

TEST_CASE("a_change_wakes_who_is_dormant_and_it_falls_asleep_again") {
  Stage stage;
  const auto lean = [](double) { return scenes::bent_pose(0.5); };
  stage.play(lean, 6);
  REQUIRE(stage.report().dormant);
  const std::vector<float> before = stage.read();
  REQUIRE(stage.world.set_parameters(stage.blocks[0], {.stiffness = 0.5f}).ok());
  stage.play(lean, 1);
  CHECK(test::largest_distance(stage.read(), before) > 0.001);  // it hangs lower
  stage.play(lean, 8);
  CHECK(stage.report().dormant);
}

TEST_CASE("what_is_set_back_is_as_baked_again") {
  Stage stage;
  const auto lean = [](double) { return scenes::bent_pose(0.5); };
  stage.play(lean, 6);
  const std::vector<float> before = stage.read();
  REQUIRE(stage.world.set_parameters(stage.blocks[0], {2, 0.3f, 3, 2, true}).ok());
  stage.play(lean, 2);
  CHECK(test::largest_distance(stage.read(), before) > 0.001);
  REQUIRE(stage.world.set_parameters(stage.blocks[0], {}).ok());
  stage.play(lean, 8);
  CHECK(test::largest_distance(stage.read(), before) < 1e-4);  // as far as sleep has it
}

TEST_CASE("a_snapshot_in_the_midst_of_a_change_gives_the_same_bits_again") {
  const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  Stage stage(1, {}, pack), other(1, {}, pack);
  const auto played = [](Stage& on) {
    std::vector<uint64_t> hashes;
    for (int f = 0; f < 60; ++f) {
      on.time_s += 0.011;
      const scenes::TailedPose pose = scenes::with_rods(scenes::walk(on.time_s));
      REQUIRE(on.world.set_pose(on.blocks[0], pose.pose()).ok());
      on.world.step(0.011f);
      hashes.push_back(test::hash_of(on));
    }
    return hashes;
  };
  const PartParameters one{1.5f, 9, 0.2f, 0.5f, true}, two{0.5f, 0.1f, 5, 2, true}, off{1, 1, 1, 1, false};
  played(stage);
  REQUIRE(stage.world.set_parameters(stage.blocks[0], one).ok());
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 0, off).ok());
  REQUIRE(stage.world.set_rod_parameters(stage.blocks[0], 1, two).ok());
  for (int f = 0; f < 5; ++f) stage.world.step(0.011f);
  const std::vector<std::byte> saved = stage.save();
  const double time_s = stage.time_s;
  const std::vector<uint64_t> first = played(stage);
  REQUIRE(stage.world.set_parameters(stage.blocks[0], two).ok());
  REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 0, {}).ok());
  played(stage);
  for (Stage* on : {&stage, &other}) {
    REQUIRE(on->world.restore_state(on->blocks[0], saved).ok());
    on->time_s = time_s;
    CHECK(played(*on) == first);
  }
  PartParameters out;
  REQUIRE(other.world.rod_parameters(other.blocks[0], 1, &out).ok());
  CHECK(out.stiffness == 0.1f);
}

// The tick in which a stiffness arrives is retuned once more: nothing of the way there stays.
TEST_CASE("a_snapshot_long_after_a_change_gives_the_same_bits_again") {
  for (const float stiffness : {1.1f, 1.3f, 2.0f, 7.0f, 20.0f, 100.0f}) {
    CAPTURE(stiffness);
    Stage stage(1, {}, test::weightless_pack());
    REQUIRE(stage.world.set_region_parameters(stage.blocks[0], 0, {.stiffness = stiffness}).ok());
    stage.play(scenes::walk, 2);
    const std::vector<std::byte> state = stage.save();
    const double then_s = stage.time_s;
    stage.play(scenes::walk, 0.5);
    const std::vector<float> went_on = stage.read();
    REQUIRE(stage.world.restore_state(stage.blocks[0], state).ok());
    stage.time_s = then_s;
    stage.play(scenes::walk, 0.5);
    CHECK(stage.read() == went_on);
  }
}

TEST_CASE("bounds_follow_what_may_be_shown") {
  const scenes::PackBytes tight = scenes::soft_block({.displacement_limit = 0.2, .network = false});
  Stage stage(1, {}, tight);
  stage.play(scenes::walk, 0.5);
  Bounds before, after;
  REQUIRE(stage.world.bounds(stage.blocks[0], &before).ok());
  REQUIRE(stage.world.set_parameters(stage.blocks[0], {.displacement = 4}).ok());
  REQUIRE(stage.world.bounds(stage.blocks[0], &after).ok());
  CHECK(after.radius_m > before.radius_m);
}

// test_environment.cpp  Gravity, an acceleration from outside and wind, set by an engine between steps.
#include <limits>
#include <numbers>
#include <string>

#include "tests/world/stage.hpp"

using namespace sinew;
using scenes::kTail;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kGravity = 9.80665f;

const scenes::PackBytes& whole_pack() {  // a network and rods
  static const scenes::PackBytes pack = scenes::soft_block({.rods = scenes::RodMatter{}});
  return pack;
}

void step_pose(Stage& stage, const scenes::TailedPose& pose, double dt_s = kFrame_s) {
  REQUIRE(
      stage.world.set_pose(stage.blocks[0], {std::span(pose.joints).first(stage.info.joint_count), pose.root})
          .ok());
  stage.world.step(static_cast<float>(dt_s));
}

void stand(Stage& stage, double seconds) {
  for (int f = 0; f < std::lround(seconds * 60); ++f)
    step_pose(stage, scenes::with_rods(scenes::bind_pose()));
}

std::vector<uint64_t> walked(Stage& stage, int frames, double dt_s = 0.011) {
  std::vector<uint64_t> hashes;
  for (int f = 0; f < frames; ++f) {
    stage.time_s += dt_s;
    step_pose(stage, scenes::with_rods(scenes::walk(stage.time_s)), dt_s);
    hashes.push_back(test::hash_of(stage));
  }
  return hashes;
}

// Of the tail's end against its pose.
std::array<double, 3> tail_moved(const Stage& stage) {
  std::vector<Matrix34> joints(stage.info.joint_count);
  REQUIRE(stage.world.read_joint_matrices(stage.blocks[0], joints).ok());
  const scenes::TailedPose pose = scenes::with_rods(scenes::bind_pose());
  std::array<double, 3> moved;
  for (size_t k = 0; k < 3; ++k)
    moved[k] = static_cast<double>(joints[kTail + 3].m[k][3] - pose.joints[kTail + 3].m[k][3]);
  return moved;
}

// Mean of flesh's displacement, bind pose.
std::array<double, 3> flesh_moved(const Stage& stage) {
  const std::vector<float> delta = stage.read(0, Space::kBind);
  std::array<double, 3> sum{};
  for (size_t i = 0; i < delta.size(); ++i) sum[i % 3] += static_cast<double>(delta[i]);
  for (double& each : sum) each /= static_cast<double>(delta.size() / 3);
  return sum;
}

Environment gravity(float x, float y, float z) { return {.gravity_m_s2 = {x, y, z}}; }
Environment wind(float x, float z, float gust = 0) {
  return {.wind = {.velocity_m_s = {x, 0, z}, .gust = gust}};
}

struct Bad {
  const char* name;
  Environment environment;
  StatusCode code;
};

std::vector<Bad> bad_environments() {
  std::vector<Bad> all;
  for (const float value : {kNan, 2e4f, -INFINITY}) {
    const StatusCode code = std::isnan(value) ? StatusCode::kNotFinite : StatusCode::kInvalidArgument;
    for (int k = 0; k < 3; ++k) {
      Environment g, a, w;
      g.gravity_m_s2[k] = a.acceleration_m_s2[k] = w.wind.velocity_m_s[k] = value;
      all.push_back({"gravity_m_s2", g, code});
      all.push_back({"acceleration_m_s2", a, code});
      all.push_back({"velocity_m_s", w, code});
    }
    Environment gust, hz;
    gust.wind.gust = hz.wind.gust_hz = value;
    all.push_back({"gust", gust, code});
    all.push_back({"gust_hz", hz, code});
  }
  Environment none_hz;
  none_hz.wind.gust_hz = 0;
  all.push_back({"gust_hz", none_hz, StatusCode::kInvalidArgument});
  return all;
}

}  // namespace

TEST_CASE("an_environment_that_is_none_is_refused_and_changes_nothing") {
  Stage stage(1, {}, whole_pack());
  World& world = stage.world;
  const InstanceId block = stage.blocks[0];
  REQUIRE(world.set_environment(gravity(1, 2, 3)).ok());
  walked(stage, 10);
  const std::vector<std::byte> before = stage.save();
  for (const Bad& bad : bad_environments()) {
    INFO(bad.name);
    const Status status = world.set_environment(bad.environment);
    CHECK(status.code == bad.code);
    CHECK(std::string(status.message).find(bad.name) != std::string::npos);
  }
  AddedEnvironment added;
  added.wind_m_s[2] = kNan;
  CHECK(world.set_added_environment(block, added).code == StatusCode::kNotFinite);
  added = {.acceleration_m_s2 = {0, 1e6f, 0}};
  CHECK(world.set_added_environment(block, added).code == StatusCode::kInvalidArgument);
  CHECK(world.set_added_environment({}, {}).code == StatusCode::kStaleId);
  CHECK(world.added_environment({}, &added).code == StatusCode::kStaleId);
  CHECK(stage.faults.faults == 2);
  CHECK(world.added_environment(block, nullptr).code == StatusCode::kInvalidArgument);
  CHECK(world.environment(nullptr).code == StatusCode::kInvalidArgument);
  Environment out;
  REQUIRE(world.environment(&out).ok());
  CHECK(out.gravity_m_s2[2] == 3);
  CHECK(stage.save() == before);
  World null;
  CHECK(null.set_environment({}).code == StatusCode::kInvalidArgument);
  CHECK(null.environment(&out).code == StatusCode::kInvalidArgument);
}

TEST_CASE("an_environment_that_is_the_usual_one_gives_the_bits_of_none") {
  Stage set(1, {}, whole_pack()), never(1, {}, whole_pack());
  REQUIRE(set.world.set_environment({}).ok());
  REQUIRE(set.world.set_added_environment(set.blocks[0], {}).ok());
  CHECK(walked(set, 200) == walked(never, 200));
  CHECK(set.save() == never.save());
}

// Modes are linear and their load is the same: what differs is how far frames turn it in floats.
TEST_CASE("another_gravity_is_what_a_turned_root_makes_of_the_usual_one") {
  for (const float angle : {0.5f, 1.5f, std::numbers::pi_v<float>}) {
    Stage turned(1, {}, test::weightless_pack()), other(1, {}, test::weightless_pack());
    scenes::BlockPose pose = scenes::bind_pose();
    pose.root.rotation_xyzw[2] = std::sin(angle / 2);
    pose.root.rotation_xyzw[3] = std::cos(angle / 2);
    REQUIRE(other.world.set_environment(gravity(-kGravity * std::sin(angle), -kGravity * std::cos(angle), 0))
                .ok());
    turned.play([&](double) { return pose; }, 5);
    other.play([](double) { return scenes::bind_pose(); }, 5);
    CHECK(test::largest_length(turned.read(0, Space::kBind)) > 0.005);
    CHECK(test::largest_distance(turned.read(0, Space::kBind), other.read(0, Space::kBind)) < 2e-5);
  }
}

TEST_CASE("upside_down_gravity_lets_flesh_and_rods_hang_the_other_way") {
  Stage stage(1, {}, whole_pack());
  stand(stage, 2);
  CHECK(std::abs(flesh_moved(stage)[1]) < 1e-6);
  REQUIRE(stage.world.set_environment(gravity(0, kGravity, 0)).ok());
  stand(stage, 4);
  CHECK(flesh_moved(stage)[1] > 0.001);
  CHECK(tail_moved(stage)[1] > 0.02);
  REQUIRE(stage.world.set_environment(gravity(0, 0, 0)).ok());
  stand(stage, 4);
  CHECK(flesh_moved(stage)[1] > 0.0005);
  CHECK(tail_moved(stage)[1] > 0.01);
  REQUIRE(stage.world.set_environment({}).ok());
  stand(stage, 12);
  CHECK(std::abs(flesh_moved(stage)[1]) < 1e-5);
  CHECK(std::abs(tail_moved(stage)[1]) < 1e-3);
}

// Of a root that has accelerated at 3 m/s^2 for four seconds.
TEST_CASE("an_acceleration_is_what_a_root_that_accelerates_the_other_way_makes_felt") {
  constexpr double kRate_m_s2 = 3;
  Stage root(1, {}, test::tailed_pack()), outside(1, {}, test::tailed_pack());
  REQUIRE(outside.world.set_environment({.acceleration_m_s2 = {static_cast<float>(kRate_m_s2), 0, 0}}).ok());
  for (int f = 1; f <= 240; ++f) {
    const double t = f * kFrame_s;
    step_pose(root, scenes::with_rods(scenes::bent_pose(0, -kRate_m_s2 / 2 * t * t)));
    step_pose(outside, scenes::with_rods(scenes::bind_pose()));
  }
  CHECK(flesh_moved(outside)[0] > 0.001);
  CHECK(flesh_moved(root)[0] == Approx(flesh_moved(outside)[0]).epsilon(0.01));
  CHECK(tail_moved(outside)[0] > 0.01);
  // The moving rod's own drag, 0.5 a second, holds it back as well.
  CHECK(tail_moved(root)[0] > tail_moved(outside)[0]);
}

TEST_CASE("what_is_added_to_one_instance_sums_with_its_world_s") {
  const Environment both{.acceleration_m_s2 = {1, 2, 3}, .wind = {.velocity_m_s = {4, 0, 5}, .gust = 0.5f}};
  const Environment part{.acceleration_m_s2 = {1, 0, 1}, .wind = {.velocity_m_s = {2, 0, 5}, .gust = 0.5f}};
  const AddedEnvironment rest{.acceleration_m_s2 = {0, 2, 2}, .wind_m_s = {2, 0, 0}};
  Stage one(1, {}, whole_pack()), two(1, {}, whole_pack());
  REQUIRE(one.world.set_environment(both).ok());
  REQUIRE(two.world.set_environment(part).ok());
  REQUIRE(two.world.set_added_environment(two.blocks[0], rest).ok());
  CHECK(walked(one, 100) == walked(two, 100));
  AddedEnvironment out;
  REQUIRE(two.world.added_environment(two.blocks[0], &out).ok());
  CHECK(out.wind_m_s[0] == 2);
}

TEST_CASE("wind_blows_a_tail_and_flesh_downwind") {
  for (const float side : {1.0f, -1.0f}) {
    Stage stage(1, {}, test::tailed_pack());
    REQUIRE(stage.world.set_environment(wind(8 * side, 0)).ok());
    stand(stage, 5);
    CHECK(double{side} * tail_moved(stage)[0] > 0.005);
    CHECK(double{side} * flesh_moved(stage)[0] > 1e-5);
    CHECK(double{side} * flesh_moved(stage)[0] < 1e-3);
  }
}

TEST_CASE("gusts_come_and_go_and_are_the_same_again_and_in_a_rollback") {
  Stage first(1, {}, whole_pack()), second(1, {}, whole_pack());
  for (Stage* stage : {&first, &second}) REQUIRE(stage->world.set_environment(wind(6, 3, 1)).ok());
  CHECK(walked(first, 150) == walked(second, 150));
  const std::vector<std::byte> saved = first.save();
  const double time_s = first.time_s;
  const std::vector<uint64_t> after = walked(first, 100);
  walked(first, 33);
  REQUIRE(first.world.restore_state(first.blocks[0], saved).ok());
  first.time_s = time_s;
  CHECK(walked(first, 100) == after);
  // A tail that stands in a steady wind stands still; in gusts it does not.
  const auto spread_m = [](float gust) {
    Stage stage(1, {}, test::tailed_pack());
    REQUIRE(stage.world.set_environment(wind(8, 0, gust)).ok());
    stand(stage, 12);
    double least = 1, most = -1;
    for (int f = 0; f < 240; ++f) {
      stand(stage, kFrame_s);
      least = std::min(least, tail_moved(stage)[0]);
      most = std::max(most, tail_moved(stage)[0]);
    }
    return most - least;
  };
  CHECK(spread_m(0) < 1e-3);
  CHECK(spread_m(0.8f) > 5e-3);
}

TEST_CASE("a_gust_reaches_who_stands_upwind_first") {
  Stage upwind(1, {}, test::tailed_pack()), downwind(1, {}, test::tailed_pack());
  std::vector<double> at_upwind, at_downwind;
  for (Stage* stage : {&upwind, &downwind}) {
    const bool far = stage == &downwind;
    REQUIRE(stage->world.set_environment(wind(8, 0, 1)).ok());
    for (int f = 0; f < 600; ++f) {
      scenes::BlockPose pose = scenes::bind_pose();
      pose.root.position_m[0] = far ? 4 : 0;  // half a second behind
      step_pose(*stage, scenes::with_rods(pose));
      (far ? at_downwind : at_upwind).push_back(tail_moved(*stage)[0]);
    }
  }
  double most = 0, off = 0;
  for (size_t f = 300; f < 600; ++f) {
    most = std::max(most, std::abs(at_upwind[f] - at_upwind[f - 30]));
    off = std::max(off, std::abs(at_downwind[f] - at_upwind[f - 30]));
  }
  CHECK(most > 5e-3);
  CHECK(off < 0.1 * most);
}

TEST_CASE("flesh_and_rods_fall_asleep_under_another_gravity_and_wake_when_it_changes") {
  Stage stage(1, {.sleep_tolerance = 1e-3f}, whole_pack());
  REQUIRE(stage.world.set_environment(gravity(3, -5, 0)).ok());
  stand(stage, 20);
  CHECK(stage.report().dormant);
  const std::vector<float> before = stage.read();
  REQUIRE(stage.world.set_environment(gravity(-3, -5, 0)).ok());
  CHECK(!stage.report().dormant);
  stand(stage, 1);
  CHECK(test::largest_distance(stage.read(), before) > 0.002);
  stand(stage, 20);
  CHECK(stage.report().dormant);
}

TEST_CASE("no_change_of_the_environment_makes_a_vertex_jump") {
  const Environment low{.gravity_m_s2 = {0, -20, 0},
                        .acceleration_m_s2 = {-10, 0, 0},
                        .wind = {.velocity_m_s = {-15, 0, 0}, .gust = 1}},
      high{.gravity_m_s2 = {0, 20, 0},
           .acceleration_m_s2 = {10, 0, 10},
           .wind = {.velocity_m_s = {15, 0, 5}, .gust = 0, .gust_hz = 2}};
  const auto largest_step_m = [](double fps, const Environment& one, const Environment& other) {
    Stage stage(1, {}, whole_pack());
    double largest = 0;
    std::vector<float> last;
    for (int f = 0; f < static_cast<int>(8 * fps); ++f) {
      const bool now = static_cast<int>(f / fps / 0.8) % 2 == 1;
      REQUIRE(stage.world.set_environment(now ? one : other).ok());
      step_pose(stage, scenes::with_rods(scenes::walk(f / fps)), 1 / fps);
      std::vector<float> moved = stage.read();
      if (f > fps) largest = std::max(largest, test::largest_distance(moved, last));
      last = std::move(moved);
    }
    return largest;
  };
  for (const double fps : {60.0, 240.0}) {
    const double steady_m = std::max(
        {largest_step_m(fps, {}, {}), largest_step_m(fps, low, low), largest_step_m(fps, high, high)});
    const double swept_m = largest_step_m(fps, low, high);
    INFO(swept_m / steady_m);
    CHECK(swept_m < 1.5 * steady_m);
  }
}

TEST_CASE("who_is_made_in_an_environment_begins_in_it") {
  Stage stage(0, {}, whole_pack());
  REQUIRE(stage.world.set_environment(gravity(0, kGravity, 0)).ok());
  stage.add();
  Stage later(1, {}, whole_pack());
  REQUIRE(later.world.set_environment(gravity(0, kGravity, 0)).ok());
  for (Stage* each : {&stage, &later}) stand(*each, 5);
  CHECK(flesh_moved(stage)[1] == Approx(flesh_moved(later)[1]).epsilon(0.01));
}

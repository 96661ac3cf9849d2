// test_rod_state.cpp  A batch put into poses, turned, given other rest shapes, saved and restored.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "rods/rod_batch.hpp"

using namespace sinew;
using namespace sinew::rods;

namespace {

constexpr float kStep_s = 1.0f / 60;

std::vector<SegmentDef> chain(uint32_t segments) {
  std::vector<SegmentDef> out(segments);
  for (uint32_t i = 0; i < segments; ++i) {
    out[i].position_m[2] = 0.1 * i;
    out[i].length_m = 0.1f;
    out[i].radius_m = 0.01f;
    out[i].parent = i == 0 ? kNoParent : i - 1;
    out[i].fixed = i == 0;
  }
  return out;
}

RodBatch make_batch(uint32_t strands, uint32_t segments, const RodSettings& settings = {}) {
  const std::vector<SegmentDef> defs = chain(segments);
  const std::vector<StrandDef> all(strands, StrandDef{defs});
  RodBatch batch;
  REQUIRE(RodBatch::create(all, settings, &batch).ok());
  return batch;
}

void step(RodBatch& batch, int steps) {
  for (int s = 0; s < steps; ++s) REQUIRE(batch.step(kStep_s, nullptr).ok());
}

std::vector<std::byte> saved(const RodBatch& batch) {
  std::vector<std::byte> out(batch.state_bytes());
  batch.save_state(out.data());
  return out;
}

double distance(const RodBatch& a, const RodBatch& b, uint32_t strand, uint32_t segment) {
  const SegmentPose p = a.pose(strand, segment), q = b.pose(strand, segment);
  return std::hypot(p.position_m[0] - q.position_m[0], p.position_m[1] - q.position_m[1],
                    p.position_m[2] - q.position_m[2]);
}

}  // namespace

TEST_CASE("placing_and_bending_refuse_what_is_not_there_or_no_number") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  RodBatch batch = make_batch(2, 4);
  const std::vector<std::byte> before = saved(batch);
  SegmentPose pose = batch.pose(0, 1);
  CHECK(batch.set_pose(2, 1, pose, {}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_pose(0, 4, pose, {}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_pose(0, 1, pose, {{kNan, 0, 0}, {0, 0, 0}}).code == StatusCode::kNotFinite);
  pose.orientation[3] = 2;
  CHECK(batch.set_pose(0, 1, pose, {}).code == StatusCode::kInvalidArgument);
  pose.orientation[3] = kNan;
  CHECK(batch.set_pose(0, 1, pose, {}).code == StatusCode::kNotFinite);
  pose = batch.pose(0, 1);
  pose.position_m[1] = 1e300;
  CHECK(batch.set_pose(0, 1, pose, {}).code == StatusCode::kNotFinite);
  CHECK(batch.set_rest(0, 0, {0, 0, 0, 1}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_rest(0, 9, {0, 0, 0, 1}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_rest(0, 1, {0, 0, 0, 0.5f}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_rest(0, 1, {kNan, 0, 0, 1}).code == StatusCode::kNotFinite);
  CHECK(saved(batch) == before);
}

TEST_CASE("after_a_restore_the_same_steps_give_the_same_bits") {
  // Narrow and wide groups, whole and partial; the second start remembers steps.
  const std::pair<uint32_t, RodStart> cases[] = {{1, RodStart::kPrevious},
                                                 {3, RodStart::kContinued},
                                                 {19, RodStart::kPrevious},
                                                 {19, RodStart::kContinued}};
  for (const auto& [strands, start] : cases) {
    RodSettings settings;
    settings.start = start;
    RodBatch batch = make_batch(strands, 6, settings), other = make_batch(strands, 6, settings);
    step(batch, 20);
    const std::vector<std::byte> state = saved(batch);
    step(batch, 20);
    const std::vector<std::byte> later = saved(batch);
    CHECK(later != state);
    batch.restore_state(state.data());
    other.restore_state(state.data());
    CHECK(saved(batch) == state);
    step(batch, 20);
    step(other, 20);
    CHECK(saved(batch) == later);
    CHECK(saved(other) == later);
  }
}

TEST_CASE("a_placed_segment_is_there_and_moves_so") {
  RodBatch batch = make_batch(1, 4);
  step(batch, 10);
  const SegmentPose pose = {{1, 2, 3}, {0, std::sqrt(0.5f), 0, std::sqrt(0.5f)}};
  const SegmentVelocity velocity = {{0.5f, -1, 2}, {3, 1, -2}};
  REQUIRE(batch.set_pose(0, 2, pose, velocity).ok());
  const SegmentPose got = batch.pose(0, 2);
  const SegmentVelocity moves = batch.velocity(0, 2);
  for (int k = 0; k < 3; ++k) {
    CHECK(got.position_m[k] == Approx(pose.position_m[k]).margin(1e-12));  // two floats
    CHECK(moves.linear_m_s[k] == Approx(velocity.linear_m_s[k]).epsilon(1e-5));
    CHECK(moves.angular_rad_s[k] == Approx(velocity.angular_rad_s[k]).epsilon(1e-5));
  }
  for (int k = 0; k < 4; ++k) CHECK(got.orientation[k] == Approx(pose.orientation[k]).margin(1e-6));
  for (const float force : batch.last_forces(0, 2).force_n) CHECK(force == 0);
}

TEST_CASE("a_strand_put_into_a_pose_starts_as_a_new_one_whatever_it_did_before") {
  const RodSettings settings = {.start = RodStart::kContinued, .max_iterations = 1, .tolerance_rad = 1};
  RodBatch fresh = make_batch(1, 6, settings), moved = make_batch(1, 6, settings);
  const std::vector<SegmentDef> defs = chain(6);
  step(moved, 20);
  for (uint32_t i = 0; i < 6; ++i) {
    SegmentPose pose{{}, {0, 0, 0, 1}};
    std::copy_n(defs[i].position_m, 3, pose.position_m);
    REQUIRE(moved.set_pose(0, i, pose, {}).ok());
  }
  // One iteration, held to be enough, does not reach the answer: what it started from is seen.
  step(fresh, 1);
  step(moved, 1);
  for (uint32_t i = 0; i < 6; ++i) CHECK(distance(fresh, moved, 0, i) == 0);
}

TEST_CASE("a_joint_goes_to_the_rest_it_is_given") {
  RodSettings weightless;
  weightless.gravity_m_s2[1] = 0;
  RodBatch batch = make_batch(1, 3, weightless);
  const float angle = 0.6f, half[4] = {std::sin(angle / 2), 0, 0, std::cos(angle / 2)};
  const float negated[4] = {-half[0], 0, 0, -half[3]};  // the same rotation
  REQUIRE(batch.set_rest(0, 1, half).ok());
  REQUIRE(batch.set_rest(0, 2, negated).ok());
  step(batch, 1200);  // implicit Euler takes the swing's energy
  for (uint32_t s = 1; s < 3; ++s) {
    const SegmentPose pose = batch.pose(0, s);
    const double turned = 2 * std::atan2(std::abs(static_cast<double>(pose.orientation[0])),
                                         std::abs(static_cast<double>(pose.orientation[3])));
    CHECK(turned == Approx(s * 0.6).margin(0.01));  // RodSettings::tolerance_rad
  }
}

TEST_CASE("turning_all_turns_what_follows") {
  RodBatch a = make_batch(2, 5), b = make_batch(2, 5);
  step(a, 15);
  step(b, 15);
  const double h = std::sqrt(0.5);
  b.turn_all({0, 0, h, h}, {0, 0, 0});
  for (uint32_t s = 0; s < 5; ++s) {
    const SegmentPose p = a.pose(1, s), q = b.pose(1, s);
    CHECK(q.position_m[0] == Approx(-p.position_m[1]).margin(1e-9));
    CHECK(q.position_m[1] == Approx(p.position_m[0]).margin(1e-9));
    CHECK(q.position_m[2] == Approx(p.position_m[2]).margin(1e-9));
    const SegmentVelocity v = a.velocity(1, s), w = b.velocity(1, s);
    CHECK(w.linear_m_s[0] == Approx(-v.linear_m_s[1]).margin(1e-5));
    CHECK(w.angular_rad_s[0] == Approx(-v.angular_rad_s[1]).margin(1e-4));
  }
  b.turn_all({0, 0, -h, h}, {0, 0, 0});  // and back
  step(a, 15);
  step(b, 15);
  for (uint32_t s = 0; s < 5; ++s) CHECK(distance(a, b, 1, s) < 1e-4);  // floats turned twice
}

TEST_CASE("memory_is_told_before_a_batch_is_made") {
  CHECK(RodBatch::memory_bytes(1, 2, {}) > 0);
  CHECK(RodBatch::memory_bytes(17, 8, {}) > RodBatch::memory_bytes(16, 8, {}));
  CHECK(RodBatch::memory_bytes(2, 9, {}) > RodBatch::memory_bytes(2, 8, {}));
}

TEST_CASE("a_rest_is_told_from_the_parent_whichever_end_is_held") {
  std::vector<SegmentDef> defs = chain(3);
  defs[0].fixed = false;
  defs[2].fixed = true;  // the batch counts its joints from there
  const StrandDef strand{defs};
  RodSettings weightless;
  weightless.gravity_m_s2[1] = 0;
  RodBatch batch;
  REQUIRE(RodBatch::create({&strand, 1}, weightless, &batch).ok());
  const float half[4] = {std::sin(0.3f), 0, 0, std::cos(0.3f)};
  REQUIRE(batch.set_rest(0, 1, half).ok());
  step(batch, 1200);
  // Segment 1 goes on with the held one; 0 is turned back from it.
  const SegmentPose pose = batch.pose(0, 0);
  CHECK(2 * std::atan2(pose.orientation[0], pose.orientation[3]) == Approx(-0.6).margin(0.01));
}

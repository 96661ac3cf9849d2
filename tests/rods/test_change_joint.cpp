// test_change_joint.cpp  Joints stiffer or damped otherwise than they were made.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "rods/rod_batch.hpp"

using namespace sinew;
using rods::RodBatch;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Four segments along x, the first held, without gravity.
RodBatch make_chain() {
  std::vector<rods::SegmentDef> segments(4);
  for (uint32_t i = 0; i < segments.size(); ++i) {
    rods::SegmentDef& s = segments[i];
    s.position_m[0] = 0.1 * (i + 0.5);
    s.orientation[1] = s.orientation[3] = std::sqrt(0.5f);
    s.length_m = 0.1f;
    s.radius_m = 0.01f;
    s.parent = i == 0 ? rods::kNoParent : i - 1;
    s.fixed = i == 0;
    s.damping_s = 0.1f;
  }
  const rods::StrandDef strand{segments};
  RodBatch batch;
  const Status status = RodBatch::create({&strand, 1}, {.gravity_m_s2 = {0, 0, 0}}, &batch);
  INFO(status.message);
  REQUIRE(status.ok());
  return batch;
}

// How far its end hangs under a small force after so many steps.
double sag_m(RodBatch& batch, int steps) {
  REQUIRE(batch.set_force(0, 3, {0, -0.001f, 0}).ok());
  for (int k = 0; k < steps; ++k) REQUIRE(batch.step(1.0f / 60, nullptr).ok());
  return -batch.pose(0, 3).position_m[1];
}

}  // namespace

TEST_CASE("a_change_of_a_joint_that_is_none_is_refused_and_changes_nothing") {
  RodBatch batch = make_chain(), untouched = make_chain();
  for (const float bad : {0.0f, -1.0f, 1e-45f})
    CHECK(batch.set_joint(0, 1, {.stiffness = bad}).code == StatusCode::kInvalidArgument);
  for (const float bad : {kNan, INFINITY}) {
    CHECK(batch.set_joint(0, 1, {.stiffness = bad}).code == StatusCode::kNotFinite);
    CHECK(batch.set_joint(0, 1, {.damping = bad}).code == StatusCode::kNotFinite);
  }
  CHECK(batch.set_joint(0, 1, {.damping = -1}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_joint(0, 0, {}).code == StatusCode::kInvalidArgument);  // the root
  CHECK(batch.set_joint(0, 4, {}).code == StatusCode::kInvalidArgument);
  CHECK(batch.set_joint(1, 1, {}).code == StatusCode::kInvalidArgument);
  CHECK(sag_m(batch, 30) == sag_m(untouched, 30));
}

TEST_CASE("a_joint_four_times_as_stiff_gives_a_quarter_and_back_again_what_it_gave") {
  RodBatch usual = make_chain(), stiff = make_chain();
  for (uint32_t s = 1; s < 4; ++s) REQUIRE(stiff.set_joint(0, s, {.stiffness = 4}).ok());
  const double usual_m = sag_m(usual, 600), stiff_m = sag_m(stiff, 600);
  CHECK(usual_m > 1e-4);
  CHECK(stiff_m == Approx(usual_m / 4).epsilon(0.01));
  for (uint32_t s = 1; s < 4; ++s) REQUIRE(stiff.set_joint(0, s, {}).ok());
  CHECK(sag_m(stiff, 600) == Approx(usual_m).epsilon(0.001));
}

TEST_CASE("a_joint_that_is_damped_more_gives_later") {
  RodBatch usual = make_chain(), damped = make_chain();
  for (uint32_t s = 1; s < 4; ++s) REQUIRE(damped.set_joint(0, s, {.damping = 20}).ok());
  CHECK(sag_m(damped, 10) < 0.5 * sag_m(usual, 10));
}

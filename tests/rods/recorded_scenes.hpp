// recorded_scenes.hpp  Rods whose bits are recorded.
#pragma once
#include "tests/rods/contact_scenes.hpp"

namespace sinew::test {

// Pose and linear velocity of a segment.
inline void append_motion(const RodBatch& batch, uint32_t strand, uint32_t segment, std::vector<float>* out) {
  const rods::SegmentPose pose = batch.pose(strand, segment);
  for (const double x : pose.position_m) out->push_back(static_cast<float>(x));
  out->insert(out->end(), std::begin(pose.orientation), std::end(pose.orientation));
  const rods::SegmentVelocity v = batch.velocity(strand, segment);
  out->insert(out->end(), std::begin(v.linear_m_s), std::end(v.linear_m_s));
}

// Poses, velocities and forces of a strand.
inline void append_state(const RodBatch& batch, uint32_t strand, std::vector<float>* out) {
  for (uint32_t i = 0; i < batch.segment_count(); ++i) {
    append_motion(batch, strand, i, out);
    const rods::SegmentStart joint = batch.last_forces(strand, i);
    out->insert(out->end(), std::begin(joint.force_n), std::end(joint.force_n));
    out->insert(out->end(), std::begin(joint.moment_nm), std::end(joint.moment_nm));
  }
}

// Of narrow groups and wide, chains and trees, the last strand after 20 steps.
inline void append_bent(const RodSettings& settings, std::vector<float>* out) {
  for (const auto& shape : {helix(9, 0.1, 1e4f), branched_rod(4, 1, 1e6f)}) {
    for (const size_t count : {3u, 18u}) {
      RodBatch batch = batch_of(std::vector<Segments>(count, shape), settings);
      for (int i = 0; i < 20; ++i) step(batch, 0.02f);
      append_state(batch, static_cast<uint32_t>(count - 1), out);
    }
  }
}

// Poses and velocities of all strands.
inline void append_states(const RodBatch& batch, std::vector<float>* out) {
  for (uint32_t s = 0; s < batch.strand_count(); ++s) {
    for (uint32_t i = 0; i < batch.segment_count(); ++i) {
      append_motion(batch, s, i, out);
      const rods::SegmentVelocity v = batch.velocity(s, i);
      out->insert(out->end(), std::begin(v.angular_rad_s), std::end(v.angular_rad_s));
    }
  }
}

// Rods that fall on one another, a floor, a ball and a bar that turns: `count` of them, 40 steps.
inline std::vector<float> state_after_falling(const RodSettings& settings, bool rods_collide, int count) {
  std::vector<Segments> strands;
  for (int i = 0; i < count; ++i) {
    strands.push_back(i % 2 ? crossing_rod(0.1 + 0.05 * i, 0.025 + 0.021 * i, 7)
                            : lying_rod(0.025 + 0.021 * i, 7));
  }
  RodBatch batch = batch_of(strands, settings);
  rods::RodCollider collider = collider_of(batch, {.rods_collide = rods_collide});
  const rods::Plane floor = {.friction = 0.4f};
  const rods::Sphere ball = {.middle_m = {0.5, 0.02, 0.1}, .radius_m = 0.06f};
  const rods::Capsule bar = {
      .ends_m = {{0.2, 0, -1}, {0.2, 0.1, 1}}, .radius_m = 0.03f, .motion = {.angular_rad_s = {0, 0, 2}}};
  REQUIRE((collider.set_planes({&floor, 1}).ok() && collider.set_spheres({&ball, 1}).ok()));
  REQUIRE(collider.set_capsules({&bar, 1}).ok());
  for (int i = 0; i < 40; ++i) step(batch, collider);
  std::vector<float> out;
  append_states(batch, &out);
  return out;
}

// With and without contacts among rods, in narrow groups and wide.
inline void append_fallen(const RodSettings& settings, std::vector<float>* out) {
  for (const bool rods_collide : {false, true}) {
    for (const int count : {3, 18}) {
      const std::vector<float> state = state_after_falling(settings, rods_collide, count);
      out->insert(out->end(), state.begin(), state.end());
    }
  }
}

}  // namespace sinew::test

// ropes_in_bullet.hpp  A rope among the bodies of a Bullet world: laid over a bar that moves, wound on a
// drum.
#pragma once
#include <algorithm>
#include <numbers>

#include "adapters/bullet/touch.hpp"
#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"
#include "sinew/bullet.hpp"
#include "tests/scenes/bullet_world.hpp"
#include "tests/scenes/rod_through.hpp"

namespace sinew::test {

struct RopeMatter {
  float radius_m = 0.015f;
  float density_kg_m3 = 900;
  float young_pa = 2e5f;
  float damping_s = 0.02f;
  float drag_per_s = 0.1f;
};

inline rods::SegmentDef rope_segment(const RopeMatter& m) {
  rods::SegmentDef like;
  like.radius_m = m.radius_m;
  like.density_kg_m3 = m.density_kg_m3;
  like.young_modulus_pa = like.torsion_modulus_pa = m.young_pa;
  like.damping_s = m.damping_s;
  like.drag_per_s = m.drag_per_s;
  return like;
}

// Straight, `segments` between two points.
inline std::vector<Eigen::Vector3d> straight_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                                  uint32_t segments) {
  std::vector<Eigen::Vector3d> out;
  for (uint32_t i = 0; i <= segments; ++i) out.push_back(from + (to - from) * i / segments);
  return out;
}

// A rope, or several of as many segments, and what finds its contacts. What the rope looks at has to stay
// where it is.
struct RopeInBullet {
  std::vector<rods::SegmentDef> segments;
  std::vector<std::vector<rods::SegmentDef>> others;  // beside the first
  rods::RodBatch batch;
  rods::RodCollider collider;
  BulletContacts contacts;

  Status create(const BulletDef& def, bool rods_collide, const rods::RodSettings& settings = {}) {
    std::vector<rods::StrandDef> strands = {{segments}};
    for (const std::vector<rods::SegmentDef>& other : others) strands.push_back({other});
    Status status = rods::RodBatch::create(strands, settings, &batch);
    const auto room = static_cast<uint32_t>(8 * segments.size() * strands.size());
    const rods::ColliderSettings touching{.rods_collide = rods_collide, .source_capacity = room};
    if (status.ok()) status = rods::RodCollider::create(batch, touching, &collider);
    if (status.ok()) status = BulletContacts::create(def, &contacts);
    if (status.ok()) status = collider.set_source(&contacts);
    return status;
  }
};

inline bullet::Axis axis_of_segment(const rods::RodBatch& batch, const rods::SegmentDef& def, uint32_t index,
                                    uint32_t strand = 0) {
  const rods::SegmentPose pose = batch.pose(strand, index);
  const rods::Vector along = rods::turned(rods::turn_of(pose.orientation), {0, 0, 1});
  const rods::Vector middle = {pose.position_m[0], pose.position_m[1], pose.position_m[2]};
  const double half = 0.5 * static_cast<double>(def.length_m);
  return {rods::scaled_sum(-half, along, middle), rods::scaled_sum(half, along, middle)};
}

// How deep an axis' capsule is in a convex body, as geometry has it; negative: away from it.
inline double depth_m(const bullet::Axis& axis, double radius_m, const btRigidBody& body) {
  const auto& shape = static_cast<const btConvexShape&>(*body.getCollisionShape());
  const bullet::Place place = bullet::place_of(body.getWorldTransform());
  const bullet::Axis own = {place.own_point(axis.from), place.own_point(axis.to)};
  return radius_m - bullet::nearest(bullet::convex_of(shape), own, 1e-3 * radius_m).distance.m;
}

// Of all free segments, share of the radius.
inline double deepest(const RopeInBullet& rope, const btRigidBody& body) {
  double out = -1e9;
  for (uint32_t i = 0; i < rope.segments.size(); ++i) {
    if (rope.segments[i].fixed) continue;
    const auto radius = static_cast<double>(rope.segments[i].radius_m);
    out = std::max(out, depth_m(axis_of_segment(rope.batch, rope.segments[i], i), radius, body) / radius);
  }
  return out;
}

// Where a driven body is: to and fro along x, and turned about its own axis, which is the world's z.
struct Swing {
  btVector3 middle_m{0, 0, 0};
  double way_m = 0, turn_rad = 0, period_s = 4;

  btTransform at(double time_s) const {
    const double phase = std::sin(2 * std::numbers::pi * time_s / period_s);
    const btQuaternion turn(btVector3(0, 0, 1), static_cast<btScalar>(turn_rad * phase));
    return btTransform(turn, middle_m + btVector3(static_cast<btScalar>(way_m * phase), 0, 0));
  }
};

// The bar that ropes are laid over.
inline const Swing kBarSwing{.middle_m = {0, 0, 0}, .way_m = 0.15, .turn_rad = 0.5, .period_s = 3};
inline constexpr float kBarRadius_m = 0.2f;
inline constexpr double kRopeHalf_m = 1.2, kRopeHeight_m = 0.35;

// The drum, and a rope that begins on it, is wound about it two and a half times and hangs down.
inline const Swing kDrumSwing{.middle_m = {0, 1.05f, 0}, .way_m = 0.2, .turn_rad = 2, .period_s = 8};
inline constexpr float kDrumRadius_m = 0.15f, kDrumHalf_m = 0.12f;

inline std::vector<Eigen::Vector3d> wound_rope(float rope_radius_m) {
  constexpr uint32_t kTurn = 36;  // segments a turn
  constexpr double kTurns = 2.5, kPitch_m = 0.045, kTail_m = 0.5;
  const double half_angle = std::numbers::pi / kTurn;
  // Its corners stand out so far that its middles touch.
  const double radius = static_cast<double>(kDrumRadius_m + rope_radius_m) / std::cos(half_angle);
  const Eigen::Vector3d middle(0, static_cast<double>(kDrumSwing.middle_m.y()), 0);
  std::vector<Eigen::Vector3d> out;
  for (uint32_t i = 0; i <= kTurn * kTurns; ++i) {
    const double angle = 2 * std::numbers::pi * i / kTurn, along = kPitch_m * i / kTurn - 0.08;
    out.push_back(middle + Eigen::Vector3d(-radius * std::cos(angle), radius * std::sin(angle), along));
  }
  const double step = 2 * radius * std::sin(half_angle);
  while (out.back().y() > middle.y() - kTail_m) out.push_back(out.back() - step * Eigen::Vector3d::UnitY());
  return out;
}

}  // namespace sinew::test

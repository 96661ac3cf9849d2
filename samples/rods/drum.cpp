// drum.cpp  A rope wound on a drum that Bullet moves: wound up, paid out and carried to and fro.
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "samples/rods/run_scene.hpp"
#include "samples/rods/scenes.hpp"
#include "tests/scenes/ropes_in_bullet.hpp"

namespace sinew::sample {
namespace {

constexpr double kDt_s = 1.0 / 120;

Eigen::Isometry3d isometry(const btTransform& t) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const btQuaternion q = t.getRotation();
  const btVector3& x = t.getOrigin();
  out.linear() = Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).toRotationMatrix();
  out.translation() = Eigen::Vector3d(x.x(), x.y(), x.z());
  return out;
}

// About z, with flat ends and six staves of two colours, so that turning shows.
render::Mesh drum_mesh() {
  constexpr uint32_t kSides = 96;
  render::Mesh mesh;
  const auto corner = [&](uint32_t i, float z, const Eigen::Vector3f& normal, float radius) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSides;
    const Eigen::Vector3f out(std::cos(angle), std::sin(angle), 0);
    mesh.positions.push_back(radius * out + z * Eigen::Vector3f::UnitZ());
    mesh.normals.push_back(normal.isZero() ? out : normal);
    mesh.colors.push_back(i / (kSides / 6) % 2 ? render::Rgb(0.42f, 0.40f, 0.37f)
                                               : render::Rgb(0.62f, 0.58f, 0.50f));
  };
  const auto quad = [&](uint32_t i, float z0, float r0, float z1, float r1, const Eigen::Vector3f& normal) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    corner(i, z0, normal, r0), corner(i, z1, normal, r1);
    corner(i + 1, z0, normal, r0), corner(i + 1, z1, normal, r1);
    for (size_t k : {first + 2, first + 3}) mesh.colors[k] = mesh.colors[first];
    mesh.triangles.push_back({first, first + 2, first + 1});
    mesh.triangles.push_back({first + 1, first + 2, first + 3});
  };
  const float r = test::kDrumRadius_m, h = test::kDrumHalf_m;
  for (uint32_t i = 0; i < kSides; ++i) {
    quad(i, -h, r, h, r, Eigen::Vector3f::Zero());
    quad(i, h, r, h, 0, Eigen::Vector3f::UnitZ());
    quad(i, -h, 0, -h, r, -Eigen::Vector3f::UnitZ());
  }
  return mesh;
}

// A segment that turns and moves with the drum.
rods::SegmentPose carried(const rods::SegmentDef& s, const Eigen::Isometry3d& by) {
  rods::SegmentPose out;
  const Eigen::Vector3d place = by * Eigen::Vector3d(s.position_m);
  const Eigen::Quaterniond turn(by.linear() *
                                Eigen::Quaternionf(s.orientation).cast<double>().toRotationMatrix());
  for (int k = 0; k < 3; ++k) out.position_m[k] = place[k];
  for (int k = 0; k < 4; ++k) out.orientation[k] = static_cast<float>(turn.coeffs()[k]);
  return out;
}

}  // namespace

Story drum(double seconds) {
  const test::Swing& swing = test::kDrumSwing;
  test::BulletWorld world({0, -9.81f, 0});
  const float r = test::kDrumRadius_m;
  btRigidBody* body =
      world.kinematic(world.shape<btCylinderShapeZ>(btVector3(r, r, test::kDrumHalf_m)), swing.at(0));
  body->setFriction(0.5f);
  test::RopeInBullet rope;
  const rods::SegmentDef like = test::rope_segment({});
  rope.segments = test::rod_through(test::wound_rope(like.radius_m), like);
  rope.segments[0].fixed = true;
  accept(rope.create({.world = &world.world}, true));

  const Eigen::Isometry3d from = isometry(swing.at(0)).inverse();
  const auto drive = [&](double time_s) {
    body->setWorldTransform(swing.at(time_s));
    world.world.stepSimulation(static_cast<float>(kDt_s), 0, static_cast<float>(kDt_s));
    accept(rope.batch.set_target(0, 0, carried(rope.segments[0], isometry(swing.at(time_s)) * from)));
  };
  Story story{.name = "drum",
              .title = {},
              .actors = {{rope.segments, {{0.55f, 0.10f, 0.08f}, {0.85f, 0.72f, 0.45f}, 18, 4}, {}}},
              .prop = drum_mesh(),
              .view = {.yaw_deg = 58, .pitch_deg = 16}};
  run_scene(
      {.batch = &rope.batch,
       .collider = &rope.collider,
       .dt_s = kDt_s,
       .seconds = seconds,
       .moments_s = {0, 0.1 * seconds, 0.2 * seconds, 0.45 * seconds, 0.6 * seconds, seconds},
       .drive = drive,
       .prop = [&](double time_s) { return Eigen::Isometry3f(isometry(swing.at(time_s)).cast<float>()); },
       .depth = [&] { return test::deepest(rope, *body); }},
      &story);
  char title[160];
  std::snprintf(title, sizeof title, "A rope of %u segments on a drum of a Bullet world",
                story.measured.segments);
  story.title = title;
  story.columns = 3;
  story.grid_m = 0.2f;
  return story;
}

}  // namespace sinew::sample

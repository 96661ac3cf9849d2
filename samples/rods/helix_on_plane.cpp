// helix_on_plane.cpp  A spring of rubber falls on the floor.
#include <cstdio>
#include <stdexcept>

#include "samples/rods/run_scene.hpp"
#include "samples/rods/scenes.hpp"
#include "tests/scenes/rod_through.hpp"

namespace sinew::sample {
namespace {

constexpr double kDt_s = 1.0 / 120;

Segments spring() {
  rods::SegmentDef like;
  like.radius_m = 0.011f;
  like.density_kg_m3 = 1100;
  like.young_modulus_pa = 3e7f;
  like.torsion_modulus_pa = 1e7f;
  like.damping_s = 0.002f;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.55, Eigen::Vector3d::UnitX()) *
                                Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitY()));
  return test::rod_through(test::coil({}, turn, {0, 0.48, 0}), like);
}

}  // namespace

Story helix_on_plane(double seconds) {
  Actor actor{spring(), {{0.62f, 0.16f, 0.06f}, {0.85f, 0.55f, 0.12f}, 18, 4}, {}};
  rods::RodBatch batch;
  rods::RodCollider collider;
  const rods::StrandDef strand{actor.segments};
  accept(rods::RodBatch::create({&strand, 1}, {}, &batch));
  accept(rods::RodCollider::create(batch, {}, &collider));
  const rods::Plane floor{.friction = 0.5f, .motion = {}};
  accept(collider.set_planes({&floor, 1}));

  Story story{.name = "helix", .title = {}, .actors = {actor}, .view = {.yaw_deg = 25, .pitch_deg = 14}};
  run_scene({.batch = &batch,
             .collider = &collider,
             .dt_s = kDt_s,
             .seconds = seconds,
             .moments_s = {0, 0.08 * seconds, 0.13 * seconds, 0.19 * seconds, 0.27 * seconds, seconds}},
            &story);
  char title[160];
  std::snprintf(title, sizeof title, "Helix of %u segments falls on a plane", story.measured.segments);
  story.title = title;
  story.columns = 3;
  story.grid_m = 0.1f;
  return story;
}

}  // namespace sinew::sample

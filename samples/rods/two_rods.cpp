// two_rods.cpp  A rope falls across another that is held at both ends.
#include <cstdio>
#include <stdexcept>

#include "samples/rods/run_scene.hpp"
#include "samples/rods/scenes.hpp"
#include "tests/scenes/rod_through.hpp"

namespace sinew::sample {
namespace {

constexpr double kDt_s = 1.0 / 120;
constexpr uint32_t kSegments = 50;

rods::SegmentDef rope() {
  rods::SegmentDef like;
  like.radius_m = 0.014f;
  like.density_kg_m3 = 900;
  like.young_modulus_pa = 2e5f;
  like.torsion_modulus_pa = 2e5f;
  like.damping_s = 0.02f;
  like.drag_per_s = 0.1f;
  return like;
}

// From the middle to both sides along `half_m`, sagging like a parabola.
Segments hung(const Eigen::Vector3d& middle_m, const Eigen::Vector3d& half_m, double sag_m) {
  std::vector<Eigen::Vector3d> points;
  for (uint32_t i = 0; i <= kSegments; ++i) {
    const double x = 2.0 * i / kSegments - 1;
    points.push_back(middle_m + x * half_m + sag_m * x * x * Eigen::Vector3d::UnitY());
  }
  return test::rod_through(points, rope());
}

}  // namespace

Story two_rods(double seconds) {
  Actor held{
      hung({0, 0.52, 0}, {0.5, 0, 0}, 0.13), {{0.08f, 0.20f, 0.46f}, {0.75f, 0.75f, 0.72f}, 18, 4}, {}};
  Actor falls{
      hung({0.1, 0.86, 0.03}, {0.12, 0, 0.48}, 0), {{0.55f, 0.10f, 0.08f}, {0.85f, 0.72f, 0.45f}, 18, 4}, {}};
  held.segments.front().fixed = held.segments.back().fixed = true;
  rods::RodBatch batch;
  rods::RodCollider collider;
  const rods::StrandDef strands[] = {{held.segments}, {falls.segments}};
  accept(rods::RodBatch::create(strands, {}, &batch));
  accept(rods::RodCollider::create(batch, {.rod_friction = 0.6f}, &collider));
  const rods::Plane floor{.friction = 0.6f, .motion = {}};
  accept(collider.set_planes({&floor, 1}));

  Story story{
      .name = "two_rods", .title = {}, .actors = {held, falls}, .view = {.yaw_deg = 38, .pitch_deg = 14}};
  run_scene({.batch = &batch,
             .collider = &collider,
             .dt_s = kDt_s,
             .seconds = seconds,
             .moments_s = {0, 0.065 * seconds, 0.085 * seconds, 0.12 * seconds, 0.25 * seconds, seconds}},
            &story);
  story.title = "A rope falls across another, both of 50 segments";
  story.columns = 3;
  story.grid_m = 0.2f;
  return story;
}

}  // namespace sinew::sample

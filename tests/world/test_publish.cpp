// test_publish.cpp  From the frames that tissue moves in to the axes of the flesh, which carry and skin it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "character/asset/asset.hpp"
#include "character/asset/open_asset.hpp"
#include "character/instance.hpp"
#include "character/life/create_instance.hpp"
#include "character/motion/motion.hpp"
#include "character/output/displacement_bound.hpp"
#include "character/output/publish.hpp"
#include "character/transition/blend.hpp"
#include "core/floating_point.hpp"
#include "tests/world/stage.hpp"
#include "tissue/frames/node_pose.hpp"

using namespace sinew;
using Eigen::Vector3f;
using Rows33 = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

namespace {

constexpr float kRounding_m = 1e-6f;  // of displacements of some centimetres, through a few rotations

// A block in its modal tier, bent at the waist by two radians, with its nodes' frames as a tick leaves them.
struct BentBlock {
  world::Asset asset;
  world::Instance instance;
  BentBlock() {
    REQUIRE(world::open_asset(test::block_pack().bytes(), &asset).ok());
    REQUIRE(world::make_instance(asset, {}, &instance).ok());
    const scenes::BlockPose pose = scenes::bent_pose(2);
    std::copy_n(pose.joints.data(), 2, instance.motion.joints);
    world::take_pose(instance, {});
    world::follow_motion(instance, 0);
    instance.state->tier = Tier::kModal;
    instance.state->blend_ticks = world::kBlendInTicks;
  }
};

}  // namespace

// Whatever the frames, the same displacement in space.
TEST_CASE("published_displacement_lies_along_the_flesh") {
  BentBlock block;
  world::Instance& instance = block.instance;
  const Vector3f offset_m(0.03f, -0.02f, 0.05f);
  float largest_bend_rad = 0;
  for (size_t n = 0; n < block.asset.node_count(); ++n) {
    const tissue::NodePose& pose = instance.motion.poses[0][n];
    Eigen::Map<Vector3f>(instance.tissue.u[0] + 3 * n) =
        Eigen::Map<const Rows33>(pose.rotation).transpose() * offset_m;
    largest_bend_rad = std::max(largest_bend_rad, Eigen::Map<const Vector3f>(pose.bend).norm());
  }
  REQUIRE(largest_bend_rad > 0.05f);  // a quarter of the bend: the waist blends
  world::show_tick(instance);
  world::publish(instance);
  std::vector<tissue::NodePose> flesh(block.asset.node_count());
  const float upright[4] = {0, 0, 0, 1};
  tissue::pose_nodes(block.asset.pack.nodes, instance.motion.skin, upright, flesh.data());
  for (size_t n = 0; n < flesh.size(); ++n) {
    const Vector3f delta(instance.published.delta + 3 * n);
    CHECK((Eigen::Map<const Rows33>(flesh[n].rotation) * delta - offset_m).norm() < kRounding_m);
  }
}

// As in a step, where denormals are flushed: the inverse of the largest floats is one.
TEST_CASE("the_last_bound_holds_whatever_floats_are_displaced_by") {
  const core::FloatingPointScope mode;
  constexpr float kBound_m = 0.5f;
  for (const float size : {0.1f, 1.0f, 1e10f, 1e19f, 1e30f, 1e37f, 1e38f, 3e38f, HUGE_VALF, NAN}) {
    const Eigen::Vector3f held = world::within_bound({size, -0.5f * size, 0.2f * size}, kBound_m);
    float carried[3 * 16] = {size, 0, size};
    world::hold_within_bound(kBound_m, 16, carried);
    CAPTURE(size);
    CHECK(std::hypot(held.x(), held.y(), held.z()) <= 1.0001f * kBound_m);
    CHECK(std::hypot(carried[0], carried[16], carried[32]) <= 1.0001f * kBound_m);
  }
}

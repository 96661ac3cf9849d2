// test_rod_proxies.cpp  Rods of a character against the capsules about its own bones.
#include "rods/contacts/find/sweep.hpp"
#include "rods/vector.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using rods::Vector;
using scenes::TailedPose;
using test::Stage;

namespace {

constexpr double kSum_m = scenes::kBarRadius_m + scenes::kTailRadius_m;

// As stiff as to lie on the bar without any friction; at a fifth of that, 0.3 is too little and it slides off
// (rods/a_limp_tail_slides_off_a_bar_unless_friction_holds_it).
constexpr double kYoung_pa = 1e5;

const scenes::PackBytes& soft_tail(bool bar) {
  static const scenes::PackBytes packs[] = {
      scenes::soft_block(
          {.network = false, .rods = scenes::RodMatter{.sag = 1, .young_modulus_pa = kYoung_pa}}),
      scenes::soft_block({.network = false,
                          .rods = scenes::RodMatter{.sag = 1, .young_modulus_pa = kYoung_pa, .bar = true}})};
  return packs[bar];
}

struct TailStage : Stage {
  explicit TailStage(bool own_body, bool bar = true) : Stage(0, {}, soft_tail(bar)) {
    InstanceId made;
    REQUIRE(world.create_instance({.asset = asset, .contacts = {.own_body = own_body}}, &made).ok());
    blocks.push_back(made);
  }
  void hold(const TailedPose& pose, int frames) {
    for (int f = 0; f < frames; ++f) {
      REQUIRE(world.set_pose(blocks[0], pose.pose()).ok());
      world.step(1.0f / 60);
    }
  }
  // Of the tail's bones from their axes to the bar's, in the block's character space.
  double nearest_m(const TailedPose& pose) const {
    std::vector<Matrix34> joints(info.joint_count);
    REQUIRE(world.read_joint_matrices(blocks[0], joints).ok());
    const auto place = [&](uint32_t j, double behind_m) {
      const auto& m = joints[j].m;
      Vector p;
      for (size_t k = 0; k < 3; ++k)
        p[k] = static_cast<double>(m[k][3]) - behind_m * static_cast<double>(m[k][2]);
      return p;
    };
    const float lift = pose.joints[1].m[1][3] - static_cast<float>(scenes::kBlockJointHeight_m);
    const auto way_m = static_cast<double>(pose.joints[1].m[2][3]);
    rods::Axis bar = {
        {-0.2, scenes::bar_end(-1)[1] + static_cast<double>(lift), scenes::bar_end(-1)[2] + way_m}, {}};
    bar.to = {0.2, bar.from[1], bar.from[2]};
    double least = 1;
    for (uint32_t j = scenes::kTail; j < scenes::kTail + 4; ++j) {
      const rods::Axis bone = {place(j, 0), place(j, scenes::kBone_m)};
      const rods::Nearest n = rods::nearest(bone, bar);
      least = std::min(least, rods::length(rods::difference(rods::between(bone.from, bone.to, n.a),
                                                            rods::between(bar.from, bar.to, n.b))));
    }
    return least;
  }
};

}  // namespace

TEST_CASE("a_tail_comes_to_lie_on_a_capsule_of_its_own_body_where_it_is_asked_to") {
  const TailedPose still = scenes::with_rods(scenes::bind_pose());
  TailStage on(true), off(false);
  CHECK(on.info.proxy_count == 1);
  on.hold(still, 240);
  off.hold(still, 240);
  CHECK(off.nearest_m(still) > 2 * kSum_m);  // fell past it
  CHECK(on.nearest_m(still) > kSum_m - 0.05 * scenes::kTailRadius_m);
  CHECK(on.nearest_m(still) < 1.3 * kSum_m);
  CHECK(on.report().rod_contacts > 0);
}

TEST_CASE("without_capsules_in_the_pack_the_body_is_not_touched") {
  TailStage stage(true, false);
  CHECK(stage.info.proxy_count == 0);
  stage.hold(scenes::with_rods(scenes::bind_pose()), 10);
  CHECK(stage.report().rod_contacts == 0);
}

TEST_CASE("a_tail_on_its_own_body_goes_on_with_the_same_bits_after_a_restore") {
  TailStage stage(true);
  stage.hold(scenes::with_rods(scenes::bind_pose()), 100);
  const std::vector<std::byte> saved = stage.save();
  for (int f = 0; f < 60; ++f) stage.hold(scenes::with_rods(scenes::bind_pose(), 0.002 * f), 1);
  const std::vector<std::byte> first = stage.save();
  REQUIRE(stage.world.restore_state(stage.blocks[0], saved).ok());
  for (int f = 0; f < 60; ++f) stage.hold(scenes::with_rods(scenes::bind_pose(), 0.002 * f), 1);
  CHECK(stage.save() == first);
}

TEST_CASE("a_bone_that_creeps_wakes_a_sleeping_tail_before_it_is_through") {
  TailStage stage(true);
  const auto moved = [](double way_m) {
    TailedPose pose = scenes::with_rods(scenes::bind_pose());
    pose.joints[1].m[1][3] -= 0.3f;  // out of the tail's way as it falls
    pose.joints[1].m[2][3] += static_cast<float>(way_m);
    return pose;
  };
  stage.hold(moved(0), 1500);
  REQUIRE(stage.report().rods_asleep > 0);
  // A third of what counts as still, of the bar's radius, in each tick.
  constexpr double kCreep_m = 3e-4 * scenes::kBarRadius_m;
  for (double way_m = 0; way_m < 0.3; way_m += kCreep_m) {
    stage.hold(moved(way_m), 1);
    REQUIRE(stage.nearest_m(moved(way_m)) > kSum_m - 0.1 * scenes::kTailRadius_m);
  }
  CHECK(stage.report().rod_contacts > 0);
}

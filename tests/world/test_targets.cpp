// test_targets.cpp  What a crowd gets does not depend on the instruction set; with fused multiply-adds
// neither do its bits.
#include "kernels/kernels.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr size_t kCrowd = 24;
constexpr double kApart_m = 2;

struct Course {
  std::vector<Tier> tiers;  // frame by frame, of each
  uint64_t bits = 0;        // of all that was read
  uint32_t of_tier[kTierCount] = {};
};

// A row of blocks along -Z, three weights in turn.
void line_up(Stage& stage) {
  for (size_t i = 0; i < kCrowd; ++i) {
    InstanceId made;
    const RootTransform root{.position_m = {0, 0, -kApart_m * static_cast<double>(i)}};
    REQUIRE(stage.world
                .create_instance(
                    {.asset = stage.asset, .importance = static_cast<float>(1 + i % 3), .root = root}, &made)
                .ok());
    stage.blocks.push_back(made);
  }
}

// A camera that goes along the row and swings to and fro, and another that stands behind it.
void look(Stage& stage, int frame) {
  const double half_rad = 0.2 + 0.1 * std::sin(0.05 * frame);
  View views[] = {{.position_m = {3, 0.5, 4 - 0.05 * frame}}, {.position_m = {0, 1, 3}, .far_m = 10}};
  views[0].rotation_xyzw[1] = static_cast<float>(std::sin(half_rad));
  views[0].rotation_xyzw[3] = static_cast<float>(std::cos(half_rad));
  REQUIRE(stage.world.set_views(views).ok());
}

void walk_in_line(Stage& stage, double now_s) {
  for (size_t i = 0; i < kCrowd; ++i) {
    scenes::BlockPose pose = scenes::walk(now_s + 0.07 * static_cast<double>(i));
    pose.root.position_m[2] -= kApart_m * static_cast<double>(i);
    stage.pose(stage.blocks[i], pose);
  }
}

Course run() {
  Course course;
  Stage stage(0, {.budget_mode = BudgetMode::kWorkUnits});
  line_up(stage);
  for (int frame = 0; frame < 600; ++frame) {
    look(stage, frame);
    REQUIRE(stage.world.set_budget_us(static_cast<float>(2 + frame % 100 / 10)).ok());
    walk_in_line(stage, frame / 60.0);
    stage.world.step(1.0f / 60);
    for (size_t i = 0; i < kCrowd; ++i) {
      course.tiers.push_back(stage.report(i).tier);
      ++course.of_tier[static_cast<size_t>(stage.report(i).tier)];
      course.bits = course.bits * 31 + test::hash_of(stage.read(i));
    }
  }
  return course;
}

}  // namespace

TEST_CASE("a_crowd_has_the_same_tiers_on_every_target_and_the_same_bits_on_those_with_fma") {
  std::vector<Course> all, fused;
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    all.push_back(run());
    CHECK(all.back().tiers == all[0].tiers);
    if (kernels.fused) fused.push_back(all.back());
    if (kernels.fused) CHECK(fused.back().bits == fused[0].bits);
  });
  for (const Tier tier : {Tier::kSkinning, Tier::kExtrapolate, Tier::kModal, Tier::kNetwork})
    CHECK(all[0].of_tier[static_cast<size_t>(tier)] > 0);
  if (fused.size() < 2) WARN("of the targets here " << fused.size() << " has FMA: no bits to compare");
}

// clip.cpp  Clips loop, and limbs keep their ends where the clip puts them.
#include "baker/creature/clip.hpp"

#include <catch2/catch.hpp>

#include "creature_file.hpp"

using namespace sinew;
using Eigen::Vector3d;

namespace {

// Character-space place of every joint at a key.
std::vector<Vector3d> places(const baker::CreatureRecipe& recipe, const baker::ClipKeys& keys, size_t key) {
  std::vector<Eigen::Matrix3d> turn(recipe.joints.size());
  std::vector<Vector3d> place(recipe.joints.size());
  for (size_t j = 0; j < place.size(); ++j) {
    const baker::JointKeys& own = keys.joints[j];
    const Vector3d offset =
        own.translation.empty() ? baker::rest_offset(recipe, static_cast<int>(j)) : own.translation[key];
    const Eigen::Matrix3d local =
        own.rotation.empty() ? Eigen::Matrix3d::Identity().eval() : own.rotation[key].toRotationMatrix();
    turn[j] = local;
    place[j] = offset;
    if (recipe.joints[j].parent.empty()) continue;
    const size_t parent = static_cast<size_t>(baker::joint_index(recipe, recipe.joints[j].parent));
    turn[j] = turn[parent] * local;
    place[j] = place[parent] + turn[parent] * offset;
  }
  return place;
}

}  // namespace

TEST_CASE("every_clip_ends_as_it_begins") {
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  CHECK(recipe.clips.size() >= 4);
  for (const baker::ClipRecipe& clip : recipe.clips) {
    const baker::ClipKeys keys = baker::key_clip(recipe, clip);
    CHECK(keys.times_s.front() == 0);
    CHECK(keys.times_s.back() == clip.duration_s);
    const std::vector<Vector3d> first = places(recipe, keys, 0),
                                last = places(recipe, keys, keys.times_s.size() - 1);
    for (size_t j = 0; j < first.size(); ++j) CHECK((first[j] - last[j]).norm() < 1e-9);
  }
}

TEST_CASE("keys_do_not_jump") {
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  constexpr double kFastest_m_s = 8;  // ear tips in a shake
  for (const baker::ClipRecipe& clip : recipe.clips) {
    const baker::ClipKeys keys = baker::key_clip(recipe, clip);
    std::vector<Vector3d> before = places(recipe, keys, 0);
    for (size_t k = 1; k < keys.times_s.size(); ++k) {
      const std::vector<Vector3d> now = places(recipe, keys, k);
      for (size_t j = 0; j < now.size(); ++j)
        CHECK((now[j] - before[j]).norm() < kFastest_m_s * (keys.times_s[k] - keys.times_s[k - 1]));
      before = now;
    }
  }
}

TEST_CASE("planted_feet_stay_where_they_are_while_the_body_moves") {
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  constexpr double kSlip_m = 0.002;  // a leg that is fully stretched may lift its foot by so much
  const size_t foot = static_cast<size_t>(baker::joint_index(recipe, "foot_l"));
  const size_t pelvis = static_cast<size_t>(baker::joint_index(recipe, "pelvis"));
  const baker::ClipKeys idle = baker::key_clip(recipe, recipe.clips[0]);
  double swayed_m = 0;
  for (size_t k = 0; k < idle.times_s.size(); ++k) {
    const std::vector<Vector3d> place = places(recipe, idle, k);
    CHECK((place[foot] - recipe.joints[foot].at).norm() < kSlip_m);
    swayed_m = std::max(swayed_m, (place[pelvis] - recipe.joints[pelvis].at).norm());
  }
  CHECK(swayed_m > 0.01);
}

TEST_CASE("toes_do_not_sink_into_the_ground") {
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  const size_t toe = static_cast<size_t>(baker::joint_index(recipe, "toe_l"));
  constexpr double kSinks_m = 0.01;
  for (const baker::ClipRecipe& clip : recipe.clips) {
    const baker::ClipKeys keys = baker::key_clip(recipe, clip);
    for (size_t k = 0; k < keys.times_s.size(); ++k)
      CHECK(places(recipe, keys, k)[toe].y() > recipe.joints[toe].at.y() - kSinks_m);
  }
}

TEST_CASE("hop_leaves_the_ground_and_lands_hard") {
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  const auto hop =
      std::find_if(recipe.clips.begin(), recipe.clips.end(), [](const auto& c) { return c.name == "hop"; });
  REQUIRE(hop != recipe.clips.end());
  const baker::ClipKeys keys = baker::key_clip(recipe, *hop);
  const size_t pelvis = static_cast<size_t>(baker::joint_index(recipe, "pelvis"));
  const size_t foot = static_cast<size_t>(baker::joint_index(recipe, "foot_l"));
  std::vector<double> height;
  double foot_height = 0;
  for (size_t k = 0; k < keys.times_s.size(); ++k) {
    height.push_back(places(recipe, keys, k)[pelvis].y());
    foot_height = std::max(foot_height, places(recipe, keys, k)[foot].y() - recipe.joints[foot].at.y());
  }
  const double step_s = keys.times_s[1];
  double hardest = 0;
  for (size_t k = 1; k + 1 < height.size(); ++k)
    hardest = std::max(hardest, (height[k + 1] - 2 * height[k] + height[k - 1]) / (step_s * step_s));
  CHECK(foot_height > 0.15);
  CHECK(hardest > 3 * 9.81);
}

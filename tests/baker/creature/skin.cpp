// skin.cpp  Skin weights stay with their limb.
#include "baker/creature/skin.hpp"

#include <catch2/catch.hpp>

#include "creature_file.hpp"

using namespace sinew;

namespace {

double share(const test::CreatureFile& file, size_t vertex, const std::vector<int>& joints) {
  static const std::vector<double> joint = file.attribute(0, "JOINTS_0"),
                                   weight = file.attribute(0, "WEIGHTS_0");
  double sum = 0;
  for (size_t i = 4 * vertex; i < 4 * vertex + 4; ++i)
    if (std::find(joints.begin(), joints.end(), static_cast<int>(joint[i])) != joints.end()) sum += weight[i];
  return sum;
}

}  // namespace

TEST_CASE("joint_names_match_whole_or_by_prefix") {
  baker::CreatureRecipe recipe;
  for (const char* name : {"root", "tail_1", "tail_2", "tailor"}) recipe.joints.push_back({name, "", {}, {}});
  CHECK(baker::matching_joints(recipe, {"wing"}).empty());
  CHECK(baker::matching_joints(recipe, {"tail_*"}) == std::vector<int>{1, 2});
  CHECK(baker::matching_joints(recipe, {"root", "tailor"}) == std::vector<int>{0, 3});
}

TEST_CASE("weights_do_not_bleed_between_limbs") {
  const test::CreatureFile& file = test::default_creature();
  const baker::CreatureRecipe& recipe = test::shipped_recipe();
  const auto joints = [&](const char* prefix) { return baker::matching_joints(recipe, {prefix}); };
  const std::vector<int> left_leg = joints("leg_lower_l"), right_leg = joints("leg_lower_r"),
                         ears = joints("ear_*"), arms = joints("arm_*"), tail = joints("tail_*");
  constexpr double kFork_m = 0.04;  // where the legs meet, each pulls a little on the other's side
  const baker::Surface body = file.surface(0);
  for (size_t v = 0; v < body.positions.size(); ++v) {
    const double wrong_leg = share(file, v, body.positions[v].x() > 0 ? right_leg : left_leg);
    CHECK(wrong_leg <= (std::abs(body.positions[v].x()) < kFork_m ? 0.15 : 0));
    if (body.positions[v].y() < 0.5) CHECK(share(file, v, ears) == 0);
    if (body.positions[v].z() < -0.35) CHECK(share(file, v, tail) > 0.9);
    CHECK(std::min(share(file, v, ears), share(file, v, arms)) == 0);
  }
}

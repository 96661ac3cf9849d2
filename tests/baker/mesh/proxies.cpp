// proxies.cpp  Capsules about bones: fitted, stated, left out.
#include "baker/mesh/rods/proxies.hpp"

#include <catch2/catch.hpp>

#include "baker/mesh/anatomy/fit_capsule.hpp"
#include "column.hpp"

using namespace sinew::baker;

namespace {

// Evenly on a capsule's side and caps.
std::vector<Vector3> capsule_points(const Vector3& from, const Vector3& along, double radius_m) {
  const Vector3 axis = along.normalized(), aside = axis.unitOrthogonal(), other = axis.cross(aside);
  std::vector<Vector3> points;
  for (int i = 0; i < 4000; ++i) {
    const double turn = 2.399963 * i, at = -radius_m + (along.norm() + 2 * radius_m) * (i + 0.5) / 4000;
    const double over = std::max({-at, at - along.norm(), 0.0});
    const double r = std::sqrt(radius_m * radius_m - over * over);
    points.push_back(from + at * axis + r * (std::cos(turn) * aside + std::sin(turn) * other));
  }
  return points;
}

const std::vector<bool> kLastOnRod = {false, false, false, true};

}  // namespace

TEST_CASE("the_points_of_a_capsule_give_the_capsule_back") {
  const Vector3 from(1, 2, 3), along(0.3, 0.4, -0.2);
  for (const Vector3& hint : {along, Vector3(Vector3::Zero())}) {
    FittedCapsule fit = fit_capsule(capsule_points(from, along, 0.05), hint);
    if ((fit.from - from).norm() > (fit.to - from).norm()) std::swap(fit.from, fit.to);
    CHECK(fit.radius_m == Approx(0.05).epsilon(1e-3));
    CHECK((fit.from - from).norm() < 0.02);  // ends lie at the 2nd and 98th hundredth: 13 mm of 640 inside
    CHECK((fit.to - from - along).norm() < 0.02);
  }
  const FittedCapsule ball = fit_capsule(capsule_points(from, {0, 1e-6, 0}, 0.05), {0, 1, 0});
  CHECK((ball.from - ball.to).norm() < 0.01);
  CHECK(ball.radius_m == Approx(0.05).epsilon(0.05));
}

TEST_CASE("a_recipe_that_names_no_joint_is_refused_and_without_rods_there_are_no_capsules") {
  Character character = column();
  const Bones bones = find_bones(character, {});
  Recipe recipe;
  recipe.without_proxies = {"bone_9"};
  CHECK_THROWS_WITH(find_proxies(character, bones, kLastOnRod, recipe), Catch::Contains("bone_9"));
  recipe.without_proxies.clear();
  recipe.proxies = {{"leg", 0.1}};
  CHECK_THROWS_WITH(find_proxies(character, bones, kLastOnRod, recipe), Catch::Contains("leg"));
  CHECK(find_proxies(character, bones, {false, false, false, false}, {}).empty());
}

TEST_CASE("bones_with_flesh_get_capsules_but_for_rods_and_what_the_recipe_leaves_out") {
  Character character = column();
  const Bones bones = find_bones(character, {});
  const std::vector<Proxy> all = find_proxies(character, bones, kLastOnRod, {});
  REQUIRE(!all.empty());
  for (const Proxy& p : all) {
    CHECK(p.joint != 3);
    CHECK(p.radius_m > 0);
  }
  Recipe recipe;
  recipe.without_proxies = {"bone_0"};
  recipe.proxies = {{"bone_1", 0.123}};
  const std::vector<Proxy> some = find_proxies(character, bones, kLastOnRod, recipe);
  for (const Proxy& p : some) {
    CHECK(p.joint != 0);
    if (p.joint == 1) CHECK(p.radius_m == 0.123);
  }
  CHECK(some.size() < all.size());
}

TEST_CASE("a_region_that_touches_the_body_needs_no_rod_to_have_capsules") {
  Character character = column();
  const Bones bones = find_bones(character, {});
  const std::vector<bool> on_rods(4, false);
  Recipe recipe;
  recipe.regions = {{"belly", {"bone_1"}}, {"chest", {"bone_2"}, 0.1, true}};
  CHECK(find_proxies(character, bones, on_rods, recipe).size() > 1);
  recipe.regions[1].touches_body = false;
  CHECK(find_proxies(character, bones, on_rods, recipe).empty());
}

TEST_CASE("the_colliders_of_the_file_take_the_place_of_fitted_capsules") {
  Character character = column();
  character.colliders = {{1, {0, 0.1, 0}, {0, 0.2, 0}, 0.07}};
  const std::vector<Proxy> proxies = find_proxies(character, find_bones(character, {}), kLastOnRod, {});
  REQUIRE(proxies.size() == 1);
  const Vector3 bone = character.inverse_bind[1].inverse().topRightCorner<3, 1>();
  CHECK((proxies[0].from - bone - Vector3(0, 0.1, 0)).norm() < 1e-9);
  CHECK(proxies[0].radius_m == Approx(0.07));
}

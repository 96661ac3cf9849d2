// crossed_capsules.cpp  A rod does not hang on a capsule that its own animation takes it through.
#include "baker/mesh/rods/crossed_capsules.hpp"

#include <catch2/catch.hpp>

#include "tests/baker/mesh/column.hpp"

using namespace sinew::baker;

namespace {

// A bone of the last joint, beside the column, and a capsule along the column's first.
struct Scene {
  Character character = column();
  std::vector<Rod> rods = {{}};
  std::vector<Proxy> proxies = {{0, {0, 0, 0}, {0, 0.1, 0}, 0.05}};

  Scene() {
    RodBone bone;
    bone.joint = 3;
    bone.begin = Vector3(1, 0, 0);
    bone.end = Vector3(1, 0.1, 0);
    bone.radius_m = 0.02;
    rods[0].bones = {bone};
  }
  // A clip that carries the last joint by `x_m`.
  void carry(double x_m) {
    const int node = character.joint_node[3];
    const Vector3 at = character.nodes[static_cast<size_t>(node)].translation, to = at + Vector3(x_m, 0, 0);
    Clip clip;
    clip.name = "swing";
    clip.duration_s = 1;
    clip.channels = {{node,
                      Path::kTranslation,
                      Interpolation::kLinear,
                      {0, 1},
                      {at.x(), at.y(), at.z(), to.x(), to.y(), to.z()}}};
    character.clips = {clip};
  }
  size_t left(const Recipe& recipe = {}) {
    drop_crossed(character, rods, recipe, proxies);
    return proxies.size();
  }
};

}  // namespace

TEST_CASE("capsules_stay_where_no_clip_takes_a_rod_through_them") {
  Scene still, beside;
  CHECK(still.left() == 1);
  beside.carry(-0.5);
  CHECK(beside.left() == 1);
  CHECK(beside.character.notes.empty());
}

TEST_CASE("a_capsule_that_a_clip_takes_a_rod_through_is_dropped_with_a_note") {
  Scene crossed, stated, of_file;
  for (Scene* scene : {&crossed, &stated, &of_file}) scene->carry(-1.05);
  CHECK(crossed.left() == 0);
  REQUIRE(crossed.character.notes.size() == 1);
  CHECK_THAT(crossed.character.notes[0], Catch::Contains("'bone_0'"));
  Recipe recipe;
  recipe.proxies = {{"bone_0", 0.05}};
  CHECK(stated.left(recipe) == 1);
  of_file.character.colliders = {{0, {0, 0, 0}, {0, 0.1, 0}, 0.05}};
  CHECK(of_file.left() == 1);
}

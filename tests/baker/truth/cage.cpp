// cage.cpp  Cages fill what the surface encloses, keep apart what is apart, and carry surface values exactly.
#include "baker/truth/cage/cage.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/truth/cage/cage_topology.hpp"
#include "baker/truth/numerics/disjoint_sets.hpp"
#include "tests/baker/truth/bodies.hpp"

using namespace sinew::baker;
using sinew::test::add_box;
using sinew::test::bare_character;

namespace {

constexpr double kRounding = 1e-10;
constexpr double kCell = 0.1;

Character boxes(const std::vector<std::array<Vector3, 2>>& all, bool open = false) {
  Character c = bare_character({Vector3::Zero()});
  for (const auto& box : all) add_box(c, box[0], box[1], 0.07, 0, open);
  return c;
}

double matter_m3(const Character& character) {
  const VoxelMatter matter(character, kCell, 3);
  int cells = 0;
  for (int fine = 0; fine < matter.fine_count(); ++fine) cells += matter.matter(fine);
  return cells * std::pow(kCell / 3, 3);
}

size_t separate_parts(const CageTopology& topology) {
  DisjointSets parts(topology.nodes.size());
  for (const auto& t : topology.tetrahedra)
    for (const int node : t) parts.join(static_cast<size_t>(t[0]), static_cast<size_t>(node));
  std::set<size_t> roots;
  for (size_t i = 0; i < topology.nodes.size(); ++i) roots.insert(parts.find(i));
  return roots.size();
}

size_t separate_parts(const Character& character) {
  const VoxelMatter matter(character, kCell, 3);
  return separate_parts(CageTopology(matter));
}

// A bar, rigid below a height of a half and soft above, on two joints whose weights blend along it.
struct Bar {
  Character character = bare_character({Vector3(0, -0.45, 0), Vector3(0, 0.45, 0)});
  TissueLayout layout;
  Recipe recipe;
  Bar() {
    add_box(character, {-0.2, -0.5, -0.2}, {0.2, 0.5, 0.2}, 0.05, 0);
    layout.regions.emplace_back();
    for (size_t v = 0; v < character.positions.size(); ++v) {
      const double height = character.positions[v].y();
      character.skin[v].joint = {0, 1};
      character.skin[v].weight = {0.5 - height, 0.5 + height};
      layout.stiffness.push_back(height > 0 ? 0.1 : 1);
      if (height > 0) layout.regions[0].vertices.push_back(static_cast<int>(v));
    }
    recipe.voxels_high = 10;
  }
};

}  // namespace

TEST_CASE("cage_refuses_what_it_cannot_fill") {
  Bar bar;
  const auto refused = [&](const std::string& why) {
    REQUIRE_THROWS_AS(build_cage(bar.character, bar.layout, bar.recipe), BadInput);
    REQUIRE_THROWS_WITH(build_cage(bar.character, bar.layout, bar.recipe), Catch::Contains(why));
  };
  std::swap(bar.layout.regions[0].vertices, bar.layout.regions.emplace_back().vertices);
  bar.layout.regions.clear();
  refused("no free node");
  bar = Bar();
  bar.layout.stiffness.pop_back();
  refused("the layout has");
  bar = Bar();
  bar.character.triangles.clear();
  refused("no surface");
  bar = Bar();
  bar.recipe.voxels_high = 0;
  refused("voxels_high");
  bar = Bar();
  bar.recipe.coreless_joints = {"joint_7"};
  refused("joint_7");
}

TEST_CASE("matter_is_the_enclosed_volume") {
  constexpr double kSurfaceCells = 0.12;  // share of the volume: cells through which the surface passes
  const Vector3 low(-0.35, -0.5, -0.4), high(0.35, 0.5, 0.4);
  const double volume = (high - low).prod();
  CHECK(matter_m3(boxes({{low, high}})) == Approx(volume).epsilon(kSurfaceCells));
  CHECK(matter_m3(boxes({{low, high}}, true)) == Approx(volume).epsilon(kSurfaceCells));  // without a lid
  CHECK(matter_m3(boxes({{low, high}, {0.5 * low, 0.5 * high}})) ==
        Approx(volume).epsilon(kSurfaceCells));  // an eye
}

TEST_CASE("two_walls_of_a_corner_enclose_nothing") {
  const Vector3 low(-0.35, -0.5, -0.4), high(0.35, 0.5, 0.4);
  Character corner = boxes({{low, high}});
  std::erase_if(corner.triangles, [&](const std::array<int, 3>& t) {
    const auto all = [&](int axis) {
      return std::all_of(t.begin(), t.end(),
                         [&](int v) { return corner.positions[static_cast<size_t>(v)][axis] == low[axis]; });
    };
    return !all(0) && !all(1);
  });
  const double walls = 0.8 * (0.7 + 1.0) * kCell / 3;  // one fine cell thick
  CHECK(matter_m3(corner) < 1.5 * walls);
}

TEST_CASE("parts_that_do_not_meet_share_no_node") {
  const std::array<Vector3, 2> left = {Vector3(-0.4, -0.5, -0.2), Vector3(0, 0.5, 0.2)};
  const auto right = [](double gap) {
    return std::array<Vector3, 2>{Vector3(gap, -0.5, -0.2), Vector3(gap + 0.4, 0.5, 0.2)};
  };
  CHECK(separate_parts(boxes({left, right(0.5 * kCell)})) == 2);  // less than a voxel apart
  auto touching = right(0.002 * kCell);
  CHECK(separate_parts(boxes({left, touching})) == 2);
  touching[1].x() -= 0.03;  // the grid lies otherwise now: the gap falls between two cells' centres
  CHECK(separate_parts(boxes({left, touching})) == 2);
  CHECK(separate_parts(boxes({left, right(-0.5 * kCell)})) == 1);  // overlapping
}

TEST_CASE("a_thin_plate_has_one_connected_layer_of_voxels") {
  Character plate = boxes({{Vector3(-0.5, -0.5, 0), Vector3(0.5, 0.5, 0.001)}});
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.4, Vector3(1, 0.5, 0).normalized()).toRotationMatrix();
  for (Vector3& p : plate.positions) p = tilt * p;
  for (Vector3& n : plate.normals) n = tilt * n;
  const VoxelMatter matter(plate, kCell, 3);
  const CageTopology topology(matter);
  CHECK(separate_parts(topology) == 1);
  CHECK(topology.tetrahedra.size() >= 5 * 100);
}

TEST_CASE("cage_tetrahedra_have_positive_volume_and_full_fill_inside") {
  Bar bar;
  bar.recipe.voxels_high = 9;  // voxels stand out over the surface
  const Cage cage = build_cage(bar.character, bar.layout, bar.recipe);
  double filled = 0;
  for (size_t e = 0; e < cage.tetrahedra.size(); ++e) {
    const auto at = [&](size_t a) { return cage.nodes[static_cast<size_t>(cage.tetrahedra[e][a])]; };
    const double volume = (at(1) - at(0)).dot((at(2) - at(0)).cross(at(3) - at(0))) / 6;
    CHECK(volume > 0);
    filled += volume * cage.fill[e];
  }
  CHECK(filled == Approx(0.4 * 0.4 * 1).epsilon(0.15));
}

TEST_CASE("embedding_reproduces_linear_fields") {
  const Bar bar;
  const Cage cage = build_cage(bar.character, bar.layout, bar.recipe);
  const auto field = [](const Vector3& p) { return 3 + Vector3(1, -2, 5).dot(p); };
  for (size_t v = 0; v < bar.character.positions.size(); ++v) {
    const Cage::Place& place = cage.surface[v];
    double value = 0, sum = 0;
    for (size_t a = 0; a < 4; ++a) {
      const auto node = static_cast<size_t>(cage.tetrahedra[static_cast<size_t>(place.tetrahedron)][a]);
      value += place.weight[a] * field(cage.nodes[node]);
      sum += place.weight[a];
    }
    CHECK(std::abs(sum - 1) < kRounding);
    CHECK(std::abs(value - field(bar.character.positions[v])) < kRounding);
  }
}

TEST_CASE("cage_nodes_blend_skin_like_the_surface_around_them") {
  constexpr double kSmoothed = 0.08;  // of a weight that runs from 0 to 1: what smoothing takes at the ends
  const Bar bar;
  const Cage cage = build_cage(bar.character, bar.layout, bar.recipe);
  for (size_t i = 0; i < cage.nodes.size(); ++i) {
    double upper = 0, sum = 0;
    for (size_t k = 0; k < kInfluences; ++k) {
      sum += cage.skin[i].weight[k];
      if (cage.skin[i].joint[k] == 1) upper += cage.skin[i].weight[k];
    }
    CHECK(std::abs(sum - 1) < kRounding);
    CHECK(std::abs(upper - std::clamp(0.5 + cage.nodes[i].y(), 0.0, 1.0)) < kSmoothed);
  }
}

TEST_CASE("rigid_flesh_and_bone_cores_are_held_and_soft_flesh_is_free") {
  Bar bar;
  const auto share_free = [&](const std::function<bool(const Vector3&)>& where) {
    const Cage cage = build_cage(bar.character, bar.layout, bar.recipe);
    double free = 0, all = 0;
    for (size_t i = 0; i < cage.nodes.size(); ++i) {
      if (!where(cage.nodes[i])) continue;
      all += 1;
      free += !cage.constrained[i];
    }
    return free / all;
  };
  const auto low = [](const Vector3& p) { return p.y() < -0.25; };
  const auto high_skin = [](const Vector3& p) {
    return p.y() > 0.15 && std::max(std::abs(p.x()), std::abs(p.z())) > 0.16;
  };
  const auto high_core = [](const Vector3& p) {
    return p.y() > 0.15 && p.y() < 0.4 && p.head<1>().norm() + std::abs(p.z()) < 0.06;
  };
  CHECK(share_free(low) == 0);
  CHECK(share_free(high_skin) == 1);
  CHECK(share_free(high_core) == 0);
  bar.recipe.coreless_joints = {"joint_*"};
  CHECK(share_free(low) == 0);
  CHECK(share_free(high_core) == 1);
}

TEST_CASE("soft_parts_that_hang_on_nothing_are_held") {
  Bar bar;  // and a soft crumb beside it
  const size_t before = bar.character.positions.size();
  add_box(bar.character, {0.6, 0.2, 0}, {0.8, 0.4, 0.2}, 0.05, 1);
  for (size_t v = before; v < bar.character.positions.size(); ++v) {
    bar.layout.stiffness.push_back(0);
    bar.layout.regions[0].vertices.push_back(static_cast<int>(v));
  }
  bar.recipe.coreless_joints = {"joint_*"};
  const Cage cage = build_cage(bar.character, bar.layout, bar.recipe);
  bool free_bar = false;
  for (size_t i = 0; i < cage.nodes.size(); ++i) {
    if (cage.nodes[i].x() > 0.5)
      CHECK(cage.constrained[i]);
    else
      free_bar = free_bar || !cage.constrained[i];
  }
  CHECK(free_bar);
}

TEST_CASE("stiffness_maps_to_the_recipes_moduli") {
  const Bar bar;
  const Cage cage = build_cage(bar.character, bar.layout, bar.recipe);
  for (size_t e = 0; e < cage.tetrahedra.size(); ++e) {
    const double young = cage.young_pa[e] / cage.fill[e];
    CHECK(young >= bar.recipe.young_soft_pa * (1 - kRounding));
    CHECK(young <= bar.recipe.young_stiff_pa * (1 + kRounding));
  }
}

TEST_CASE("cells_grow_where_too_much_is_soft_unless_the_recipe_states_how_many") {
  Bar bar;
  bar.character = bare_character({Vector3(0, -0.45, 0), Vector3(0, 0.45, 0)});
  add_box(bar.character, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 0.2, 0);
  bar.layout.stiffness.assign(bar.character.positions.size(), 0.1);
  bar.layout.regions[0].vertices.clear();
  for (size_t v = 0; v < bar.character.positions.size(); ++v)
    bar.layout.regions[0].vertices.push_back(static_cast<int>(v));
  bar.recipe.core_share = 0.2;
  const auto free = [](const Cage& cage) {
    return std::count(cage.constrained.begin(), cage.constrained.end(), false);
  };
  bar.recipe.voxels_high.reset();
  const Cage bounded = build_cage(bar.character, bar.layout, bar.recipe);
  CHECK(free(bounded) <= kMostFreeNodes);
  CHECK(free(bounded) > kMostFreeNodes / 2);
  REQUIRE(bounded.notes.size() == 1);
  CHECK_THAT(bounded.notes[0], Catch::Contains("voxels_high"));
  bar.recipe.voxels_high = 24;
  const Cage stated = build_cage(bar.character, bar.layout, bar.recipe);
  CHECK(free(stated) > kMostFreeNodes);
  CHECK(stated.notes.empty());
}

TEST_CASE("cells_shrink_where_little_is_soft") {
  // The tip of a post, two cells thick at the usual resolution.
  Character character = bare_character({Vector3(0, 0, 0)});
  add_box(character, {-0.02, 0, -0.02}, {0.02, 1, 0.02}, 0.02, 0);
  TissueLayout layout;
  layout.regions.emplace_back();
  for (size_t v = 0; v < character.positions.size(); ++v) {
    const bool soft = character.positions[v].y() > 0.7;
    layout.stiffness.push_back(soft ? 0 : 1);
    if (soft) layout.regions[0].vertices.push_back(static_cast<int>(v));
  }
  Recipe recipe;
  recipe.coreless_joints = {"joint_0"};
  const auto free = [](const Cage& cage) {
    return std::count(cage.constrained.begin(), cage.constrained.end(), false);
  };
  const Cage chosen = build_cage(character, layout, recipe);
  CHECK(chosen.cell_m == Approx(1.0 / kMostVoxelsHigh));  // even so fewer than kFewFreeNodes are free
  recipe.voxels_high = kUsualVoxelsHigh;
  CHECK(free(chosen) > 2 * free(build_cage(character, layout, recipe)));
}

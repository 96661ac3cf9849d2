// layers.cpp  What lies on flesh moves with it, and what only passes by does not.
#include "baker/mesh/regions/layers.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "baker/mesh/graph/tissue_layout.hpp"
#include "column.hpp"

using namespace sinew::baker;

namespace {

// The column (radius 0.2 m, 2 m high) reaches 0.03 m by default; its flesh is soft between these heights.
constexpr double kLow = 0.7, kHigh = 1.3, kRadius = 0.2;
constexpr int kSides = 24, kRingVertices = kSides + 1, kRings = 41;
// Of a carry weight. What lies on a vertex lies on nothing else; from inside, the flats between are nearer.
constexpr double kAlike = 1e-9, kAlikeInside = 0.03;

Character soft_column() {
  Character character = column();
  for (const Vector3& place : character.positions)
    character.stiffness.push_back(place.y() > kLow && place.y() < kHigh ? 0.1 : 1.0);
  return character;
}

int ring_vertex(int ring, int side) { return ring * kRingVertices + side % kSides; }

// A tube about the column between these rings, moved as it is; inside_out: it faces the column. Returns its
// first vertex.
int add_tube(Character& character, double radius, int first_ring, int last_ring, double stiffness,
             bool inside_out = false) {
  const int first = static_cast<int>(character.positions.size());
  for (int ring = first_ring; ring <= last_ring; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const auto like = static_cast<size_t>(ring_vertex(ring, side));
      const Vector3 place = character.positions[like], out = character.normals[like];
      character.positions.push_back(place + (radius - kRadius) * out);
      character.normals.push_back(inside_out ? Vector3(-out) : out);
      character.skin.push_back(character.skin[like]);
      character.colors.push_back({255, 255, 255, 255});
      character.welded.push_back(static_cast<int>(character.positions.size()) - 1);
      character.stiffness.push_back(stiffness);
    }
  for (int ring = 0; ring < last_ring - first_ring; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const int a = first + ring * kSides + side, b = first + ring * kSides + (side + 1) % kSides;
      std::array<int, 3> one = {a, a + kSides, b}, other = {b, a + kSides, b + kSides};
      if (inside_out) std::swap(one[0], one[1]), std::swap(other[0], other[1]);
      character.triangles.push_back(one), character.triangles.push_back(other);
    }
  return first;
}

// Of a tube whose first ring is beside the column's ring `begins`, these rings, out of reach.
void push_out(Character& character, int first, int begins, int from_ring, int to_ring) {
  for (int ring = from_ring; ring <= to_ring; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const auto v = static_cast<size_t>(first + (ring - begins) * kSides + side);
      character.positions[v] += 0.06 * character.normals[v];
    }
}

// A ribbon of vertices on one bone, from `from` to `to`.
int add_ribbon(Character& character, const Vector3& from, const Vector3& to, int joint) {
  constexpr int kSteps = 10;
  const int first = static_cast<int>(character.positions.size());
  for (int step = 0; step <= kSteps; ++step)
    for (const double aside : {-0.01, 0.01}) {
      character.positions.push_back(from + (to - from) * step / kSteps + Vector3(0, aside, 0));
      character.normals.push_back(Vector3::UnitX());
      character.skin.emplace_back();
      character.skin.back().joint[0] = joint;
      character.skin.back().weight[0] = 1;
      character.colors.push_back({255, 255, 255, 255});
      character.welded.push_back(static_cast<int>(character.positions.size()) - 1);
      character.stiffness.push_back(1);
    }
  for (int v = first; v + 3 < static_cast<int>(character.positions.size()); v += 2)
    character.triangles.push_back({v, v + 1, v + 2}), character.triangles.push_back({v + 1, v + 3, v + 2});
  return first;
}

size_t carried_from(const TissueLayout& layout, int first) {
  size_t count = 0;
  for (const Region& region : layout.regions)
    count +=
        static_cast<size_t>(std::ranges::count_if(region.vertices, [&](const int v) { return v >= first; }));
  return count;
}

// Each of a tube's vertices over soft skin is in the one region and carried as the vertex beneath it.
void check_worn(const TissueLayout& layout, int first, int first_ring, int last_ring, double alike = kAlike) {
  REQUIRE(layout.regions.size() == 1);
  const Region& region = layout.regions[0];
  const auto index = [&](int vertex) {
    const auto at = std::ranges::lower_bound(region.vertices, vertex);
    return at == region.vertices.end() || *at != vertex ? region.vertices.size()
                                                        : static_cast<size_t>(at - region.vertices.begin());
  };
  for (int ring = first_ring; ring <= last_ring; ++ring)
    for (int side = 0; side < kSides; ++side) {
      const int own = first + (ring - first_ring) * kSides + side, beneath = ring_vertex(ring, side);
      const bool soft = layout.stiffness[static_cast<size_t>(beneath)] < Recipe().rigid_stiffness;
      CHECK((index(own) < region.vertices.size()) == soft);
      CHECK(layout.stiffness[static_cast<size_t>(own)] ==
            Approx(layout.stiffness[static_cast<size_t>(beneath)]));
      if (!soft) continue;
      double apart = 0;
      for (const auto& weights : region.carry)
        apart = std::max(apart, std::abs(weights[index(own)] - weights[index(beneath)]));
      CHECK(apart < alike);
    }
}

}  // namespace

TEST_CASE("a_surface_of_one_piece_has_no_layers_and_no_reach_finds_none") {
  Character character = soft_column();
  const Surface bare = find_surface(character);
  const auto none = [](const std::vector<Overlap>& overlaps) {
    return std::ranges::all_of(overlaps, [](const Overlap& overlap) { return overlap.triangle < 0; });
  };
  const std::vector<bool> soft(character.positions.size(), true);
  CHECK(none(find_overlaps(character, bare, soft, 1)));
  add_tube(character, 0.21, 10, 30, 1);
  const Surface dressed = find_surface(character);
  const std::vector<bool> all(character.positions.size(), true), nothing(all.size(), false);
  CHECK_FALSE(none(find_overlaps(character, dressed, all, 0.03)));
  for (const double reach : {0.0, -1.0, std::nan("")})
    CHECK(none(find_overlaps(character, dressed, all, reach)));
  CHECK(none(find_overlaps(character, dressed, nothing, 0.03)));
}

TEST_CASE("a_shirt_is_carried_by_the_nodes_of_the_flesh_beneath_however_it_is_painted") {
  for (const double paint : {0.1, 0.5, 1.0}) {
    INFO(paint);
    Character character = soft_column();
    const int first = add_tube(character, 0.21, 10, 30, paint);
    const TissueLayout layout = layout_tissue(character, {});
    check_worn(layout, first, 10, 30);
    for (const ControlNode& node : layout.nodes) CHECK(node.vertex < first);
    const TissueLayout coarser = coarser_layout(character, {}, layout, {layout.nodes.front().vertex}, 12);
    REQUIRE(coarser.nodes.size() == 12);
    check_worn(coarser, first, 10, 30);
  }
}

TEST_CASE("the_inside_of_a_mouth_moves_with_the_cheek_over_it") {
  Character character = soft_column();
  const int first = add_tube(character, 0.185, 12, 28, 1, true);
  check_worn(layout_tissue(character, {}), first, 12, 28, kAlikeInside);
}

TEST_CASE("shells_of_fur_lie_on_the_skin_through_one_another") {
  Character character = soft_column();
  std::vector<int> shells;
  for (const double radius : {0.23, 0.22, 0.21}) shells.push_back(add_tube(character, radius, 10, 30, 0.1));
  Recipe recipe;
  recipe.layer_m = 0.012;  // each reaches the next one alone
  const TissueLayout layout = layout_tissue(character, recipe);
  for (const int first : shells) check_worn(layout, first, 10, 30);
}

TEST_CASE("a_recipe_states_how_far_layers_reach_and_nought_parts_them") {
  for (const double layer_m : {0.0, 0.009, 0.011}) {
    Character character = soft_column();
    const int first = add_tube(character, 0.21, 10, 30, 0.1);
    Recipe recipe;
    recipe.layer_m = layer_m;
    const TissueLayout layout = layout_tissue(character, recipe);
    INFO(layer_m);
    CHECK(layout.regions.size() == (layer_m > 0.01 ? 1 : 2));
    CHECK(carried_from(layout, first) > 0);
  }
}

TEST_CASE("what_other_bones_move_lies_on_nothing") {
  Character character = soft_column();
  const auto first = static_cast<size_t>(add_tube(character, 0.21, 10, 30, 1));
  for (size_t v = first; v < character.skin.size(); ++v) {
    character.skin[v] = {};
    character.skin[v].joint[0] = 0;
    character.skin[v].weight[0] = v % 2 ? 1 : 0.9;
    if (v % 2 == 0) character.skin[v].joint[1] = 3, character.skin[v].weight[1] = 0.1;
  }
  CHECK(carried_from(layout_tissue(character, {}), static_cast<int>(first)) == 0);
}

TEST_CASE("a_button_moves_with_the_flesh_it_is_on_and_a_sword_beside_it_does_not_bend") {
  Character character = soft_column();  // about y = 0.75 skin is wholly on bone_1
  const Vector3 on(kRadius + 0.004, 0.76, 0);
  const int button = add_ribbon(character, on + Vector3(0, 0, -0.01), on + Vector3(0, 0, 0.01), 1);
  const int sword = add_ribbon(character, on + Vector3(0, 0.05, 0), on + Vector3(0, 0.05, 1), 1);
  const TissueLayout layout = layout_tissue(character, {});
  CHECK(carried_from(layout, button) == static_cast<size_t>(sword - button));
  CHECK(carried_from(layout, sword) == 0);
}

TEST_CASE("a_flounce_that_stands_off_moves_with_the_flesh_that_it_hangs_on") {
  Character character = soft_column();
  const int first = add_tube(character, 0.21, 18, 30, 0.1);
  push_out(character, first, 18, 18, 22);  // its lowest rings
  const TissueLayout layout = layout_tissue(character, {});
  REQUIRE(layout.regions.size() == 1);
  CHECK(std::ranges::any_of(layout.nodes, [&](const ControlNode& node) { return node.vertex >= first; }));
}

TEST_CASE("a_layer_over_two_soft_parts_does_not_join_them") {
  Character character = column();
  for (const Vector3& place : character.positions) {
    const double y = place.y();
    character.stiffness.push_back((y > 0.4 && y < 0.8) || (y > 1.0 && y < 1.5) ? 0.1 : 1.0);
  }
  const int first = add_tube(character, 0.21, 4, 36, 0.1);
  push_out(character, first, 4, 15, 22);
  const TissueLayout layout = layout_tissue(character, {});
  REQUIRE(layout.regions.size() == 3);  // the third is what stands off between
  CHECK(carried_from(layout, first) > 0);
}

// layout_tissue.cpp  Regions, nodes, graph and carry weights of a column with painted rings.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "baker/common/bad_input.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "column.hpp"

using namespace sinew::baker;

namespace {

constexpr double kSolved = 1e-9;  // a dense solve of some 160 unknowns, well scaled
constexpr double kSmoothError =
    0.06;  // of the largest displacement: 40 nodes under a bump the size of the region
// Nodes keep some 10 cm clear of the rim; the skin one ring, 5 cm, from it is half way up the slope between.
constexpr double kNearRim = 0.6;

// Soft where y lies between low and high, rigid elsewhere.
Character painted_column(double low, double high) {
  Character character = column();
  for (const Vector3& place : character.positions)
    character.stiffness.push_back(place.y() > low && place.y() < high ? 0.1 : 1.0);
  return character;
}

std::string refusal(Character character, const Recipe& recipe) {
  try {
    layout_tissue(character, recipe);
  } catch (const BadInput& error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  return "laid out";
}

bool connected(const TissueLayout& layout, const Region& region) {
  std::set<int> reached = {region.first_node};
  for (size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const auto& [a, b] : layout.edges) {
      if (reached.contains(a)) reached.insert(b);
      if (reached.contains(b)) reached.insert(a);
    }
  }
  return static_cast<int>(reached.size()) == region.node_count;
}

void check_layout(const Character& character, const TissueLayout& layout, const Recipe& recipe) {
  REQUIRE(!layout.regions.empty());
  REQUIRE(layout.stiffness.size() == character.positions.size());
  std::set<std::string> names;
  int next_node = 0;
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    const Region& region = layout.regions[r];
    INFO(region.name);
    CHECK(names.insert(region.name).second);
    CHECK(region.first_node == next_node);
    next_node += region.node_count;
    CHECK(region.node_count >= 1);
    CHECK(region.node_count <= recipe.nodes_per_region);
    CHECK(region.radius_m > 0);
    CHECK(region.carry.size() == static_cast<size_t>(region.node_count));
    CHECK(std::is_sorted(region.vertices.begin(), region.vertices.end()));
    CHECK(connected(layout, region));
    for (int v : region.vertices) CHECK(layout.stiffness[static_cast<size_t>(v)] < recipe.rigid_stiffness);
    for (int n = region.first_node; n < next_node; ++n) {
      const ControlNode& node = layout.nodes[static_cast<size_t>(n)];
      CHECK(node.region == static_cast<int>(r));
      CHECK(character.welded[static_cast<size_t>(node.vertex)] == node.vertex);
      const auto at = std::lower_bound(region.vertices.begin(), region.vertices.end(), node.vertex);
      REQUIRE((at != region.vertices.end() && *at == node.vertex));
      const auto place = static_cast<size_t>(at - region.vertices.begin());
      for (int other = 0; other < region.node_count; ++other)
        CHECK(region.carry[static_cast<size_t>(other)][place] ==
              Approx(region.first_node + other == n ? 1 : 0).margin(kSolved));
    }
  }
  CHECK(layout.nodes.size() == static_cast<size_t>(next_node));
  std::set<std::pair<int, int>> edges;
  for (const auto& [a, b] : layout.edges) {
    CHECK(a < b);
    CHECK(edges.insert({a, b}).second);
    CHECK(layout.nodes[static_cast<size_t>(a)].region == layout.nodes[static_cast<size_t>(b)].region);
  }
}

// A node on every fifth vertex or so of these columns.
Recipe with_few_nodes() {
  Recipe recipe;
  recipe.nodes_per_region = 40;
  return recipe;
}

// Largest error of carrying field(place), known at the nodes, to the region's vertices.
template <class Field>
double carrying_error(const Character& character, const TissueLayout& layout, const Region& region,
                      Field field) {
  double worst = 0;
  for (size_t p = 0; p < region.vertices.size(); ++p) {
    double carried = 0;
    for (size_t n = 0; n < region.carry.size(); ++n)
      carried +=
          region.carry[n][p] * field(layout.nodes[static_cast<size_t>(region.first_node) + n].position);
    worst = std::max(worst,
                     std::abs(carried - field(character.positions[static_cast<size_t>(region.vertices[p])])));
  }
  return worst;
}

}  // namespace

TEST_CASE("characters_that_cannot_be_laid_out_are_refused_by_name") {
  Recipe wrong;
  wrong.regions = {{"belly", {"bone_7"}, 0.1}};
  CHECK(
      refusal(column(), wrong).find("region 'belly': no joint is named 'bone_7'; the nearest is 'bone_0'") !=
      std::string::npos);
  wrong.regions = {{"belly", {"ear_*"}, 0.1}};
  CHECK(refusal(column(), wrong).find("'ear_*'") != std::string::npos);
  Recipe coreless;
  coreless.regions = {{"belly", {"bone_1"}, 0.1}};
  coreless.coreless_joints = {"tale"};
  CHECK(refusal(column(), coreless).find("coreless_joints") != std::string::npos);
}

TEST_CASE("painted_rings_become_regions_with_connected_nodes_inside") {
  Character character = painted_column(0.62, 0.88);
  for (size_t v = 0; v < character.positions.size(); ++v)
    if (character.positions[v].y() > 1.2) character.stiffness[v] = 0.3;
  const Recipe recipe = with_few_nodes();
  const TissueLayout layout = layout_tissue(character, recipe);
  check_layout(character, layout, recipe);
  REQUIRE(layout.regions.size() == 2);
  CHECK(layout.regions[0].name == "bone_1");
  CHECK(layout.regions[0].node_count == 40);
  CHECK(joint_name(character, static_cast<size_t>(layout.regions[1].frame_joint)) ==
        "bone_2");  // its only rim is at y = 1.2
  // Rings strictly inside, each of 24 and its doubled seam vertex.
  CHECK(layout.regions[0].vertices.size() == 5 * 25);
}

TEST_CASE("a_region_touches_the_body_where_the_recipe_s_region_that_it_is_of_says_so") {
  Character character = painted_column(0.62, 0.88);
  for (size_t v = 0; v < character.positions.size(); ++v)
    if (character.positions[v].y() > 1.2) character.stiffness[v] = 0.3;
  Recipe recipe;
  recipe.regions = {{"belly", {"bone_1"}, 0.1, true}, {"head", {"bone_3"}}};
  const TissueLayout layout = layout_tissue(character, recipe);
  REQUIRE(layout.regions.size() == 2);
  CHECK(layout.regions[0].name == "belly");
  CHECK(layout.regions[0].touches_body);
  CHECK(layout.regions[1].name == "head");
  CHECK_FALSE(layout.regions[1].touches_body);
  const TissueLayout coarser =
      coarser_layout(character, recipe, layout, {layout.nodes[0].vertex, layout.nodes.back().vertex}, 10);
  CHECK(coarser.regions[0].touches_body);
  CHECK_FALSE(coarser.regions[1].touches_body);
}

// Held at the finest level's last node, which none of the coarser ones would choose by itself.
TEST_CASE("nodes_of_a_coarser_layout_are_nodes_of_the_finer_one_and_the_one_that_holds_is_among_them") {
  for (const int finest_nodes : {40, 600}) {  // more than a few are put in another order
    Character character = painted_column(0.22, 1.78);
    Recipe recipe;
    recipe.nodes_per_region = finest_nodes;
    const TissueLayout finest = layout_tissue(character, recipe);
    REQUIRE(finest.regions.size() == 1);
    const int held = finest.nodes.back().vertex;
    std::vector<int> finer;
    for (const ControlNode& node : finest.nodes) finer.push_back(node.vertex);
    for (const int nodes : {20, 10, 4}) {
      const TissueLayout coarse = coarser_layout(character, recipe, finest, {held}, nodes);
      check_layout(character, coarse, recipe);
      REQUIRE(coarse.nodes.size() == static_cast<size_t>(nodes));
      CHECK(coarse.regions[0].name == finest.regions[0].name);
      CHECK(coarse.regions[0].vertices == finest.regions[0].vertices);
      CHECK(coarse.regions[0].radius_m == finest.regions[0].radius_m);
      std::vector<int> vertices;
      for (const ControlNode& node : coarse.nodes) vertices.push_back(node.vertex);
      CHECK(std::ranges::count(vertices, held) == 1);
      auto next = finer.begin();  // in the finer one's order
      for (const int vertex : vertices) {
        next = std::find(next, finer.end(), vertex);
        REQUIRE(next != finer.end());
      }
      finer = vertices;
    }
  }
}

// Sampled from all over the part, the nodes of half the edges would be a third of the region apart.
TEST_CASE("many_nodes_of_a_region_stand_near_their_neighbours") {
  Character character = painted_column(0.22, 1.78);
  Recipe recipe;
  recipe.nodes_per_region = 4096;
  const TissueLayout layout = layout_tissue(character, recipe);
  check_layout(character, layout, recipe);
  REQUIRE(layout.nodes.size() > 500);
  int widest = 0;
  for (const auto& [a, b] : layout.edges) widest = std::max(widest, b - a);
  CHECK(widest <= 4 * 24);  // a ring holds 24, and neighbours are at most two rings apart
}

TEST_CASE("nodes_start_at_the_softest_vertex_and_spread") {
  Character character = painted_column(0.5, 1.5);
  character.stiffness[500] = 0.05;
  const TissueLayout layout = layout_tissue(character, with_few_nodes());
  CHECK(layout.nodes[0].vertex == 500);
  double closest = 1;
  for (const ControlNode& a : layout.nodes)
    for (const ControlNode& b : layout.nodes)
      if (a.vertex != b.vertex) closest = std::min(closest, (a.position - b.position).norm());
  CHECK(closest > 0.1);  // 40 nodes on 1.2 m2 stand 0.17 m apart on average
}

TEST_CASE("carrying_reproduces_linear_fields_and_follows_smooth_ones") {
  const Character painted = painted_column(1.0, 3.0);  // one rim, at y = 1
  Character character = painted;
  const TissueLayout layout = layout_tissue(character, {});
  const Region& region = layout.regions.at(0);
  CHECK(carrying_error(character, layout, region, [](const Vector3& place) { return place.y() - 1; }) <
        kSolved);
  const auto bend = [](const Vector3& place) { return (place.y() - 1) * (place.y() - 1); };  // 1 at the top
  CHECK(carrying_error(character, layout, region, bend) < kSmoothError);
}

TEST_CASE("the_skin_next_to_the_rim_hardly_moves") {
  Character character = painted_column(0.5, 1.0);
  const TissueLayout layout = layout_tissue(character, with_few_nodes());
  const Region& region = layout.regions.at(0);
  for (size_t p = 0; p < region.vertices.size(); ++p) {
    const double y = character.positions[static_cast<size_t>(region.vertices[p])].y();
    if (y > 0.56 && y < 0.94) continue;
    double sum = 0;
    for (const auto& weights : region.carry) sum += weights[p];
    CHECK(std::abs(sum) < kNearRim);
  }
}

TEST_CASE("vertices_doubled_by_a_seam_are_carried_alike") {
  Character character = painted_column(0.5, 1.5);
  const TissueLayout layout = layout_tissue(character, {});
  const Region& region = layout.regions.at(0);
  int doubled = 0;
  for (size_t p = 0; p < region.vertices.size(); ++p) {
    const int welded = character.welded[static_cast<size_t>(region.vertices[p])];
    const auto at = std::lower_bound(region.vertices.begin(), region.vertices.end(), welded);
    REQUIRE((at != region.vertices.end() && *at == welded));
    doubled += welded != region.vertices[p] ? 1 : 0;
    for (const auto& weights : region.carry)
      CHECK(weights[p] == weights[static_cast<size_t>(at - region.vertices.begin())]);
  }
  CHECK(doubled == 19);  // one a ring
}

TEST_CASE("the_same_character_is_laid_out_the_same") {
  Character first = painted_column(0.5, 1.5), second = first;
  const TissueLayout a = layout_tissue(first, {}), b = layout_tissue(second, {});
  CHECK(a.edges == b.edges);
  CHECK(a.regions.at(0).carry == b.regions.at(0).carry);
}

TEST_CASE("specks_of_softness_are_held_with_a_note") {
  Character character = painted_column(0.5, 1.0);
  character.stiffness[900] = 0;  // one vertex at y = 1.8
  const TissueLayout layout = layout_tissue(character, {});
  CHECK(layout.regions.size() == 1);
  CHECK(layout.stiffness[900] == 1);
  CHECK(character.notes.back().find("1 soft parts of fewer than four vertices") == 0);
}

TEST_CASE("stated_regions_are_soft_over_their_bones_and_apart_from_each_other") {
  Character character = column();
  Recipe recipe;
  recipe.regions = {{"low", {"bone_0", "bone_1"}, 0.2}, {"high", {"bone_3"}, 0.4}};
  TissueLayout layout = layout_tissue(character, recipe);
  check_layout(character, layout, recipe);
  REQUIRE(layout.regions.size() == 2);
  CHECK(layout.regions[0].name == "low");
  CHECK(layout.regions[1].name == "high");
  CHECK(*std::min_element(layout.stiffness.begin(), layout.stiffness.end()) == Approx(0.2));
  for (int v : layout.regions[0].vertices) CHECK(character.positions[static_cast<size_t>(v)].y() < 1.1);

  recipe.regions = {{"low", {"bone_0", "bone_1"}, 0.2},
                    {"high", {"bone_2", "bone_3"}, 0.4}};  // they meet: the seam is held
  layout = layout_tissue(character, recipe);
  CHECK(layout.regions.size() == 2);
}

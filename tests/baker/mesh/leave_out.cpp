// leave_out.cpp  Control graphs without some of their regions.
#include "baker/mesh/graph/leave_out.hpp"

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"

using namespace sinew::baker;
using Catch::Contains;

namespace {

// Two nodes, three and one, in a chain within each.
TissueLayout three_regions() {
  TissueLayout layout;
  const char* names[] = {"belly", "cheek", "cheek 2"};
  const int nodes[] = {2, 3, 1};
  for (int r = 0; r < 3; ++r) {
    Region region;
    region.name = names[r];
    region.first_node = static_cast<int>(layout.nodes.size());
    region.node_count = nodes[r];
    region.vertices = {10 * r, 10 * r + 1};
    region.carry.assign(static_cast<size_t>(nodes[r]), {0.5, 0.5});
    for (int n = 0; n < nodes[r]; ++n) {
      if (n > 0) layout.edges.emplace_back(region.first_node + n - 1, region.first_node + n);
      layout.nodes.push_back({10 * r + n, r, Vector3::Zero(), Vector3::UnitY(), 0, {}});
    }
    layout.regions.push_back(region);
  }
  return layout;
}

}  // namespace

TEST_CASE("leaving_out_what_is_not_there_or_everything_is_refused") {
  CHECK_THROWS_WITH(leave_out(three_regions(), {"chin"}, "here"),
                    Contains("here: no region is named 'chin'; there are 'belly', 'cheek', 'cheek 2'"));
  CHECK_THROWS_WITH(leave_out(three_regions(), {"belly", "cheek*"}, "here"), Contains("keep one"));
  CHECK_THROWS_AS(leave_out(three_regions(), {""}, "here"), BadInput);
}

TEST_CASE("a_region_that_is_left_out_keeps_its_vertices_and_loses_its_nodes") {
  const TissueLayout layout = three_regions(), less = leave_out(layout, {"cheek"}, "here");
  REQUIRE(less.regions.size() == 3);
  CHECK(less.regions[1].node_count == 0);
  CHECK(less.regions[1].carry.empty());
  CHECK(less.regions[1].vertices == layout.regions[1].vertices);
  REQUIRE(less.nodes.size() == 3);
  CHECK(less.nodes[2].vertex == 20);
  CHECK(less.regions[2].first_node == 2);
  CHECK(less.edges == std::vector<std::pair<int, int>>{{0, 1}});
  const TissueLayout belly = leave_out(layout, {"cheek*"}, "here");
  CHECK(belly.nodes.size() == 2);
  CHECK(belly.regions[2].first_node == 2);
}

// graph.cpp  P = D^-1/2 (A + I) D^-1/2.
#include "baker/pack/network/graph.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sinew::baker;
using Catch::Contains;

TEST_CASE("edges_outside_the_nodes_loops_and_repeats_are_refused") {
  CHECK_THROWS_WITH(normalized_adjacency(3, {{0, 3}}, "w: edges"),
                    Contains("w: edges: edge 0 (0, 3) has an end outside the 3"));
  CHECK_THROWS_WITH(normalized_adjacency(3, {{0, 1}, {-1, 2}}, "w"), Contains("edge 1 (-1, 2)"));
  CHECK_THROWS_WITH(normalized_adjacency(3, {{1, 1}}, "w"), Contains("self-loop"));
  CHECK_THROWS_WITH(normalized_adjacency(3, {{0, 1}, {1, 0}}, "w"), Contains("(0, 1) is there twice"));
}

// A path of three nodes and a lone one: degrees with the self-loop are 2, 3, 2, 1.
//   0 -- 1 -- 2    3
TEST_CASE("the_aggregation_matrix_of_a_path_is_what_the_formula_says") {
  const GraphRows graph = normalized_adjacency(4, {{2, 1}, {0, 1}}, "path");
  CHECK(graph.rows == std::vector<uint32_t>{0, 2, 5, 7, 8});
  CHECK(graph.columns == std::vector<uint32_t>{0, 1, 0, 1, 2, 1, 2, 3});
  const float across = static_cast<float>(1 / std::sqrt(6.0));
  CHECK(graph.values == std::vector<float>{0.5f, across, across, 1.0f / 3, across, across, 0.5f, 1.0f});
}

TEST_CASE("neighbours_are_listed_without_the_node_itself_and_bad_edges_are_refused") {
  const GraphRows graph = neighbour_rows(4, {{2, 1}, {0, 1}}, "path");
  CHECK(graph.rows == std::vector<uint32_t>{0, 1, 3, 4, 4});
  CHECK(graph.columns == std::vector<uint32_t>{1, 0, 2, 1});
  CHECK(graph.values.empty());
  CHECK_THROWS_WITH(neighbour_rows(3, {{0, 3}}, "w"), Contains("(0, 3) has an end outside the 3"));
  CHECK_THROWS_WITH(neighbour_rows(3, {{1, 1}}, "w"), Contains("self-loop"));
  CHECK_THROWS_WITH(neighbour_rows(3, {{0, 1}, {1, 0}}, "w"), Contains("there twice"));
}

// node_order.cpp  Neighbours come to stand near each other, whatever order they came in.
#include "baker/mesh/graph/node_order.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <numeric>
#include <random>

using namespace sinew::baker;

namespace {

using Edges = std::vector<std::pair<int, int>>;

// A sheet of width x height nodes, joined along rows, columns and one diagonal, under other names.
Edges sheet(int width, int height, const std::vector<int>& name) {
  Edges edges;
  const auto add = [&](int x, int y, int to_x, int to_y) {
    if (to_x < width && to_y < height)
      edges.emplace_back(name[static_cast<size_t>(y * width + x)],
                         name[static_cast<size_t>(to_y * width + to_x)]);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) add(x, y, x + 1, y), add(x, y, x, y + 1), add(x, y, x + 1, y + 1);
  }
  return edges;
}

std::vector<int> shuffled_names(size_t count, uint32_t seed) {
  std::vector<int> names(count);
  std::iota(names.begin(), names.end(), 0);
  std::mt19937 random(seed);
  for (size_t k = count; k > 1; --k) std::swap(names[k - 1], names[random() % k]);
  return names;
}

// The largest distance between the places of two neighbours.
int bandwidth(const std::vector<int>& order, const Edges& edges) {
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) place[static_cast<size_t>(order[k])] = static_cast<int>(k);
  int widest = 0;
  for (const auto& [a, b] : edges)
    widest = std::max(widest, std::abs(place[static_cast<size_t>(a)] - place[static_cast<size_t>(b)]));
  return widest;
}

bool is_permutation_of_all(std::vector<int> order, size_t count) {
  std::ranges::sort(order);
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return order == all;
}

}  // namespace

TEST_CASE("an_order_holds_every_node_once_for_graphs_of_any_kind") {
  CHECK(order_by_neighbours(0, {}).empty());
  CHECK(order_by_neighbours(1, {}) == std::vector<int>{0});
  CHECK(is_permutation_of_all(order_by_neighbours(5, {}), 5));                        // nobody has neighbours
  CHECK(is_permutation_of_all(order_by_neighbours(6, {{0, 3}, {3, 5}, {1, 4}}), 6));  // three components
  const Edges edges = sheet(31, 17, shuffled_names(31 * 17, 5));
  CHECK(is_permutation_of_all(order_by_neighbours(31 * 17, edges), 31 * 17));
}

// A level of a sheet that is spread over from a corner holds at most two of its shorter sides; neighbours are
// in the same level or the next.
TEST_CASE("a_shuffled_sheet_gets_neighbours_within_a_few_rows_of_each_other") {
  constexpr int kWidth = 60, kHeight = 20;
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const std::vector<int> names = shuffled_names(kWidth * kHeight, seed);
    const Edges edges = sheet(kWidth, kHeight, names);
    std::vector<int> given(names.size());
    std::iota(given.begin(), given.end(), 0);
    CHECK(bandwidth(given, edges) > kWidth * kHeight / 2);
    CHECK(bandwidth(order_by_neighbours(names.size(), edges), edges) <= 4 * kHeight);
  }
}

TEST_CASE("the_order_of_the_edges_and_their_ends_does_not_matter") {
  Edges edges = sheet(12, 9, shuffled_names(12 * 9, 7));
  const std::vector<int> order = order_by_neighbours(12 * 9, edges);
  std::ranges::reverse(edges);
  for (auto& [a, b] : edges) std::swap(a, b);
  CHECK(order_by_neighbours(12 * 9, edges) == order);
}

TEST_CASE("parts_that_nothing_joins_stay_in_one_piece") {
  const std::vector<int> order = order_by_neighbours(6, {{0, 4}, {4, 2}, {1, 3}, {3, 5}});
  const auto even = [](int node) { return node % 2 == 0; };
  CHECK(std::is_partitioned(order.begin(), order.end(), even) !=
        std::is_partitioned(order.rbegin(), order.rend(), even));
}

// graph.cpp  Who hears whom in a graph network, and how loud.
#include "baker/pack/network/graph.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

std::string describe(const std::string& where, size_t index, std::pair<int, int> edge) {
  return where + ": edge " + std::to_string(index) + " (" + std::to_string(edge.first) + ", " +
         std::to_string(edge.second) + ") ";
}

using Neighbours = std::vector<std::vector<uint32_t>>;  // of every node, itself included, ascending

Neighbours neighbours_of(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                         const std::string& where) {
  Neighbours neighbours(nodes);
  for (size_t node = 0; node < nodes; ++node) neighbours[node].push_back(static_cast<uint32_t>(node));
  const auto inside = [&](int end) { return end >= 0 && static_cast<size_t>(end) < nodes; };
  for (size_t index = 0; index < edges.size(); ++index) {
    const auto [a, b] = edges[index];
    if (!inside(a) || !inside(b))
      throw BadInput(describe(where, index, edges[index]) + "has an end outside the " +
                     std::to_string(nodes) + " nodes");
    if (a == b)
      throw BadInput(describe(where, index, edges[index]) + "is a self-loop; the network adds those itself");
    neighbours[static_cast<size_t>(a)].push_back(static_cast<uint32_t>(b));
    neighbours[static_cast<size_t>(b)].push_back(static_cast<uint32_t>(a));
  }
  for (std::vector<uint32_t>& row : neighbours) std::sort(row.begin(), row.end());
  return neighbours;
}

void check_no_repeat(const Neighbours& neighbours, const std::string& where) {
  for (size_t node = 0; node < neighbours.size(); ++node) {
    const auto twice = std::adjacent_find(neighbours[node].begin(), neighbours[node].end());
    if (twice != neighbours[node].end())
      throw BadInput(where + ": the edge (" + std::to_string(node) + ", " + std::to_string(*twice) +
                     ") is there twice; edges are undirected, list each once");
  }
}

Neighbours checked_neighbours(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                              const std::string& where) {
  Neighbours neighbours = neighbours_of(nodes, edges, where);
  check_no_repeat(neighbours, where);
  return neighbours;
}

}  // namespace

GraphRows neighbour_rows(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                         const std::string& where) {
  const Neighbours neighbours = checked_neighbours(nodes, edges, where);
  GraphRows graph;
  graph.rows.push_back(0);
  for (size_t node = 0; node < nodes; ++node) {
    std::ranges::remove_copy(neighbours[node], std::back_inserter(graph.columns),
                             static_cast<uint32_t>(node));
    graph.rows.push_back(static_cast<uint32_t>(graph.columns.size()));
  }
  return graph;
}

GraphRows normalized_adjacency(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                               const std::string& where) {
  const Neighbours neighbours = checked_neighbours(nodes, edges, where);
  GraphRows graph;
  graph.rows.push_back(0);
  for (const std::vector<uint32_t>& row : neighbours) {
    for (uint32_t column : row) {
      const double degrees = static_cast<double>(row.size()) * static_cast<double>(neighbours[column].size());
      graph.columns.push_back(column);
      graph.values.push_back(static_cast<float>(1 / std::sqrt(degrees)));
    }
    graph.rows.push_back(static_cast<uint32_t>(graph.columns.size()));
  }
  return graph;
}

}  // namespace sinew::baker

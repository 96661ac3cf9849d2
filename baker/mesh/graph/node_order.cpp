// node_order.cpp  see node_order.hpp.
#include "baker/mesh/graph/node_order.hpp"

#include <algorithm>

namespace sinew::baker {
namespace {

using Neighbours = std::vector<std::vector<int>>;  // of each node, those with few neighbours first

Neighbours neighbours_of(size_t nodes, const std::vector<std::pair<int, int>>& edges) {
  Neighbours neighbours(nodes);
  for (const auto& [a, b] : edges) {
    neighbours[static_cast<size_t>(a)].push_back(b);
    neighbours[static_cast<size_t>(b)].push_back(a);
  }
  const auto degree = [&](int node) { return neighbours[static_cast<size_t>(node)].size(); };
  for (std::vector<int>& row : neighbours)
    std::ranges::sort(row, [&](int a, int b) { return std::pair(degree(a), a) < std::pair(degree(b), b); });
  return neighbours;
}

// Breadth first from `start` through what is not `taken`, which it takes.
std::vector<int> spread_from(int start, const Neighbours& neighbours, std::vector<bool>& taken) {
  std::vector<int> reached = {start};
  taken[static_cast<size_t>(start)] = true;
  for (size_t k = 0; k < reached.size(); ++k) {
    for (int next : neighbours[static_cast<size_t>(reached[k])]) {
      if (taken[static_cast<size_t>(next)]) continue;
      taken[static_cast<size_t>(next)] = true;
      reached.push_back(next);
    }
  }
  return reached;
}

// The last node that is reached from the last that is reached from `start`: at an end of its component.
int end_of_component(int start, const Neighbours& neighbours, const std::vector<bool>& taken) {
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<bool> seen = taken;
    start = spread_from(start, neighbours, seen).back();
  }
  return start;
}

}  // namespace

std::vector<int> order_by_neighbours(size_t nodes, const std::vector<std::pair<int, int>>& edges) {
  const Neighbours neighbours = neighbours_of(nodes, edges);
  std::vector<bool> taken(nodes);
  std::vector<int> order;
  for (size_t node = 0; node < nodes; ++node) {
    if (taken[node]) continue;
    const int start = end_of_component(static_cast<int>(node), neighbours, taken);
    const std::vector<int> component = spread_from(start, neighbours, taken);
    order.insert(order.end(), component.begin(), component.end());
  }
  std::ranges::reverse(order);
  return order;
}

}  // namespace sinew::baker

// node_order.hpp  An order of a graph's nodes in which neighbours stand near each other.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

namespace sinew::baker {

// order[k]: the node that comes k-th. Reverse Cuthill-McKee (Cuthill, McKee 1969; George 1971), component
// after component, each from a node at its end; the same for the same input, whatever the order of the edges.
// edges: undirected, within 0 .. nodes - 1. Cost O(edges log neighbours + nodes x
// components).
std::vector<int> order_by_neighbours(size_t nodes, const std::vector<std::pair<int, int>>& edges);

}  // namespace sinew::baker

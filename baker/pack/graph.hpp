// graph.hpp  The aggregation matrix of a graph network, P = D^-1/2 (A + I) D^-1/2, as compressed rows.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sinew::baker {

struct GraphRows {
  std::vector<uint32_t> rows;     // [nodes + 1]
  std::vector<uint32_t> columns;  // ascending in a row
  std::vector<float> values;
};

// Undirected edges. Throws BadInput, opening with `where`: an end outside 0 .. nodes - 1, a self-loop, an
// edge twice.
GraphRows normalized_adjacency(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                               const std::string& where);

}  // namespace sinew::baker

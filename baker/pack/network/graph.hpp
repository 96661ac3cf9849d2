// graph.hpp  Graphs of networks as compressed rows: who is whose neighbour, and the aggregation matrix
// P = D^-1/2 (A + I) D^-1/2.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace sinew::baker {

struct GraphRows {
  std::vector<uint32_t> rows;     // [nodes + 1]
  std::vector<uint32_t> columns;  // ascending in a row
  std::vector<float> values;      // of neighbour_rows: empty
};

// Undirected edges. Throws BadInput, opening with `where`: an end outside 0 .. nodes - 1, a self-loop, an
// edge twice.
GraphRows normalized_adjacency(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                               const std::string& where);

// The neighbours of each node, without itself. Throws as normalized_adjacency does.
GraphRows neighbour_rows(size_t nodes, const std::vector<std::pair<int, int>>& edges,
                         const std::string& where);

}  // namespace sinew::baker

// surface.cpp  Topology of a triangle surface.
#include "baker/creature/surface.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace sinew::baker {
namespace {

std::vector<std::pair<int, int>> directed_edges(const Surface& surface) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(surface.triangles.size() * 3);
  for (const auto& t : surface.triangles)
    for (size_t i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  return edges;
}

int count_pieces(const std::vector<std::vector<int>>& neighbours) {
  std::vector<uint8_t> seen(neighbours.size(), 0);
  std::vector<int> stack;
  int pieces = 0;
  for (size_t seed = 0; seed < neighbours.size(); ++seed) {
    if (seen[seed]) continue;
    ++pieces;
    seen[seed] = 1;
    stack.push_back(static_cast<int>(seed));
    while (!stack.empty()) {
      const int at = stack.back();
      stack.pop_back();
      for (int next : neighbours[static_cast<size_t>(at)])
        if (!std::exchange(seen[static_cast<size_t>(next)], uint8_t{1})) stack.push_back(next);
    }
  }
  return pieces;
}

}  // namespace

std::vector<std::vector<int>> vertex_neighbours(const Surface& surface) {
  std::vector<std::vector<int>> neighbours(surface.positions.size());
  for (const auto& [from, to] : directed_edges(surface)) neighbours[static_cast<size_t>(from)].push_back(to);
  return neighbours;
}

std::string why_not_a_sphere(const Surface& surface) {
  const auto edges = directed_edges(surface);
  for (size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i] == edges[i - 1]) return "an edge is shared by more than two triangles";
    if (!std::binary_search(edges.begin(), edges.end(), std::pair{edges[i].second, edges[i].first}))
      return "the surface is open";
  }
  const int pieces = count_pieces(vertex_neighbours(surface));
  if (pieces != 1) return "it is in " + std::to_string(pieces) + " pieces";
  const long euler = static_cast<long>(surface.positions.size()) - static_cast<long>(edges.size() / 2) +
                     static_cast<long>(surface.triangles.size());
  if (euler != 2) return "it has " + std::to_string((2 - euler) / 2) + " handles";
  return "";
}

}  // namespace sinew::baker

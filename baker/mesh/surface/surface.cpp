// surface.cpp  Edges, Dijkstra, connected parts.
#include "baker/mesh/surface/surface.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

namespace sinew::baker {

Surface find_surface(const Character& character) {
  Surface surface;
  surface.neighbours.resize(character.positions.size());
  for (const auto& face : character.triangles)
    for (size_t k = 0; k < 3; ++k) {
      const int a = character.welded[static_cast<size_t>(face[k])];
      const int b = character.welded[static_cast<size_t>(face[(k + 1) % 3])];
      if (a == b) continue;
      surface.neighbours[static_cast<size_t>(a)].push_back(b);
      surface.neighbours[static_cast<size_t>(b)].push_back(a);
    }
  for (auto& list : surface.neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return surface;
}

std::vector<double> distances_along(const Character& character, const Surface& surface,
                                    const std::vector<int>& part, int id, const std::vector<int>& sources) {
  using Entry = std::pair<double, int>;
  std::vector<double> distance(part.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (int source : sources) {
    distance[static_cast<size_t>(source)] = 0;
    open.push({0, source});
  }
  while (!open.empty()) {
    const auto [reached, vertex] = open.top();
    open.pop();
    if (reached > distance[static_cast<size_t>(vertex)]) continue;
    for (int next : surface.neighbours[static_cast<size_t>(vertex)]) {
      if (part[static_cast<size_t>(next)] != id) continue;
      const double way = reached + (character.positions[static_cast<size_t>(next)] -
                                    character.positions[static_cast<size_t>(vertex)])
                                       .norm();
      if (way >= distance[static_cast<size_t>(next)]) continue;
      distance[static_cast<size_t>(next)] = way;
      open.push({way, next});
    }
  }
  return distance;
}

std::vector<int> connected_parts(const Surface& surface, const std::vector<bool>& soft) {
  std::vector<int> part(soft.size(), -1), open;
  int count = 0;
  for (size_t first = 0; first < soft.size(); ++first) {
    if (!soft[first] || part[first] >= 0 || surface.neighbours[first].empty()) continue;
    part[first] = count;
    open.push_back(static_cast<int>(first));
    while (!open.empty()) {
      const auto vertex = static_cast<size_t>(open.back());
      open.pop_back();
      for (int next : surface.neighbours[vertex]) {
        if (!soft[static_cast<size_t>(next)] || part[static_cast<size_t>(next)] >= 0) continue;
        part[static_cast<size_t>(next)] = count;
        open.push_back(next);
      }
    }
    ++count;
  }
  return part;
}

}  // namespace sinew::baker

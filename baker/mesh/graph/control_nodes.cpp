// control_nodes.cpp  Sampling and connecting.
#include "baker/mesh/graph/control_nodes.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

namespace sinew::baker {
namespace {

constexpr double kSamePlace =
    1e-7;  // of a part's extent; nodes at one place would make the carry weights singular

double gap(const Character& character, int a, int b) {
  return (character.positions[static_cast<size_t>(a)] - character.positions[static_cast<size_t>(b)]).norm();
}

// First vertex with the largest value.
int farthest(const std::vector<int>& vertices, const std::vector<double>& distance) {
  int best = vertices.front();
  for (int v : vertices)
    if (distance[static_cast<size_t>(v)] > distance[static_cast<size_t>(best)]) best = v;
  return best;
}

void take_minimum(std::vector<double>& distance, const std::vector<double>& other) {
  for (size_t v = 0; v < distance.size(); ++v) distance[v] = std::min(distance[v], other[v]);
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[static_cast<size_t>(i)] != i)
    i = parent[static_cast<size_t>(i)] = parent[static_cast<size_t>(parent[static_cast<size_t>(i)])];
  return i;
}

using Edge = std::pair<int, int>;

// Kruskal over the edges that are there, then over all others by length, keeping those that join what is
// apart.
void join_apart(const std::vector<std::vector<double>>& way, std::set<Edge>& edges) {
  const int count = static_cast<int>(way.size());
  std::vector<int> parent(way.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const auto& [a, b] : edges) parent[static_cast<size_t>(find_root(parent, a))] = find_root(parent, b);
  std::vector<std::pair<double, Edge>> others;
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b)
      others.push_back({way[static_cast<size_t>(a)][static_cast<size_t>(b)], {a, b}});
  std::sort(others.begin(), others.end());
  for (const auto& [length, edge] : others) {
    if (find_root(parent, edge.first) == find_root(parent, edge.second)) continue;
    parent[static_cast<size_t>(find_root(parent, edge.first))] = find_root(parent, edge.second);
    edges.insert(edge);
  }
}

}  // namespace

std::vector<int> sample_nodes(const PartSurface& part, const std::vector<double>& stiffness, int count) {
  const auto along = [&](const std::vector<int>& sources) {
    return distances_along(part.character, part.surface, part.part, part.id, sources);
  };
  const std::vector<double> from_rim = along(part.rim);
  const auto before = [&](int a, int b) {  // softer, and of equals the one deeper inside
    const auto at = static_cast<size_t>(a), other = static_cast<size_t>(b);
    return stiffness[at] != stiffness[other] ? stiffness[at] < stiffness[other]
                                             : from_rim[at] > from_rim[other];
  };
  std::vector<int> nodes = {*std::min_element(part.vertices.begin(), part.vertices.end(), before)};
  std::vector<double> distance = along(nodes);
  double extent = 0;
  for (int v : part.vertices) extent = std::max(extent, distance[static_cast<size_t>(v)]);
  take_minimum(distance, from_rim);
  while (static_cast<int>(nodes.size()) < count) {
    const int next = farthest(part.vertices, distance);
    if (!(distance[static_cast<size_t>(next)] > kSamePlace * extent)) break;
    const bool fresh = std::none_of(nodes.begin(), nodes.end(), [&](int node) {
      return gap(part.character, node, next) <= kSamePlace * extent;
    });
    if (fresh) nodes.push_back(next);
    take_minimum(distance, along({next}));
  }
  return nodes;
}

std::vector<int> sample_rim(const Character& character, const std::vector<int>& rim, int count) {
  if (rim.empty()) return {};
  std::vector<int> chosen = {rim.front()};
  std::vector<double> distance(character.positions.size(), 0);
  for (int v : rim) distance[static_cast<size_t>(v)] = gap(character, v, chosen.front());
  while (static_cast<int>(chosen.size()) < count) {
    const int next = farthest(rim, distance);
    if (!(distance[static_cast<size_t>(next)] > 0)) break;
    chosen.push_back(next);
    for (int v : rim)
      distance[static_cast<size_t>(v)] = std::min(distance[static_cast<size_t>(v)], gap(character, v, next));
  }
  return chosen;
}

std::vector<Edge> connect_nodes(const PartSurface& part, const std::vector<int>& nodes, int neighbours) {
  std::vector<std::vector<double>> way;
  for (int node : nodes) {
    const std::vector<double> all = distances_along(part.character, part.surface, part.part, part.id, {node});
    way.emplace_back();
    for (int other : nodes) way.back().push_back(all[static_cast<size_t>(other)]);
  }
  std::set<Edge> edges;
  for (size_t a = 0; a < nodes.size(); ++a) {
    std::vector<int> order(nodes.size());
    std::iota(order.begin(), order.end(), 0);
    std::erase(order, static_cast<int>(a));
    std::stable_sort(order.begin(), order.end(), [&](int x, int y) {
      return way[a][static_cast<size_t>(x)] < way[a][static_cast<size_t>(y)];
    });
    order.resize(std::min(order.size(), static_cast<size_t>(neighbours)));
    for (int b : order) edges.insert({std::min(static_cast<int>(a), b), std::max(static_cast<int>(a), b)});
  }
  join_apart(way, edges);
  return {edges.begin(), edges.end()};
}

}  // namespace sinew::baker

// join_islands.cpp  Prim's tree over islands, a label after the other.
#include "baker/mesh/join_islands.hpp"

#include <algorithm>

namespace sinew::baker {
namespace {

struct Outside {
  int vertex = 0, island = 0;
  int nearest = -1;  // of the tree
  double gap_m = std::numeric_limits<double>::infinity();
};

// Moves an island into the tree and looks what is nearer to it than to the rest of the tree.
void absorb(const Character& character, int island, std::vector<Outside>& outside) {
  const auto in_tree =
      std::ranges::partition(outside, [&](const Outside& other) { return other.island != island; });
  const std::vector<Outside> own(in_tree.begin(), in_tree.end());
  outside.erase(in_tree.begin(), outside.end());
  for (Outside& other : outside)
    for (const Outside& from : own) {
      const double gap_m = (character.positions[static_cast<size_t>(from.vertex)] -
                            character.positions[static_cast<size_t>(other.vertex)])
                               .norm();
      if (gap_m < other.gap_m) other.gap_m = gap_m, other.nearest = from.vertex;
    }
}

void link_label(const Character& character, std::vector<Outside> outside, double most_gap_m, Links& links) {
  while (!outside.empty()) {
    const Outside next = *std::ranges::min_element(
        outside, {}, [](const Outside& other) { return std::pair(other.gap_m, other.vertex); });
    if (next.gap_m <= most_gap_m && next.nearest >= 0)
      links.emplace_back(next.nearest, next.vertex);
    else  // too far from the tree: another begins
      for (Outside& other : outside) other.gap_m = std::numeric_limits<double>::infinity();
    absorb(character, next.island, outside);
  }
}

}  // namespace

Links island_links(const Character& character, const Surface& surface, const std::vector<int>& label,
                   double most_gap_m) {
  const int labels = label.empty() ? 0 : *std::ranges::max_element(label) + 1;
  Links links;
  for (int id = 0; id < labels; ++id) {
    std::vector<bool> in(label.size());
    for (size_t v = 0; v < in.size(); ++v) in[v] = label[v] == id;
    const std::vector<int> island = connected_parts(surface, in);
    std::vector<Outside> vertices;
    for (size_t v = 0; v < in.size(); ++v)
      if (island[v] >= 0) vertices.push_back({static_cast<int>(v), island[v]});
    const bool several = std::ranges::any_of(island, [](int i) { return i > 0; });
    if (several) link_label(character, std::move(vertices), most_gap_m, links);
  }
  return links;
}

Surface with_links(Surface surface, const Links& links) {
  for (const auto& [a, b] : links) {
    surface.neighbours[static_cast<size_t>(a)].push_back(b);
    surface.neighbours[static_cast<size_t>(b)].push_back(a);
  }
  for (const auto& [a, b] : links)
    for (const int end : {a, b}) std::ranges::sort(surface.neighbours[static_cast<size_t>(end)]);
  return surface;
}

}  // namespace sinew::baker

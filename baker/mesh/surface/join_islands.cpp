// join_islands.cpp  Prim's tree over islands, a label after the other.
#include "baker/mesh/surface/join_islands.hpp"

#include <algorithm>
#include <compare>
#include <functional>
#include <queue>

namespace sinew::baker {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The closest of a set of vertices that grows smaller: a tree of boxes that know how many are left in them.
class LeftOutside {
 public:
  // vertices: ascending.
  LeftOutside(const Character& character, const std::vector<int>& vertices)
      : character_(character),
        vertices_(vertices),
        order_(vertices),
        is_left_(vertices.size(), true),
        leaf_of_(vertices.size()),
        place_of_(vertices.size()) {
    build(0, static_cast<int>(order_.size()), -1);
    for (size_t place = 0; place < order_.size(); ++place) place_of_[index_of(order_[place])] = place;
  }

  void remove(int vertex) {
    const size_t place = place_of_[index_of(vertex)];
    is_left_[place] = false;
    for (int at = leaf_of_[place]; at >= 0; at = boxes_[static_cast<size_t>(at)].parent)
      --boxes_[static_cast<size_t>(at)].left;
  }

  struct Found {
    double gap_m = kInfinite;
    int vertex = -1;
  };
  // The first of those as near; none where nothing is within reach.
  Found nearest(int from, double reach_m) const {
    constexpr int kNobody = std::numeric_limits<int>::max();
    Found best{reach_m, kNobody};
    search(0, character_.positions[static_cast<size_t>(from)], best);
    return best.vertex == kNobody ? Found{} : best;
  }

 private:
  struct Box {
    Eigen::AlignedBox3d box = {};
    int first = 0, count = 0;  // of order_
    int left = 0, parent = -1;
    int second = 0;  // the other half's; the first one's follows its parent. 0: it has no halves
  };
  static constexpr int kFew = 8;

  size_t index_of(int vertex) const {
    return static_cast<size_t>(std::ranges::lower_bound(vertices_, vertex) - vertices_.begin());
  }
  const Vector3& place(int i) const {
    return character_.positions[static_cast<size_t>(order_[static_cast<size_t>(i)])];
  }

  int build(int first, int count, int parent) {
    const auto at = boxes_.size();
    boxes_.push_back({{}, first, count, count, parent, 0});
    for (int i = first; i < first + count; ++i) boxes_[at].box.extend(place(i));
    if (count <= kFew) {
      std::fill_n(leaf_of_.begin() + first, count, static_cast<int>(at));
      return static_cast<int>(at);
    }
    Eigen::Index axis = 0;
    boxes_[at].box.sizes().maxCoeff(&axis);
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](int a, int b) {
      return character_.positions[static_cast<size_t>(a)][axis] <
             character_.positions[static_cast<size_t>(b)][axis];
    });
    build(first, count / 2, static_cast<int>(at));
    const int second = build(first + count / 2, count - count / 2, static_cast<int>(at));
    boxes_[at].second = second;
    return static_cast<int>(at);
  }

  double away(int at, const Vector3& point) const {
    const Box& box = boxes_[static_cast<size_t>(at)];
    return box.left > 0 ? box.box.exteriorDistance(point) : kInfinite;
  }

  void search(int at, const Vector3& point, Found& best) const {
    constexpr double kRounding = 1 + 1e-12;
    const Box& box = boxes_[static_cast<size_t>(at)];
    if (box.left == 0 || away(at, point) > kRounding * best.gap_m) return;
    if (box.second > 0) {
      const bool swap = away(box.second, point) < away(at + 1, point);
      search(swap ? box.second : at + 1, point, best);
      search(swap ? at + 1 : box.second, point, best);
      return;
    }
    for (int i = box.first; i < box.first + box.count; ++i) {
      if (!is_left_[static_cast<size_t>(i)]) continue;
      const double gap_m = (point - place(i)).norm();
      const int vertex = order_[static_cast<size_t>(i)];
      if (gap_m < best.gap_m || (gap_m == best.gap_m && vertex < best.vertex)) best = {gap_m, vertex};
    }
  }

  const Character& character_;
  const std::vector<int>& vertices_;
  std::vector<int> order_;  // as the boxes have them
  std::vector<bool> is_left_;
  std::vector<int> leaf_of_;      // a place in order_
  std::vector<size_t> place_of_;  // a vertex, in order_
  std::vector<Box> boxes_;
};

// A vertex of the tree and the closest one outside of it, as it was when it was looked for: it is no nearer
// now.
struct Way {
  double gap_m = 0;
  int to = 0;
  size_t absorbed = 0;  // which of the tree's vertices, in the order in which they came to it
  int from = 0;
  auto operator<=>(const Way&) const = default;
};

// vertices: of one label, ascending. island: of each vertex, numbered by their first ones.
void link_label(const Character& character, const std::vector<int>& vertices, const std::vector<int>& island,
                double most_gap_m, Links& links) {
  const int first_island = island[static_cast<size_t>(vertices.front())];
  const auto island_of = [&](int v) {
    return static_cast<size_t>(island[static_cast<size_t>(v)] - first_island);
  };
  std::vector<std::vector<int>> members;  // an island
  for (const int v : vertices) {
    members.resize(std::max(members.size(), island_of(v) + 1));
    members[island_of(v)].push_back(v);
  }
  LeftOutside outside(character, vertices);
  std::vector<bool> in_tree(members.size(), false);
  std::priority_queue<Way, std::vector<Way>, std::greater<>> ways;
  size_t absorbed = 0;
  const auto look = [&](int from, size_t order) {
    const auto [gap_m, to] = outside.nearest(from, most_gap_m);
    if (to >= 0) ways.push({gap_m, to, order, from});
  };
  const auto absorb = [&](size_t id) {
    in_tree[id] = true;
    for (const int v : members[id]) outside.remove(v);
    for (const int v : members[id]) look(v, absorbed++);
  };
  for (size_t first = 0; first < members.size(); ++first) {
    if (in_tree[first]) continue;
    absorb(first);  // too far from the other trees
    while (!ways.empty()) {
      const Way way = ways.top();
      ways.pop();
      const size_t id = island_of(way.to);
      if (!in_tree[id]) {
        links.emplace_back(way.from, way.to);
        absorb(id);
      }
      look(way.from, way.absorbed);
    }
  }
}

// Connected parts of one label each, numbered by their labels, then by their first vertices; -1 for what
// touches nothing.
std::vector<int> islands_of(const Surface& surface, const std::vector<std::vector<int>>& of_label,
                            const std::vector<int>& label) {
  std::vector<int> island(label.size(), -1), open;
  int count = 0;
  for (const std::vector<int>& vertices : of_label)
    for (const int first : vertices) {
      if (island[static_cast<size_t>(first)] >= 0) continue;
      island[static_cast<size_t>(first)] = count;
      open.push_back(first);
      while (!open.empty()) {
        const auto vertex = static_cast<size_t>(open.back());
        open.pop_back();
        for (const int next : surface.neighbours[vertex]) {
          const auto other = static_cast<size_t>(next);
          if (label[other] != label[vertex] || island[other] >= 0) continue;
          island[other] = count;
          open.push_back(next);
        }
      }
      ++count;
    }
  return island;
}

}  // namespace

Links island_links(const Character& character, const Surface& surface, const std::vector<int>& label,
                   double most_gap_m) {
  const int labels = label.empty() ? 0 : *std::ranges::max_element(label) + 1;
  std::vector<std::vector<int>> of_label(static_cast<size_t>(std::max(0, labels)));
  for (size_t v = 0; v < label.size(); ++v)
    if (label[v] >= 0 && !surface.neighbours[v].empty())
      of_label[static_cast<size_t>(label[v])].push_back(static_cast<int>(v));
  const std::vector<int> island = islands_of(surface, of_label, label);
  Links links;
  for (const std::vector<int>& vertices : of_label) {
    const auto of = [&](int v) { return island[static_cast<size_t>(v)]; };
    if (std::ranges::any_of(vertices, [&](int v) { return of(v) != of(vertices.front()); }))
      link_label(character, vertices, island, most_gap_m, links);
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

// tree.cpp  see tree.hpp.
#include "adapters/embree/tree.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace sinew::embree {
namespace {

using simd::kSurfaceLeaf;
using simd::kSurfaceWide;
using simd::SurfaceBoxes;
using simd::SurfaceLeaf;
using simd::SurfaceNode;

constexpr uint32_t kDeepest = 9;  // of 2^26 triangles
constexpr float kFar = std::numeric_limits<float>::infinity();
// A walk puts off seven children a level, and eight of the last.
static_assert((kSurfaceWide - 1) * kDeepest + 2 <= simd::SurfaceWalk::kMostPending);

using Triangles = std::span<uint32_t>;

void clear(SurfaceBoxes* boxes) {
  std::fill_n(&boxes->low[0][0], 3 * kSurfaceWide, kFar);
  std::fill_n(&boxes->high[0][0], 3 * kSurfaceWide, -kFar);
}

// Halves by the middles along the axis that they are spread most, so that all leaves but the last are full.
class Builder {
 public:
  std::vector<SurfaceNode> nodes;
  std::vector<SurfaceLeaf> leaves;

  Builder(const Topology& topology, std::span<const float> places_m, std::span<const uint32_t> groups)
      : groups_(groups), middles_(topology.triangles.size()), order_(topology.triangles.size()) {
    for (uint32_t i = 0; i < order_.size(); ++i) {
      order_[i] = i;
      for (size_t k = 0; k < 3; ++k) {
        for (const uint32_t v : topology.triangles[i]) middles_[i][k] += places_m[3 * size_t{v} + k];
      }
    }
  }
  void build() { add_node(order_); }

 private:
  uint32_t add(Triangles of) { return of.size() <= kSurfaceWide ? add_leaf(of) : add_node(of); }

  uint32_t add_leaf(Triangles of) {
    SurfaceLeaf& leaf = leaves.emplace_back();
    leaf = {};
    for (uint32_t i = 0; i < kSurfaceWide; ++i) {
      const bool there = i < of.size();
      leaf.triangles[i] = of[there ? i : 0];
      leaf.groups[i] = !there ? 0 : groups_.empty() ? ~0u : groups_[of[i]];
    }
    return kSurfaceLeaf | static_cast<uint32_t>(leaves.size() - 1);
  }

  uint32_t add_node(Triangles of) {
    const auto made = static_cast<uint32_t>(nodes.size());
    SurfaceNode& node = nodes.emplace_back();
    node = {};
    clear(&node.boxes);
    size_t full = kSurfaceWide;  // triangles of a child
    while (full * kSurfaceWide < of.size()) full *= kSurfaceWide;
    add_children(made, 0, full, of);
    return made;
  }

  void add_children(uint32_t node, size_t first, size_t full, Triangles of) {
    if (of.size() <= full) {
      const uint32_t child = add(of);
      nodes[node].children[first] = child;
      return;
    }
    const size_t left = (of.size() + full - 1) / full / 2;
    halve(of, left * full);
    add_children(node, first, full, of.first(left * full));
    add_children(node, first + left, full, of.subspan(left * full));
  }

  void halve(Triangles of, size_t at) {
    const size_t k = widest(of);
    std::nth_element(
        of.begin(), of.begin() + static_cast<std::ptrdiff_t>(at), of.end(),
        [&](uint32_t a, uint32_t b) { return std::pair(middles_[a][k], a) < std::pair(middles_[b][k], b); });
  }

  size_t widest(Triangles of) const {
    std::array<float, 3> low = {kFar, kFar, kFar}, high = {-kFar, -kFar, -kFar}, wide;
    for (const uint32_t i : of) {
      for (size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], middles_[i][k]), high[k] = std::max(high[k], middles_[i][k]);
      }
    }
    for (size_t k = 0; k < 3; ++k) wide[k] = high[k] - low[k];
    return static_cast<size_t>(std::max_element(wide.begin(), wide.end()) - wide.begin());
  }

  std::span<const uint32_t> groups_;
  std::vector<std::array<float, 3>> middles_;  // three times those
  std::vector<uint32_t> order_;
};

float lower(float a, float b) { return a < b ? a : b; }
float higher(float a, float b) { return a > b ? a : b; }

template <class Take>
float of_lanes(const float (&lanes)[kSurfaceWide], const Take& take) {
  float half[4];
  for (size_t i = 0; i < 4; ++i) half[i] = take(lanes[i], lanes[i + 4]);
  return take(take(half[0], half[2]), take(half[1], half[3]));
}

void place_corners(const Topology& topology, const float* starts, const float* moves, const float (&drift)[3],
                   SurfaceLeaf* leaf) {
  for (size_t lane = 0; lane < kSurfaceWide; ++lane) {
    const Corners& t = topology.triangles[leaf->triangles[lane]];
    for (size_t c = 0; c < 3; ++c) {
      const float *start = starts + 3 * size_t{t[c]}, *move = moves + 3 * size_t{t[c]};
      for (size_t k = 0; k < 3; ++k) {
        leaf->corners[c][k][lane] = start[k];
        leaf->ends[c][k][lane] = start[k] + (move[k] - drift[k]);
      }
    }
  }
}

void put_box(const SurfaceLeaf& leaf, SurfaceBoxes* to, size_t lane) {
  for (size_t k = 0; k < 3; ++k) {
    float low[kSurfaceWide], high[kSurfaceWide];
    for (size_t i = 0; i < kSurfaceWide; ++i) low[i] = high[i] = leaf.corners[0][k][i];
    for (const auto* rows :
         {&leaf.corners[1][k], &leaf.corners[2][k], &leaf.ends[0][k], &leaf.ends[1][k], &leaf.ends[2][k]}) {
      for (size_t i = 0; i < kSurfaceWide; ++i)
        low[i] = lower(low[i], (*rows)[i]), high[i] = higher(high[i], (*rows)[i]);
    }
    to->low[k][lane] = of_lanes(low, lower), to->high[k][lane] = of_lanes(high, higher);
  }
}

void put_box(const SurfaceBoxes& from, SurfaceBoxes* to, size_t lane) {
  for (size_t k = 0; k < 3; ++k) {
    to->low[k][lane] = of_lanes(from.low[k], lower), to->high[k][lane] = of_lanes(from.high[k], higher);
  }
}

}  // namespace

void Tree::build(const Topology& topology, std::span<const float> places_m,
                 std::span<const uint32_t> groups) {
  Builder builder(topology, places_m, groups);
  builder.build();
  nodes_ = std::move(builder.nodes), leaves_ = std::move(builder.leaves);
  leaf_of_.resize(topology.triangles.size());
  for (uint32_t n = 0; n < leaves_.size(); ++n) {
    for (size_t k = 0; k < kSurfaceWide; ++k) {
      leaf_of_[leaves_[n].triangles[k]] = n;
    }
  }
}

void Tree::refit(const Topology& topology, std::span<const float> starts, std::span<const float> moves,
                 const float (&drift)[3]) noexcept {
  for (size_t n = nodes_.size(); n-- > 0;) {
    SurfaceNode& node = nodes_[n];
    for (size_t i = 0; i < kSurfaceWide; ++i) {
      const uint32_t child = node.children[i];
      if (child & kSurfaceLeaf) {
        SurfaceLeaf& leaf = leaves_[child & ~kSurfaceLeaf];
        place_corners(topology, starts.data(), moves.data(), drift, &leaf);
        put_box(leaf, &node.boxes, i);
      } else if (child != 0) {  // the root is nobody's child
        put_box(nodes_[child].boxes, &node.boxes, i);
      }
    }
  }
  SurfaceBoxes all;
  put_box(nodes_[0].boxes, &all, 0);
  for (size_t k = 0; k < 3; ++k) low_m_[k] = all.low[k][0], high_m_[k] = all.high[k][0];
}

size_t Tree::bytes() const noexcept {
  return leaf_of_.size() * sizeof(uint32_t) + nodes_.size() * sizeof(SurfaceNode) +
         leaves_.size() * sizeof(SurfaceLeaf);
}

}  // namespace sinew::embree

// layers.cpp  Who lies on whom, who leads, and what follows from it.
#include "baker/mesh/regions/layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "baker/mesh/surface/box_tree.hpp"
#include "baker/mesh/surface/closest_place.hpp"
#include "baker/mesh/surface/flesh_shape.hpp"

namespace sinew::baker {
namespace {

constexpr double kAlongNormal = 0.5;  // least cosine: beside the end of a piece is not over it
constexpr double kSameBones = 0.5;    // weights' differences, summed: a quarter of the weight on other bones
constexpr double kTouching = 1e-6;    // of the reach: no direction to speak of
constexpr double kBeyond = 1 + 1e-6;  // of the reach: pieces whose boxes are farther away are not asked
constexpr double kNothing = 1e-9;     // of a share

Vector3 area_vector(const Character& character, const std::array<int, 3>& face) {
  const Vector3& a = character.positions[static_cast<size_t>(face[0])];
  return 0.5 * (character.positions[static_cast<size_t>(face[1])] - a)
                   .cross(character.positions[static_cast<size_t>(face[2])] - a);
}

// A vertex beside a piece that it is no part of.
struct Candidate {
  int piece = 0;
  Overlap overlap;
  double distance_m = 0;
  bool on_soft = false;
  bool faces = false;  // it, over a gap
};

class OverlapFinder {
 public:
  OverlapFinder(const Character& character, const Surface& surface, const std::vector<bool>& soft,
                double reach_m)
      : character_(character),
        soft_(soft),
        reach_m_(reach_m),
        piece_(connected_parts(surface, std::vector<bool>(character.positions.size(), true))),
        fastened_(fastened_to(character, surface)) {}

  std::vector<Overlap> find() {
    std::vector<Overlap> overlaps(character_.positions.size());
    find_soft_pieces();
    if (trees_.empty() || pieces_ < 2) return overlaps;
    find_candidates();
    choose(overlaps);
    free_half_fastened(overlaps);
    for (size_t v = 0; v < overlaps.size(); ++v)
      overlaps[v] = overlaps[static_cast<size_t>(character_.welded[v])];
    return overlaps;
  }

 private:
  size_t welded(int vertex) const {
    return static_cast<size_t>(character_.welded[static_cast<size_t>(vertex)]);
  }

  void find_soft_pieces() {
    for (const int piece : piece_) pieces_ = std::max(pieces_, piece + 1);
    std::vector<bool> is_soft(static_cast<size_t>(pieces_), false);
    for (size_t v = 0; v < piece_.size(); ++v)
      if (piece_[v] >= 0 && soft_[v]) is_soft[static_cast<size_t>(piece_[v])] = true;
    area_m2_.resize(is_soft.size(), 0);
    std::map<int, std::vector<int>> triangles;
    for (size_t t = 0; t < character_.triangles.size(); ++t) {
      const auto& face = character_.triangles[t];
      const int piece = piece_[welded(face[0])];
      if (piece < 0) continue;
      area_m2_[static_cast<size_t>(piece)] += area_vector(character_, face).norm();
      if (is_soft[static_cast<size_t>(piece)]) triangles[piece].push_back(static_cast<int>(t));
    }
    for (auto& [piece, own] : triangles) trees_.emplace_back(piece, ClosestPlace(character_, std::move(own)));
  }

  void find_candidates() {
    candidates_.resize(piece_.size());
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const auto& [piece, tree] : trees_) boxes.push_back(tree.box());
    const BoxTree near(std::move(boxes));
    std::vector<int> found;
    for (size_t v = 0; v < piece_.size(); ++v) {
      if (piece_[v] < 0) continue;
      near.find(character_.positions[v], kBeyond * reach_m_, found);
      for (const int i : found) {
        const auto& [piece, tree] = trees_[static_cast<size_t>(i)];
        if (piece != piece_[v]) add_candidate(v, piece, tree);
      }
    }
  }

  bool same_bones(size_t vertex, const SurfacePlace& place) const {
    std::array<std::pair<int, double>, 4 * kInfluences> apart;  // a joint each
    size_t count = 0;
    const auto add = [&](int joint, double weight) {
      size_t at = 0;
      while (at < count && apart[at].first != joint) ++at;
      if (at == count) apart[count++] = {joint, 0};
      apart[at].second += weight;
    };
    const Influences& own = character_.skin[vertex];
    for (size_t k = 0; k < kInfluences; ++k) add(own.joint[k], own.weight[k]);
    const auto& face = character_.triangles[static_cast<size_t>(place.triangle)];
    for (size_t c = 0; c < 3; ++c) {
      const Influences& skin = character_.skin[static_cast<size_t>(face[c])];
      for (size_t k = 0; k < kInfluences; ++k) add(skin.joint[k], -place.share[c] * skin.weight[k]);
    }
    std::sort(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(count));
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += std::abs(apart[i].second);
    return sum <= kSameBones;
  }

  void add_candidate(size_t v, int piece, const ClosestPlace& tree) {
    const std::optional<SurfacePlace> place = tree.find(character_.positions[v], reach_m_);
    if (!place || !same_bones(v, *place)) return;
    const auto& face = character_.triangles[static_cast<size_t>(place->triangle)];
    const Vector3 normal = area_vector(character_, face).normalized(),
                  away = character_.positions[v] - place->position;
    const double height = away.dot(normal);
    const bool touches = place->distance_m <= kTouching * reach_m_;
    if (!touches && place->facing < kAlongNormal) return;
    bool on_soft = false;
    for (size_t c = 0; c < 3; ++c)
      on_soft = on_soft || (place->share[c] > kNothing && soft_[welded(face[c])]);
    const bool faces = !touches && height > 0 && character_.normals[v].dot(normal) < 0;
    candidates_[v].push_back({piece, {place->triangle, place->share}, place->distance_m, on_soft, faces});
    if (on_soft && !faces) over_soft_.insert({piece_[v], piece});
    // Of two layers that face the same way, one is above the other.
    if (!touches && character_.normals[v].dot(normal) > 0) above_[{piece_[v], piece}] += height > 0 ? 1 : -1;
  }

  bool leads(int piece, int other) const {
    const auto votes = [&](int upper, int lower) {
      const auto found = above_.find({upper, lower});
      return found == above_.end() ? 0 : found->second;
    };
    const int above = votes(other, piece) - votes(piece, other);
    if (above != 0) return above > 0;
    const double own = area_m2_[static_cast<size_t>(piece)], its = area_m2_[static_cast<size_t>(other)];
    return own != its ? own > its : piece < other;
  }

  // The inside of thick clothes faces the skin, and their outside looks where it does; two thighs face each
  // other and nothing else.
  bool look_the_same_way(int a, int b) const { return above_.contains({a, b}) || above_.contains({b, a}); }

  void choose(std::vector<Overlap>& overlaps) const {
    for (size_t v = 0; v < overlaps.size(); ++v) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Candidate& candidate : candidates_[v])
        if (candidate.distance_m < nearest && over_soft_.contains({piece_[v], candidate.piece}) &&
            leads(candidate.piece, piece_[v]) &&
            (!candidate.faces || look_the_same_way(candidate.piece, piece_[v])))
          nearest = candidate.distance_m, overlaps[v] = candidate.overlap;
    }
  }

  void free_half_fastened(std::vector<Overlap>& overlaps) const {
    std::vector<bool> whole(static_cast<size_t>(pieces_), true);
    for (size_t v = 0; v < overlaps.size(); ++v)
      if (piece_[v] >= 0 && overlaps[v].triangle < 0) whole[static_cast<size_t>(piece_[v])] = false;
    for (size_t v = 0; v < overlaps.size(); ++v)
      if (piece_[v] >= 0 && fastened_[v] >= 0 && !whole[static_cast<size_t>(piece_[v])]) overlaps[v] = {};
  }

  const Character& character_;
  const std::vector<bool>& soft_;
  const double reach_m_;
  const std::vector<int> piece_, fastened_;  // a welded vertex
  int pieces_ = 0;
  std::vector<double> area_m2_;                      // a piece
  std::vector<std::pair<int, ClosestPlace>> trees_;  // of each piece that is soft somewhere, ascending
  std::vector<std::vector<Candidate>> candidates_;
  std::map<std::pair<int, int>, int>
      above_;  // pieces: vertices of the first above the second, less those below
  std::set<std::pair<int, int>> over_soft_;  // pieces: the first has a vertex over soft flesh of the second
};

// Down through layers that lie on layers. A way that comes back to itself ends where it does.
class Resolver {
 public:
  Resolver(const Character& character, const std::vector<Overlap>& overlaps)
      : character_(character), overlaps_(overlaps), state_(overlaps.size()), lies_on_(overlaps.size()) {}

  std::vector<LiesOn> all() {
    for (size_t v = 0; v < overlaps_.size(); ++v) resolve(character_.welded[v]);
    for (size_t v = 0; v < overlaps_.size(); ++v)
      lies_on_[v] = lies_on_[static_cast<size_t>(character_.welded[v])];
    return std::move(lies_on_);
  }

 private:
  enum class State : uint8_t { kNew, kOpen, kDone };

  // False where the vertex is on the way that is being followed.
  bool resolve(int vertex) {
    const auto v = static_cast<size_t>(vertex);
    if (state_[v] != State::kNew) return state_[v] == State::kDone;
    state_[v] = State::kOpen;
    const Overlap& overlap = overlaps_[v];
    std::map<int, double> on;
    for (size_t c = 0; overlap.triangle >= 0 && c < 3; ++c) {
      if (!(overlap.share[c] > kNothing)) continue;
      const int corner =
          character_
              .welded[static_cast<size_t>(character_.triangles[static_cast<size_t>(overlap.triangle)][c])];
      if (!resolve(corner)) {
        on.clear();
        break;
      }
      const LiesOn& below = lies_on_[static_cast<size_t>(corner)];
      if (below.empty()) on[corner] += overlap.share[c];
      for (const auto& [base, share] : below) on[base] += overlap.share[c] * share;
    }
    lies_on_[v].assign(on.begin(), on.end());
    state_[v] = State::kDone;
    return true;
  }

  const Character& character_;
  const std::vector<Overlap>& overlaps_;
  std::vector<State> state_;
  std::vector<LiesOn> lies_on_;
};

int root_of(std::vector<int>& parent, int i) {
  while (parent[static_cast<size_t>(i)] != i) i = parent[static_cast<size_t>(i)];
  return i;
}

bool lies_on(const Surface& surface, size_t vertex, size_t base) {
  return std::ranges::any_of(surface.lies_on[vertex],
                             [&](const auto& on) { return static_cast<size_t>(on.first) == base; });
}

// Free flesh of a layer that hangs, by the layer's own edges, on what lies on one other part.
void join_hanging(const Surface& surface, const std::vector<bool>& free, std::vector<int>& part) {
  const int count = part.empty() ? 0 : *std::ranges::max_element(part) + 1;
  std::vector<std::set<int>> beside(static_cast<size_t>(std::max(0, count)));
  for (size_t u = 0; u < part.size(); ++u) {
    if (!free[u] || part[u] < 0) continue;
    for (const int next : surface.neighbours[u]) {
      const auto v = static_cast<size_t>(next);
      if (!free[v] && part[v] >= 0 && part[v] != part[u] && !lies_on(surface, v, u))
        beside[static_cast<size_t>(part[u])].insert(part[v]);
    }
  }
  std::vector<int> parent(beside.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (size_t p = 0; p < beside.size(); ++p)
    if (beside[p].size() == 1)
      parent[static_cast<size_t>(root_of(parent, static_cast<int>(p)))] = root_of(parent, *beside[p].begin());
  std::map<int, int> number;  // of roots, in the order of their first vertices
  for (int& own : part)
    if (own >= 0)
      own = number.try_emplace(root_of(parent, own), static_cast<int>(number.size())).first->second;
}

}  // namespace

double usual_layer_m(const Character& character) {
  Eigen::AlignedBox3d box;
  for (const Vector3& place : character.positions) box.extend(place);
  return box.isEmpty() ? 0 : kLayerShare * box.sizes().maxCoeff();
}

std::vector<Overlap> find_overlaps(const Character& character, const Surface& surface,
                                   const std::vector<bool>& soft, double reach_m) {
  if (!(reach_m > 0)) return std::vector<Overlap>(character.positions.size());
  return OverlapFinder(character, surface, soft, reach_m).find();
}

void link_layers(const Character& character, const std::vector<LiesOn>& lies_on, Surface& surface) {
  surface.lies_on = lies_on;
  for (size_t v = 0; v < lies_on.size(); ++v) {
    if (character.welded[v] != static_cast<int>(v)) continue;
    for (const auto& [base, share] : lies_on[v]) {
      surface.neighbours[v].push_back(base);
      surface.neighbours[static_cast<size_t>(base)].push_back(static_cast<int>(v));
    }
  }
  for (auto& list : surface.neighbours) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
}

void lay_on_flesh(const Character& character, const std::vector<Overlap>& overlaps, double rigid_stiffness,
                  Surface& surface, Stiffness& stiffness) {
  constexpr double kBelow = 1e-6;  // of rigid_stiffness: soft by a hair
  const std::vector<LiesOn> all = Resolver(character, overlaps).all();
  if (std::ranges::all_of(all, &LiesOn::empty)) return;
  link_layers(character, all, surface);
  for (size_t v = 0; v < surface.lies_on.size(); ++v) {
    if (surface.lies_on[v].empty()) continue;
    double sum = 0, most = 0;
    for (const auto& [base, share] : surface.lies_on[v]) {
      const auto at = static_cast<size_t>(base);
      sum += share * stiffness.of_vertex[at];
      if (stiffness.of_vertex[at] < rigid_stiffness && share > most)
        most = share, stiffness.region[v] = stiffness.region[at];
    }
    stiffness.of_vertex[v] = most > 0 ? std::min(sum, (1 - kBelow) * rigid_stiffness) : sum;
  }
}

std::vector<int> layered_parts(const Surface& surface, const std::vector<bool>& soft) {
  if (surface.lies_on.empty()) return connected_parts(surface, soft);
  std::vector<bool> free = soft;
  for (size_t v = 0; v < free.size(); ++v) free[v] = free[v] && surface.lies_on[v].empty();
  std::vector<int> part = connected_parts(surface, free);
  for (size_t v = 0; v < part.size(); ++v) {
    if (!soft[v] || free[v] || surface.neighbours[v].empty()) continue;
    double most = 0;
    for (const auto& [base, share] : surface.lies_on[v])
      if (share > most && part[static_cast<size_t>(base)] >= 0)
        most = share, part[v] = part[static_cast<size_t>(base)];
  }
  join_hanging(surface, free, part);
  return part;
}

void carry_alike(const Surface& surface, const std::vector<int>& vertices,
                 std::vector<std::vector<double>>& carry) {
  if (surface.lies_on.empty()) return;
  for (size_t p = 0; p < vertices.size(); ++p) {
    const LiesOn& on = surface.lies_on[static_cast<size_t>(vertices[p])];
    if (on.empty()) continue;
    std::vector<double> sum(carry.size(), 0);
    for (const auto& [base, share] : on) {
      const auto found = std::ranges::lower_bound(vertices, base);
      if (found == vertices.end() || *found != base) continue;  // rigid: it stays
      const auto at = static_cast<size_t>(found - vertices.begin());
      for (size_t n = 0; n < carry.size(); ++n) sum[n] += share * carry[n][at];
    }
    for (size_t n = 0; n < carry.size(); ++n) carry[n][p] = sum[n];
  }
}

}  // namespace sinew::baker

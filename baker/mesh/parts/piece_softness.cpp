// piece_softness.cpp  see piece_softness.hpp.
#include "baker/mesh/parts/piece_softness.hpp"

#include <algorithm>

#include "baker/common/smooth_step.hpp"
#include "baker/mesh/surface/flesh_shape.hpp"
#include "baker/mesh/surface/join_islands.hpp"
#include "baker/mesh/surface/skin_weight.hpp"

namespace sinew::baker {
namespace {

constexpr size_t kFewestVertices = 8;  // of flesh: fewer say nothing of its shape
constexpr double kMeets = 0.1;         // of a region's extent: islands nearer than that are one piece
// Near flesh, in shares of the piece's extent: held up to the first, free from the second on; only in the
// inner part of the way out, for a cape that lies against the back hangs there and a hem does not.
constexpr double kTouches = 0.02, kFree = 0.06, kAttachedTo = 0.25, kHangsFrom = 0.5;
constexpr double kFarGap = 0.12;  // how far flesh is looked for: more than what sticks out must have
constexpr double kWeightFrom = 0.25, kWeightTo = 0.75;  // of bones that the region names, too

double out_of(const FittedCapsule& capsule, const Vector3& p) {
  const Vector3 along = capsule.to - capsule.from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - capsule.from).dot(along) / length2, 0.0, 1.0) : 0;
  return std::max(0.0, (p - capsule.from - share * along).norm() - capsule.radius_m);
}

std::vector<int> members(const std::vector<bool>& in) {
  std::vector<int> list;
  for (size_t v = 0; v < in.size(); ++v)
    if (in[v]) list.push_back(static_cast<int>(v));
  return list;
}

}  // namespace

BodyUnder::BodyUnder(const Character& character, const std::vector<bool>& is_piece)
    : character_(character), bones_(find_bones(character, {})), capsule_(character.joint_node.size()) {
  std::vector<std::vector<Vector3>> flesh(capsule_.size());
  for (size_t v = 0; v < character.positions.size(); ++v)
    if (!is_piece[v] && character.welded[v] == static_cast<int>(v))
      flesh[static_cast<size_t>(character.skin[v].joint[0])].push_back(character.positions[v]);
  for (size_t j = 0; j < flesh.size(); ++j)
    if (flesh[j].size() >= kFewestVertices)
      capsule_[j] = fit_capsule(flesh[j], bones_.tail[j] - bones_.head[j]);
  std::vector<std::vector<int>> triangles(capsule_.size());
  for (size_t t = 0; t < character.triangles.size(); ++t) {
    const auto corner = static_cast<size_t>(character.triangles[t][0]);
    const auto joint = static_cast<size_t>(character.skin[corner].joint[0]);
    if (!is_piece[corner] && capsule_[joint]) triangles[joint].push_back(static_cast<int>(t));
  }
  for (std::vector<int>& own : triangles) surface_.emplace_back(character, std::move(own));
}

bool BodyUnder::is_there() const {
  return std::ranges::any_of(capsule_, [](const auto& capsule) { return capsule.has_value(); });
}

int BodyUnder::flesh_joint(int joint) const {
  int up = joint;
  while (up >= 0 && !capsule_[static_cast<size_t>(up)]) up = character_.joint_parent[static_cast<size_t>(up)];
  return up;
}

double BodyUnder::out_m(const Influences& skin, const Vector3& place) const {
  double sum = 0;
  for (size_t k = 0; k < kInfluences; ++k) {
    if (!(skin.weight[k] > 0)) continue;
    const int joint = flesh_joint(skin.joint[k]);
    sum += skin.weight[k] * (joint >= 0 ? out_of(*capsule_[static_cast<size_t>(joint)], place)
                                        : (place - bones_.head[static_cast<size_t>(skin.joint[k])]).norm());
  }
  return sum;
}

double BodyUnder::gap_m(int joint, const Vector3& place, double reach_m) const {
  const int of = flesh_joint(joint);
  if (of < 0) return reach_m;
  const std::optional<SurfacePlace> nearest = surface_[static_cast<size_t>(of)].find(place, reach_m);
  return nearest ? nearest->distance_m : reach_m;
}

PieceReach piece_reach(const Character& character, const BodyUnder& body, const std::vector<bool>& piece) {
  const std::vector<int> vertices = members(piece);
  PieceReach reach;
  reach.softness.assign(piece.size(), 0);
  reach.extent_m = extent_m(character, vertices);
  std::vector<double> out;
  for (const int v : vertices)
    out.push_back(
        body.out_m(character.skin[static_cast<size_t>(v)], character.positions[static_cast<size_t>(v)]));
  if (out.empty()) return reach;
  const auto [least, most] = std::ranges::minmax(out);
  reach.farthest_m = most - least;
  std::vector<double> gap_m;
  for (size_t i = 0; i < out.size(); ++i) {
    const auto v = static_cast<size_t>(vertices[i]);
    gap_m.push_back(body.gap_m(character.skin[v].joint[0], character.positions[v], kFarGap * reach.extent_m));
    reach.sticks_out_m = std::max(reach.sticks_out_m, std::min(out[i] - least, gap_m[i]));
  }
  if (!reach.swings()) return reach;
  for (size_t i = 0; i < out.size(); ++i) {
    const auto v = static_cast<size_t>(vertices[i]);
    const double way = (out[i] - least) / reach.farthest_m;
    const double free = smooth_step(kTouches * reach.extent_m, kFree * reach.extent_m, gap_m[i]);
    const double hangs = smooth_step(kAttachedTo, kHangsFrom, way);
    reach.softness[v] = smooth_step(0, 1, way) * (free + (1 - free) * hangs);
  }
  return reach;
}

PieceRegions::PieceRegions(const Character& character, const Surface& surface,
                           const std::vector<RegionRecipe>& regions)
    : character_(character), pieces_(regions.size()), claimed_(character.positions.size(), false) {
  for (const RegionRecipe& region : regions) scopes_.push_back(scope_of(character, surface, region));
  for (size_t r = 0; r < regions.size(); ++r) {
    if (!selects_piece(regions[r])) continue;
    std::vector<bool> own = scopes_[r].vertices;
    for (size_t v = 0; v < own.size(); ++v) {
      own[v] = own[v] && weight_on(character.skin[v], scopes_[r].joints) > kWeightFrom;
      claimed_[v] = claimed_[v] || own[v];
    }
    std::vector<int> label(own.size(), -1);
    for (size_t v = 0; v < own.size(); ++v)
      if (own[v]) label[v] = 0;
    const Links links = island_links(character, surface, label, kMeets * extent_m(character, members(own)));
    pieces_[r] = connected_parts(with_links(surface, links), own);
    for (size_t v = 0; v < own.size(); ++v)
      pieces_[r][v] = pieces_[r][static_cast<size_t>(character.welded[v])];
  }
  if (are_there()) body_.emplace(character, claimed_);
}

bool PieceRegions::are_there() const { return std::ranges::find(claimed_, true) != claimed_.end(); }

std::vector<PieceReach> PieceRegions::reaches(size_t region) const {
  const std::vector<int>& piece = pieces_[region];
  std::vector<PieceReach> found;
  const int count = piece.empty() ? 0 : *std::ranges::max_element(piece) + 1;
  for (int id = 0; id < count; ++id) {
    std::vector<bool> in(piece.size());
    for (size_t v = 0; v < in.size(); ++v) in[v] = piece[v] == id;
    found.push_back(piece_reach(character_, *body_, in));
  }
  return found;
}

std::vector<double> PieceRegions::softness(size_t region) const {
  std::vector<double> soft(character_.positions.size(), 0);
  for (const PieceReach& reach : reaches(region))
    for (size_t v = 0; v < soft.size(); ++v) soft[v] = std::max(soft[v], reach.softness[v]);
  for (size_t v = 0; v < soft.size(); ++v)
    soft[v] *= smooth_step(kWeightFrom, kWeightTo, weight_on(character_.skin[v], scopes_[region].joints));
  return soft;
}

double PieceRegions::share_out(size_t region) const {
  double most = 0;
  for (const PieceReach& reach : reaches(region))
    if (reach.extent_m > 0) most = std::max(most, reach.sticks_out_m / reach.extent_m);
  return most;
}

}  // namespace sinew::baker

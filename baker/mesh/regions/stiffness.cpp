// stiffness.cpp  Softness by skin weight and by the flesh over bones.
#include "baker/mesh/regions/stiffness.hpp"

#include <algorithm>

#include "baker/common/smooth_step.hpp"
#include "baker/mesh/anatomy/anatomy.hpp"
#include "baker/mesh/anatomy/body_side.hpp"
#include "baker/mesh/anatomy/bones.hpp"
#include "baker/mesh/anatomy/joint_names.hpp"
#include "baker/mesh/parts/named_parts.hpp"
#include "baker/mesh/parts/piece_softness.hpp"
#include "baker/mesh/regions/regions.hpp"
#include "baker/mesh/regions/rim.hpp"
#include "baker/mesh/surface/flesh_shape.hpp"
#include "baker/mesh/surface/skin_weight.hpp"

namespace sinew::baker {
namespace {

// Shares of the region's largest skin weight, and of its thickest flesh, between which softness comes in:
// bones that are added to move flesh often have less than half of it.
constexpr double kWeightFrom = 0.25, kWeightTo = 0.75, kFleshFrom = 0.25, kFleshTo = 0.7;
// Skin weight of the bones over which a rim may reach.
constexpr double kOpenFrom = 0.3, kOpenTo = 0.8;

// Between vertices that belong to different parts the skin is held: each part moves in its own bone's frame.
// -1 belongs to all.
void hold_seams(const Surface& surface, const std::vector<int>& owner, std::vector<double>& softness) {
  std::vector<double> held = softness;
  for (size_t v = 0; v < owner.size(); ++v)
    for (int other : surface.neighbours[v]) {
      const auto next = static_cast<size_t>(other);
      const bool both = softness[v] > 0 && softness[next] > 0 && owner[v] >= 0 && owner[next] >= 0;
      if (both && owner[v] != owner[next]) held[v] = 0;
    }
  softness = std::move(held);
}

class StatedRegions {
 public:
  StatedRegions(const Character& character, const Surface& surface, const std::vector<bool>& coreless,
                const PieceRegions& pieces)
      : character_(character),
        surface_(surface),
        anatomy_(find_anatomy(character)),
        flesh_(flesh_joints(character)),
        thickness_(flesh_thickness(character, find_bones(character, flesh_))),
        fastened_(fastened_to(character, surface)),
        coreless_(coreless),
        pieces_(pieces) {}

  std::vector<double> softness(const RegionRecipe& region) const {
    const std::vector<bool> joints =
        match_joints(character_, region.joints, "recipe: region '" + region.name + "'");
    std::vector<bool> added = flesh_;
    for (size_t j = 0; j < added.size(); ++j) added[j] = added[j] && joints[j];
    double most = 0, thickest = 0;
    for (const Influences& skin : character_.skin) most = std::max(most, weight_on(skin, joints));
    std::vector<bool> reached;
    for (size_t v = 0; v < thickness_.size(); ++v) {
      reached.push_back(!pieces_.claims(v) && weight_on(character_.skin[v], joints) > kWeightTo * most);
      if (reached[v]) thickest = std::max(thickest, thickness_[v]);
    }
    const SoftKind kind = kind_of_region(region.name, &region);
    const auto side = side_share(character_, anatomy_, kind, region.side, joints, reached);
    std::vector<double> soft;
    for (size_t v = 0; v < thickness_.size(); ++v) {
      const Influences& skin = character_.skin[v];
      const double weight = weight_on(skin, joints);
      const double flesh = smooth_step(kFleshFrom * thickest, kFleshTo * thickest, thickness_[v]);
      const double share = weight > 0 ? weight_on(skin, added) / weight : 0;
      const double coreless = std::max(weight_on(skin, coreless_), share);
      soft.push_back(smooth_step(kWeightFrom * most, kWeightTo * most, weight) *
                     (coreless + (1 - coreless) * (side ? (*side)[v] : flesh)));
    }
    hold_fastened(soft);
    if (side) fade(joints, *side, defaults_of(kind).max_displacement, soft);
    return soft;
  }

 private:
  // Softness of one side fades over a width of its own, whatever the bones' weights do there.
  void fade(const std::vector<bool>& joints, const std::vector<double>& side, double wanted_share,
            std::vector<double>& soft) const {
    const std::vector<bool> may = around(joints);
    std::vector<double> open;
    for (size_t v = 0; v < soft.size(); ++v)
      open.push_back(
          std::max(soft[v], side[v] * smooth_step(kOpenFrom, kOpenTo, weight_on(character_.skin[v], may))));
    fade_rim(character_, surface_, open, rim_width_m(character_, surface_, soft, wanted_share), soft);
  }

  // Joints over whose skin a rim may reach: of the trunk's regions the trunk, else bones beside its own.
  std::vector<bool> around(const std::vector<bool>& joints) const {
    std::vector<bool> may = joints;
    for (size_t j = 0; j < joints.size(); ++j) {
      if (joints[j] && anatomy_->trunk[j]) return anatomy_->trunk;
      const int up = character_.joint_parent[j];
      if (up < 0) continue;
      if (joints[j]) may[static_cast<size_t>(up)] = true;
      if (joints[static_cast<size_t>(up)]) may[j] = true;
    }
    return may;
  }

  void hold_fastened(std::vector<double>& soft) const {
    const auto is_fastened = [&](size_t v) {
      return fastened_[static_cast<size_t>(character_.welded[v])] >= 0;
    };
    bool others = false;
    for (size_t v = 0; v < soft.size(); ++v) others = others || (soft[v] > 0 && !is_fastened(v));
    if (!others) return;
    for (size_t v = 0; v < soft.size(); ++v)
      if (is_fastened(v)) soft[v] = 0;
  }

  const Character& character_;
  const Surface& surface_;
  std::optional<Anatomy> anatomy_;
  std::vector<bool> flesh_;
  std::vector<double> thickness_;
  std::vector<int> fastened_;
  const std::vector<bool>& coreless_;
  const PieceRegions& pieces_;
};

void equal_at_seams(const Character& character, Stiffness& stiffness) {
  for (size_t v = 0; v < stiffness.of_vertex.size(); ++v) {
    const auto welded = static_cast<size_t>(character.welded[v]);
    stiffness.of_vertex[v] = stiffness.of_vertex[welded];
    stiffness.region[v] = stiffness.region[welded];
    if (!stiffness.piece.empty()) stiffness.piece[v] = stiffness.piece[welded];
  }
}

// Of every soft vertex the piece that it is of, numbered through all regions.
std::vector<int> pieces_of(const PieceRegions& pieces, const std::vector<int>& region) {
  const int regions = region.empty() ? 0 : *std::ranges::max_element(region) + 1;
  std::vector<int> piece(region.size(), -1);
  int first = 0;
  for (int r = 0; r < regions; ++r) {
    const std::vector<int>& own = pieces.pieces(static_cast<size_t>(r));
    if (own.empty()) continue;
    for (size_t v = 0; v < piece.size(); ++v)
      if (region[v] == r && own[v] >= 0) piece[v] = first + own[v];
    first += *std::ranges::max_element(own) + 1;
  }
  return piece;
}

}  // namespace

Stiffness painted_stiffness(const Character& character) {
  Stiffness painted{character.stiffness, std::vector<int>(character.stiffness.size(), -1), {}};
  equal_at_seams(character, painted);
  return painted;
}

Stiffness stated_stiffness(const Character& character, const Surface& surface,
                           const std::vector<RegionRecipe>& regions, const std::vector<bool>& coreless) {
  std::vector<double> best(character.positions.size(), 0);
  Stiffness stated{std::vector<double>(best.size(), 1), std::vector<int>(best.size(), -1), {}};
  if (regions.empty()) return stated;
  const PieceRegions pieces(character, surface, regions);
  const StatedRegions found(character, surface, coreless, pieces);
  for (size_t r = 0; r < regions.size(); ++r) {
    const bool of_pieces = selects_piece(regions[r]);
    const std::vector<double> soft = of_pieces ? pieces.softness(r) : found.softness(regions[r]);
    for (size_t v = 0; v < best.size(); ++v)
      if (soft[v] > best[v] && (of_pieces || !pieces.claims(v)))
        best[v] = soft[v], stated.region[v] = static_cast<int>(r);
  }
  if (pieces.are_there()) stated.piece = pieces_of(pieces, stated.region);
  hold_seams(surface, stated.region, best);
  for (size_t v = 0; v < best.size(); ++v)
    if (best[v] > 0)
      stated.of_vertex[v] = 1 - (1 - regions[static_cast<size_t>(stated.region[v])].stiffness) * best[v];
  equal_at_seams(character, stated);
  return stated;
}

}  // namespace sinew::baker

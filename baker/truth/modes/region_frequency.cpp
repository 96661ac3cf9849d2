// region_frequency.cpp  see region_frequency.hpp.
#include "baker/truth/modes/region_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "baker/common/bad_input.hpp"
#include "baker/truth/modes/body_parts.hpp"
#include "baker/truth/modes/moving_part.hpp"

namespace sinew::baker {
namespace {

constexpr double kClose = 0.01;
// One is exact where no tetrahedron is shared between regions; a cape and hair that overlap take more than
// four.
constexpr int kMostRounds = 16;

// Of one round: what each region swings at, and whose each free node of the cage is.
struct Found {
  std::vector<double> first_hz;     // a region; 0: nothing of it is free
  std::vector<int> region_of_node;  // a cage node, -1: none
};

Found find(const Cage& cage, const TissueLayout& layout, const MovingPart& part) {
  Fem fem(part.rest, part.tetrahedra, part.constrained, part.material);
  Found found{std::vector<double>(layout.regions.size(), 0), std::vector<int>(cage.nodes.size(), -1)};
  for (const FemLinear& body : fem.linear())
    for (const auto& [region, nodes] : split_by_region(body, layout, cage, part.cage_node)) {
      for (const size_t n : nodes)
        found.region_of_node[static_cast<size_t>(part.cage_node[static_cast<size_t>(body.nodes[n])])] =
            region;
      const double hz = first_rad_per_s(body, nodes) / (2 * std::numbers::pi);
      double& first = found.first_hz[static_cast<size_t>(region)];
      first = first > 0 ? std::min(first, hz) : hz;
    }
  return found;
}

void check_free(const TissueLayout& layout, const Recipe& recipe, const Found& found) {
  if (!recipe.states_regions) return;
  for (size_t r = 0; r < layout.regions.size(); ++r)
    if (!(found.first_hz[r] > 0))
      throw BadInput(
          "recipe: region '" + layout.regions[r].name +
          "': no part of it is free to move; lower core_share, raise voxels_high, or list its bones "
          "under coreless_joints");
}

void check_reached(const TissueLayout& layout, const Recipe& recipe, const Found& found) {
  constexpr double kFarOff = 0.05;
  if (!recipe.states_regions) return;
  for (size_t r = 0; r < layout.regions.size(); ++r) {
    const double wanted = layout.regions[r].frequency_hz, is = found.first_hz[r];
    if (wanted > 0 && std::abs(is / wanted - 1) > kFarOff)
      throw BadInput("recipe: region '" + layout.regions[r].name + "': its frequency_hz of " +
                     std::to_string(wanted) + " cannot be reached, it swings at " + std::to_string(is) +
                     "; name more of its bones, or state another");
  }
}

// A tetrahedron between two regions takes the mean of their factors.
double factor_of(const std::array<int, 4>& corners, const Found& found, const std::vector<double>& factor) {
  double logarithm = 0;
  int count = 0;
  for (const int node : corners) {
    const int region = found.region_of_node[static_cast<size_t>(node)];
    if (region < 0) continue;
    logarithm += std::log(factor[static_cast<size_t>(region)]);
    ++count;
  }
  return count > 0 ? std::exp(logarithm / count) : 1;
}

}  // namespace

Cage with_frequencies(Cage cage, const TissueLayout& layout, const Recipe& recipe) {
  const bool any = std::ranges::any_of(layout.regions, [](const Region& r) { return r.frequency_hz > 0; });
  for (int round = 0; any; ++round) {
    const MovingPart part = moving_part(cage, recipe);
    const Found found = find(cage, layout, part);
    check_free(layout, recipe, found);
    std::vector<double> factor(layout.regions.size(), 1);
    bool close = true;
    for (size_t r = 0; r < factor.size(); ++r) {
      const double wanted = layout.regions[r].frequency_hz;
      if (!(wanted > 0) || !(found.first_hz[r] > 0)) continue;
      factor[r] = std::pow(wanted / found.first_hz[r], 2);
      close = close && std::abs(wanted / found.first_hz[r] - 1) < kClose;
    }
    if (close) break;
    if (round == kMostRounds) {
      check_reached(layout, recipe, found);
      break;
    }
    for (const int element : part.cage_element)
      cage.young_pa[static_cast<size_t>(element)] *=
          factor_of(cage.tetrahedra[static_cast<size_t>(element)], found, factor);
  }
  return cage;
}

}  // namespace sinew::baker

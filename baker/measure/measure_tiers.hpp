// measure_tiers.hpp  What every tier of a character is off from its own ground truth, in seconds of work.
#pragma once
#include <string>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/measure/loaded_pack.hpp"
#include "baker/measure/true_surface.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/truth/tissue_truth.hpp"

namespace sinew::baker {

// What short_truths gives.
struct ShortTruths {
  std::vector<TrueSurface> surfaces;
  std::vector<uint32_t> clips;      // which of the character's each motion is, pack::kNoIndex: none
  std::vector<double> moved_radii;  // how far each region's flesh went without a limit, over its radius
};

// Of 1.5 s each, 0.85 s of large bodies, of motions that no weights were trained on: random motion and up to
// five of the character's clips, evenly picked of those in which joints move, or where there is none a shake.
// On all cores. Throws std::runtime_error, naming the motion, where a step of the truth does not converge.
ShortTruths short_truths(const Character& character, const TissueLayout& layout, const Recipe& recipe,
                         const std::vector<ModalBasis>& modes, const pack::PackView& pack);

// The pack's tiers with the errors measured in closed loop along these motions. Throws BadInput where nothing
// moves in them.
std::vector<pack::TierRecord> measured_tiers(const LoadedPack& character, const ShortTruths& truths);

// A network is worth its time where its error is smaller than its modal base's by this share.
inline constexpr double kNetworkMargin = 0.05;

// A tier's at level 0; NaN: it has none.
double error_ratio_of(const std::vector<pack::TierRecord>& tiers, Tier tier);

}  // namespace sinew::baker

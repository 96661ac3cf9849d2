// skin.hpp  Skin weights: which joints move a vertex of the body, and how much.
#pragma once
#include <array>
#include <vector>

#include "baker/creature/creature_recipe.hpp"
#include "baker/creature/surface.hpp"

namespace sinew::baker {

inline constexpr size_t kCreatureInfluences = 4;

struct SkinWeights {
  std::array<int, kCreatureInfluences> joint{};
  std::array<double, kCreatureInfluences> weight{};  // descending, sum 1
};

// Joints whose name is one of these, "prefix*" standing for all that begin so.
std::vector<int> matching_joints(const CreatureRecipe& recipe, const std::vector<std::string>& names);

// Parts near the surface share each vertex; a part's share goes to its joints by distance to their bones;
// smoothed along the surface, so that nothing crosses from limb to limb.
std::vector<SkinWeights> skin_body(const CreatureRecipe& recipe, const Surface& surface);

}  // namespace sinew::baker

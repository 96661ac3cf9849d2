// detail.hpp  Small closed surfaces of revolution: eyes, nose, claws.
#pragma once
#include <cstddef>
#include <vector>

#include "baker/creature/creature_recipe.hpp"
#include "baker/creature/surface.hpp"

namespace sinew::baker {

struct DetailSurface {
  Surface surface;
  std::vector<Eigen::Vector3d> normals, colors;  // colours linear
};

inline constexpr size_t kFewestDetailVertices = 12;

// About this many vertices, never fewer than kFewestDetailVertices.
DetailSurface make_detail(const DetailRecipe& recipe, size_t vertices);

}  // namespace sinew::baker

// paint.hpp  Colour and stiffness painted on the body by brushes.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "baker/creature/creature_recipe.hpp"
#include "baker/creature/skin.hpp"

namespace sinew::baker {

struct PaintSpot {  // where a brush looks
  Eigen::Vector3d position, normal;
  SkinWeights skin;
};

std::vector<Eigen::Vector3d> paint_color(const CreatureRecipe& recipe,
                                         const std::vector<PaintSpot>& spots);  // linear
std::vector<double> paint_stiffness(const CreatureRecipe& recipe, const std::vector<PaintSpot>& spots);

Eigen::Vector3d linear_from_srgb(const Eigen::Vector3d& srgb);

}  // namespace sinew::baker

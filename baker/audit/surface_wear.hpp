// surface_wear.hpp  How far a shown surface departs from the skinned one, part by part.
#pragma once
#include <vector>

#include "baker/audit/parts.hpp"
#include "baker/audit/player.hpp"

namespace sinew::baker {

struct Wear {
  double displacement_m = 0;  // largest of a vertex, of a rod that of its segments' ends
  double edge_stretch = 1;    // largest length of an edge over its skinned one
  size_t inverted = 0;        // triangles that face away from where they face when skinned
};

// A wear for each part, of the player's last read.
std::vector<Wear> surface_wear(const AuditedParts& parts, const pack::PackView& character,
                               const Player& player);
// Displacements alone.
std::vector<double> displacements_m(const AuditedParts& parts, const pack::PackView& character,
                                    const Player& player);

}  // namespace sinew::baker

// layers.hpp  Pieces of surface that lie over or under another one's flesh: clothes, shells of fur, the
// inside of a mouth.
//
// A vertex lies on the closest place of another piece where that is within reach, along the normal and moved
// by the same bones. Of two pieces the one beneath leads, of two back to back the one with more area; one
// that is soft nowhere leads nobody, and who lies on no soft place of a piece lies nowhere on it. Pieces that
// are fastened to one bone follow as a whole or not at all: a button does, a sword does not.
#pragma once
#include <array>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/mesh/regions/stiffness.hpp"
#include "baker/mesh/surface/surface.hpp"

namespace sinew::baker {

// Of the character's longest side: how far above flesh clothes lie.
inline constexpr double kLayerShare = 0.015;
double usual_layer_m(const Character& character);

struct Overlap {
  int triangle = -1;              // that leads; -1: the vertex lies on nothing
  std::array<double, 3> share{};  // barycentric
};

// A vertex each, equal for welded ones. soft: of each vertex.
std::vector<Overlap> find_overlaps(const Character& character, const Surface& surface,
                                   const std::vector<bool>& soft, double reach_m);

// Surface::lies_on, and neighbours of what lies with what it lies on.
void link_layers(const Character& character, const std::vector<LiesOn>& lies_on, Surface& surface);
// The same of overlaps; what lies on another piece gets the stiffness of the place beneath, and is soft where
// anything of that is.
void lay_on_flesh(const Character& character, const std::vector<Overlap>& overlaps, double rigid_stiffness,
                  Surface& surface, Stiffness& stiffness);

// Connected parts of soft vertices. What lies on a part belongs to it, and so does what hangs on that alone.
std::vector<int> layered_parts(const Surface& surface, const std::vector<bool>& soft);

// Carry weights [node][vertex of `vertices`, ascending]: what lies on others is carried as they are.
void carry_alike(const Surface& surface, const std::vector<int>& vertices,
                 std::vector<std::vector<double>>& carry);

}  // namespace sinew::baker

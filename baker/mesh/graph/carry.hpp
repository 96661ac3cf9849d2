// carry.hpp  How nodes' displacements spread over a soft part: polyharmonic interpolation that is zero on the
// rigid rim.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// [node][place]: the displacement of place p is the sum of weight x displacement over the nodes. u(x) = sum
// a_i |x - x_i| + b + B x through the nodes' values and zero at the anchors (Duchon 1977; |r| is the
// biharmonic kernel in space).
std::vector<std::vector<double>> carry_weights(const std::vector<Vector3>& nodes,
                                               const std::vector<Vector3>& anchors,
                                               const std::vector<Vector3>& places);

}  // namespace sinew::baker

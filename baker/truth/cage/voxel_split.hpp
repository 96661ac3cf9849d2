// voxel_split.hpp  A cube as five tetrahedra; neighbours of opposite parity share their faces' diagonals.
#pragma once
#include <array>

namespace sinew::baker {

// Corner c of a cube lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Positive volumes; the last tetrahedron is the
// middle one, a third of the cube.
inline constexpr std::array<std::array<std::array<int, 4>, 5>, 2> kVoxelSplit = {{
    {{{0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}}},
    {{{1, 3, 0, 5}, {2, 0, 3, 6}, {4, 6, 5, 0}, {7, 5, 6, 3}, {0, 5, 3, 6}}},
}};

}  // namespace sinew::baker

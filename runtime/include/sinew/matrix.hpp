// matrix.hpp  Stand-alone.
#pragma once

namespace sinew {

// Row-major 3x4 affine matrix: p' = m[r][0..2] p + m[r][3].
struct Matrix34 {
  float m[3][4];
};

}  // namespace sinew

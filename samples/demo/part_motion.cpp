// part_motion.cpp  see part_motion.hpp.
#include "samples/demo/part_motion.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::demo {

double largest_mm(const baker::Part& part, std::span<const Eigen::Vector3f> skinned,
                  std::span<const Eigen::Vector3f> moved) {
  float farthest2 = 0;
  for (const uint32_t v : part.vertices)
    farthest2 = std::max(farthest2, (moved[v] - skinned[v]).squaredNorm());
  return 1000 * std::sqrt(static_cast<double>(farthest2));
}

}  // namespace sinew::demo

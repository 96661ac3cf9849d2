// part_motion.hpp  How far each soft part and rod goes from where skinning alone has it.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "baker/preview/parts.hpp"

namespace sinew::demo {

// Of one part, of the first instance.
struct PartMotion {
  std::string name;
  bool is_rod = false;
  double frequency_hz = 0;  // of its first mode, or of a rod's slowest swing; 0: not known
  double largest_mm = 0;    // of any of its vertices in any frame
  double still_mm = 0;      // of any of its vertices after kStill_s in the last frame's pose
};

inline constexpr double kStill_s = 2;

// The largest displacement of a part's vertices.
double largest_mm(const baker::Part& part, std::span<const Eigen::Vector3f> skinned,
                  std::span<const Eigen::Vector3f> moved);

}  // namespace sinew::demo

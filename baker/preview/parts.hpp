// parts.hpp  What of a baked character moves by itself: soft regions, then rods.
#pragma once
#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "pack/reader.hpp"

namespace sinew::baker {

struct Part {
  std::string name;
  bool is_rod = false;
  double frequency_hz = 0;         // of its first mode, or of a rod's slowest swing; 0: not known
  std::vector<uint32_t> vertices;  // ascending; a rod's: what hangs on it
  std::vector<float> share;        // 0..1 a vertex: how much of it the part moves
  std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>> bones;  // of a rod, in the bind pose
};

std::vector<Part> parts_of(const pack::PackView& character);

}  // namespace sinew::baker

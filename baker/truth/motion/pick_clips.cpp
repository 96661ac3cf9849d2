// pick_clips.cpp  see pick_clips.hpp.
#include "baker/truth/motion/pick_clips.hpp"

#include <algorithm>

namespace sinew::baker {
namespace {

double extent_of(const Character& character) {
  Vector3 low = character.positions.front(), high = low;
  for (const Vector3& p : character.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

// By a thousandth of the mesh's extent, or a thousandth of a turn.
bool moves(const Character& character, const Clip& clip, double extent) {
  constexpr int kSamples = 12;
  constexpr double kHardly = 1e-3;
  const std::vector<Matrix4> first = joint_matrices(character, &clip, 0);
  for (int i = 1; i <= kSamples; ++i) {
    const std::vector<Matrix4> now = joint_matrices(character, &clip, clip.duration_s * i / kSamples);
    for (size_t j = 0; j < first.size(); ++j) {
      const Matrix4 change = now[j] - first[j];
      if (change.topRightCorner<3, 1>().norm() > kHardly * extent ||
          change.topLeftCorner<3, 3>().norm() > kHardly)
        return true;
    }
  }
  return false;
}

}  // namespace

std::vector<size_t> pick_clips(const Character& character, size_t most) {
  std::vector<size_t> moving, picked;
  if (character.positions.empty()) return picked;
  const double extent = extent_of(character);
  for (size_t c = 0; c < character.clips.size(); ++c)
    if (moves(character, character.clips[c], extent)) moving.push_back(c);
  const size_t count = std::min(most, moving.size());
  for (size_t k = 0; k < count; ++k)
    picked.push_back(moving[count == 1 ? 0 : k * (moving.size() - 1) / (count - 1)]);
  return picked;
}

}  // namespace sinew::baker

// shown_skin.hpp  Skin matrices of the pose that is shown, for whoever reads.
#pragma once
#include <Eigen/Core>

#include "character/instance.hpp"
#include "character/motion/pose.hpp"
#include "character/output/publish.hpp"
#include "character/rods/rod_publish.hpp"

namespace sinew::world {

using SkinMatrix = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

// All of them, made where they are read.
class ShownSkin {
 public:
  explicit ShownSkin(const Instance& instance) noexcept : data_(instance.motion.skin) {
    if (!skins_on_reading(instance)) return;
    skin_matrices(instance.level->pack.joints, shown_joints(instance), here_);
    data_ = here_;
  }
  ShownSkin(const ShownSkin&) = delete;
  ShownSkin& operator=(const ShownSkin&) = delete;
  const float* matrices() const noexcept { return data_; }  // [joints][12]

 private:
  float here_[12 * kJointsOnStack];
  const float* data_;
};

// One of them.
inline SkinMatrix shown_skin(const Instance& instance, uint32_t joint) noexcept {
  using Map = Eigen::Map<const SkinMatrix>;
  const Map shown(&shown_joints(instance)[joint].m[0][0]);
  const Map inverse_bind(instance.level->pack.joints[joint].inverse_bind);
  SkinMatrix skin = shown.leftCols<3>() * inverse_bind;
  skin.col(3) += shown.col(3);
  return skin;
}

inline SkinMatrix blended(const pack::SkinRecord& record, const float* matrices) noexcept {
  SkinMatrix sum = SkinMatrix::Zero();
  for (uint32_t k = 0; k < pack::kInfluences && record.weight[k] > 0; ++k)
    sum += record.weight[k] * Eigen::Map<const SkinMatrix>(matrices + size_t{12} * record.joint[k]);
  return sum;
}

}  // namespace sinew::world

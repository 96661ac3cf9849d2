// trajectory.hpp  The ground truth that `sinew-bake truth --positions` wrote: a motion, and where the surface
// really went.
#pragma once
#include <Eigen/Core>

#include "samples/demo/motion.hpp"

namespace sinew::demo {

class Trajectory final : public Motion {
 public:
  // Throws baker::BadInput: not a trajectory, without positions, of another character, or not finite.
  Trajectory(const std::string& path, const CharacterFile& character);

  double rate_hz() const { return rate_hz_; }
  double seconds() const { return static_cast<double>(rows_ - 1) / rate_hz_; }
  void pose_at(double t_s, std::span<Matrix34> joints, RootTransform* root) const override;
  std::string name_at(double) const override { return motion_; }
  // Character space, one a vertex.
  void positions_at(double t_s, std::span<Eigen::Vector3f> out) const;

 private:
  struct Place {
    size_t row, next;
    float share;
  };
  Place place_at(double t_s) const;

  std::string motion_;
  double rate_hz_ = 60;
  size_t rows_ = 0, joints_ = 0, vertices_ = 0;
  std::vector<float> joint_rows_, root_rows_, position_rows_;
};

}  // namespace sinew::demo

// local_pose.hpp  Poses as joint-local translation, rotation and scale: the form in which they blend.
#pragma once
#include <vector>

#include "baker/import/character.hpp"

namespace sinew::baker {

struct LocalPose {  // a joint, relative to its parent joint; a joint without a parent: relative to the
                    // character
  std::vector<Vector3> translation;
  std::vector<Eigen::Quaterniond> rotation;
  std::vector<Vector3> scale;
};

LocalPose local_pose(const Character& character, const std::vector<Matrix4>& joints);
std::vector<Matrix4> joint_matrices(const Character& character, const LocalPose& pose);

// a at weight 0, b at 1, beyond them outside 0..1; rotations along the shortest arc.
LocalPose blend(const LocalPose& a, const LocalPose& b, double weight);

Eigen::Quaterniond rotation_from_vector(const Vector3& rotation_vector);

// 0 before 0, 1 from 1 on, in between a quintic with two continuous derivatives.
double ease(double x);

// A looped clip whose second derivative is continuous: a periodic uniform cubic B-spline over samples at the
// clip's keys' pace. It rounds the kinks of linear and step keys; a last pose that is not the first is eased
// into it.
class SmoothClip {
 public:
  SmoothClip(const Character& character, const Clip& clip);
  LocalPose at(double t_s) const;  // any time
  double duration_s() const { return duration_s_; }

 private:
  double duration_s_ = 0;
  std::vector<LocalPose> samples_;  // one period
};

}  // namespace sinew::baker

// local_pose.hpp  Poses as joint-local translation, rotation and scale: the form in which they are added up.
#pragma once
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

struct LocalPose {  // a joint, relative to its parent joint; a joint without a parent: relative to the
                    // character
  std::vector<Vector3> translation;
  std::vector<Eigen::Quaterniond> rotation;
  std::vector<Vector3> scale;
};

LocalPose local_pose(const Character& character, const std::vector<Matrix4>& joints);
std::vector<Matrix4> joint_matrices(const Character& character, const LocalPose& pose);

// What leads from one pose to another, a joint; rotation: a vector in the joint's own axes, by the short way.
struct PoseOffset {
  std::vector<Vector3> translation, rotation, scale;
};
PoseOffset offset_between(const LocalPose& from, const LocalPose& to);
// A share of an offset on top of a pose. The offset of two poses that stand still is fixed: it cannot change
// to the other way round, as that between moving ones does where they are half a turn apart.
LocalPose moved_by(LocalPose pose, const PoseOffset& offset, double share);

Eigen::Quaterniond rotation_from_vector(const Vector3& rotation_vector);

// 0 before 0, 1 from 1 on, in between a quintic with two continuous derivatives.
double ease(double x);

}  // namespace sinew::baker

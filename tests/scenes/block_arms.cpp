// block_arms.cpp  Arms for the soft block.
#include "tests/scenes/block_arms.hpp"

#include <cmath>
#include <string>

namespace sinew::scenes {
namespace {

using baker::Matrix4;
using baker::Vector3;

constexpr double kHalfLength_m = 0.2;

void add_joint(size_t index, const Vector3& place, baker::Character& character) {
  baker::Node node;
  node.name = "arm_" + std::to_string(index + 1);
  node.parent = 0;
  node.translation = place;
  character.joint_node.push_back(static_cast<int>(character.nodes.size()));
  character.joint_parent.push_back(0);
  character.nodes.push_back(node);
  Matrix4 inverse_bind = Matrix4::Identity();
  inverse_bind.topRightCorner<3, 1>() = -place;
  character.inverse_bind.push_back(inverse_bind);
}

}  // namespace

void add_arms(const ArmMatter& matter, baker::Character& character, baker::TissueLayout& layout) {
  const Vector3 along(0, 0, kHalfLength_m);
  for (size_t i = 0; i < matter.at_x_m.size(); ++i) {
    const Vector3 place(matter.at_x_m[i], matter.height_m, 0);
    layout.proxies.push_back(
        {static_cast<int>(character.joint_node.size()), place - along, place + along, matter.radius_m});
    add_joint(i, place, character);
  }
  const Vector3 waist(0.21, matter.height_m, 0);
  if (matter.waist_too) layout.proxies.push_back({1, waist - along, waist + along, matter.radius_m});
}

ArmedPose with_arms(const BlockPose& block, const ArmMatter& matter, double way_m, double turn_rad) {
  ArmedPose pose{{block.joints.begin(), block.joints.end()}, block.root};
  for (size_t i = 0; i < matter.at_x_m.size(); ++i) {
    const auto c = static_cast<float>(i == 0 ? std::cos(turn_rad) : 1),
               s = static_cast<float>(i == 0 ? std::sin(turn_rad) : 0);
    const auto x = static_cast<float>(matter.at_x_m[i] + (i == 0 ? way_m : 0));
    pose.joints.push_back({{{c, 0, s, x}, {0, 1, 0, static_cast<float>(matter.height_m)}, {-s, 0, c, 0}}});
  }
  return pose;
}

ArmedPose with_raised_arms(const Pose& pose, const ArmMatter& matter, double up_m) {
  ArmedPose out{{pose.joints.begin(), pose.joints.end()}, pose.root};
  const auto y = static_cast<float>(matter.height_m + up_m);
  for (const double x : matter.at_x_m)
    out.joints.push_back({{{1, 0, 0, static_cast<float>(x)}, {0, 1, 0, y}, {0, 0, 1, 0}}});
  return out;
}

}  // namespace sinew::scenes

// block_rods.cpp  A tail and two horns for the soft block.
#include "tests/scenes/block_rods.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

namespace sinew::scenes {
namespace {

using baker::Character;
using baker::Matrix4;
using baker::Vector3;

struct Chain {
  uint32_t first, count;
  Vector3 begin;  // from the waist
  Vector3 step;
};

const Chain kChains[] = {{kTail, 4, {0, 0.1, -0.15}, {0, 0, -kBone_m}},
                         {kHorns[0], 3, {-0.15, 0.1, 0}, {-0.06, 0.08, 0}},
                         {kHorns[1], 3, {0.15, 0.1, 0}, {0.06, 0.08, 0}}};

void add_joint(const Chain& chain, uint32_t index, Character& character) {
  baker::Node node;
  node.name = "rod_" + std::to_string(chain.first + index);
  node.parent = index == 0 ? 1 : static_cast<int>(chain.first + index) - 1;
  node.translation = index == 0 ? chain.begin : chain.step;
  character.joint_node.push_back(static_cast<int>(character.nodes.size()));
  character.joint_parent.push_back(node.parent);
  character.nodes.push_back(node);
  Matrix4 bind = Matrix4::Identity();
  bind.topRightCorner<3, 1>() = -(Vector3(0, kBlockJointHeight_m, 0) + chain.begin + index * chain.step);
  character.inverse_bind.push_back(bind);
}

void add_flesh(const Chain& chain, uint32_t index, Character& character) {
  constexpr double kRadius_m = 0.02;
  const Vector3 begin = Vector3(0, kBlockJointHeight_m, 0) + chain.begin + index * chain.step;
  const Vector3 across = chain.step.cross(Vector3(1, 2, 3)).normalized(),
                up = chain.step.cross(across).normalized();
  const int first = static_cast<int>(character.positions.size());
  for (int v = 0; v < 8; ++v) {
    const double angle = M_PI / 2 * (v % 4);
    const Vector3 out = std::cos(angle) * across + std::sin(angle) * up;
    baker::Influences skin;
    skin.joint[0] = static_cast<int>(chain.first + index);
    skin.weight[0] = 1;
    character.positions.push_back(begin + (v / 4) * chain.step + kRadius_m * out);
    character.normals.push_back(out);
    character.skin.push_back(skin);
    character.colors.push_back({120, 90, 60, 255});
    character.stiffness.push_back(1);
    character.welded.push_back(first + v);
  }
  for (int v = 0; v < 4; ++v) {
    const int next = (v + 1) % 4;
    character.triangles.push_back({first + v, first + 4 + v, first + next});
    character.triangles.push_back({first + next, first + 4 + v, first + 4 + next});
  }
}

baker::Rod make_rod(const Chain& chain, const RodMatter& matter) {
  baker::Rod rod;
  rod.name = "rod_" + std::to_string(chain.first);
  rod.attach = 1;
  if (matter.sewn && chain.first != kHorns[1]) rod.end_joint = 0;
  rod.learned_start = matter.learned && chain.first == kTail;
  rod.gravity = matter.gravity;
  rod.sag = matter.sag;
  rod.max_displacement = matter.max_displacement;
  Vector3 begin = Vector3(0, kBlockJointHeight_m, 0) + chain.begin;
  for (uint32_t i = 0; i < chain.count; ++i, begin += chain.step) {
    baker::RodBone bone;
    bone.joint = static_cast<int>(chain.first + i);
    bone.parent = static_cast<int>(i) - 1;
    bone.begin = i == 0 ? begin : rod.bones.back().end;
    bone.end = begin + chain.step;
    bone.radius_m = kTailRadius_m;
    bone.density_kg_m3 = 1000;
    bone.young_modulus_pa = bone.torsion_modulus_pa = matter.young_modulus_pa;
    bone.damping_s = 0.01;
    bone.drag_per_s = 0.5;
    rod.bones.push_back(bone);
  }
  rod.frequency_hz = baker::slowest_swing_rad_per_s(rod.bones) / (2 * std::numbers::pi);
  return rod;
}

Eigen::Matrix4d matrix(const Matrix34& joint) {
  Eigen::Matrix4d out = Eigen::Matrix4d::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out(r, c) = static_cast<double>(joint.m[r][c]);
  return out;
}

Matrix34 joint(const Eigen::Matrix4d& matrix) {
  Matrix34 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out.m[r][c] = static_cast<float>(matrix(r, c));
  return out;
}

}  // namespace

Vector3 bar_end(double side) { return {0.2 * side, kBlockJointHeight_m + 0.02, -0.4}; }

void add_rods(const RodMatter& matter, Character& character, baker::TissueLayout& layout) {
  for (const Chain& chain : kChains)
    for (uint32_t i = 0; i < chain.count; ++i) add_joint(chain, i, character);
  for (const Chain& chain : kChains) {
    for (uint32_t i = 0; i < chain.count; ++i) add_flesh(chain, i, character);
    layout.rods.push_back(make_rod(chain, matter));
  }
  if (matter.bar) layout.proxies = {{1, bar_end(-1), bar_end(1), kBarRadius_m}};
  layout.stiffness = character.stiffness;
}

TailedPose with_rods(const BlockPose& block, double wag_rad) {
  TailedPose out;
  out.root = block.root;
  out.joints[0] = block.joints[0];
  out.joints[1] = block.joints[1];
  for (const Chain& chain : kChains) {
    Eigen::Matrix4d above = matrix(block.joints[1]);
    for (uint32_t i = 0; i < chain.count; ++i) {
      Eigen::Affine3d local = Eigen::Affine3d::Identity();
      local.translate(i == 0 ? chain.begin : chain.step);
      if (chain.first == kTail) local.rotate(Eigen::AngleAxisd(wag_rad, Vector3::UnitY()));
      above = (above * local.matrix()).eval();
      out.joints[chain.first + i] = joint(above);
    }
  }
  return out;
}

}  // namespace sinew::scenes

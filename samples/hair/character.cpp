// character.cpp  see character.hpp.
#include "samples/hair/character.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "baker/pack/character/character_pack.hpp"

namespace sinew::sample {
namespace {

using baker::Character;
using baker::Matrix4;
using Eigen::Vector3d;

enum Joint : uint32_t { kChest, kNeck, kHead };
constexpr double kGravityOfHair = 1;

const Vector3d kAt[kBustJoints] = {{0, 1.2, 0}, {0, 1.48, 0}, {0, 1.6, 0}};

// Without the first segment, which the head holds.
std::vector<LockBone> bones_of(const std::vector<rods::SegmentDef>& strand) {
  std::vector<LockBone> out;
  for (size_t i = 1; i < strand.size(); ++i) {
    const Eigen::Map<const Vector3d> middle(strand[i].position_m);
    const Eigen::Quaterniond turn =
        Eigen::Map<const Eigen::Quaternionf>(strand[i].orientation).cast<double>();
    const Vector3d half = turn.normalized() * Vector3d(0, 0, 0.5 * static_cast<double>(strand[i].length_m));
    out.push_back({middle - half, middle + half, strand[i].radius_m});
  }
  return out;
}

// How far the neck's and the head's turn reach down.
std::array<double, kBustJoints> shares_at(const Vector3d& p) {
  const double share = turn_share(p);
  const double head = std::max(0.0, 2 * share - 1), chest = std::max(0.0, 1 - 2 * share);
  return {chest, 1 - chest - head, head};
}

void add_joint(const std::string& name, int parent, const Vector3d& at, const Vector3d& parent_at,
               Character& to) {
  baker::Node node;
  node.name = name;
  node.parent = parent;
  node.translation = at - parent_at;
  to.joint_node.push_back(static_cast<int>(to.nodes.size()));
  to.joint_parent.push_back(parent);
  to.nodes.push_back(node);
  Matrix4 bind = Matrix4::Identity();
  bind.topRightCorner<3, 1>() = -at;
  to.inverse_bind.push_back(bind);
}

baker::Influences influences_at(const Vector3d& p) {
  const auto shares = shares_at(p);
  std::array<int, kBustJoints> order = {kChest, kNeck, kHead};
  std::ranges::sort(order, std::greater{}, [&](int j) { return shares[static_cast<size_t>(j)]; });
  baker::Influences out;
  for (size_t i = 0; i < kBustJoints && shares[static_cast<size_t>(order[i])] > 0; ++i)
    out.joint[i] = order[i], out.weight[i] = shares[static_cast<size_t>(order[i])];
  return out;
}

void add_vertex(const Vector3d& place, const Vector3d& normal, Character& to) {
  to.welded.push_back(static_cast<int>(to.positions.size()));
  to.positions.push_back(place);
  to.normals.push_back(normal);
  to.skin.push_back(influences_at(place));
  to.colors.push_back({160, 90, 64, 255});
  to.stiffness.push_back(1);
}

void add_skin(const Bust& bust, Character& to) {
  for (const Vector3d& p : bust.rest_m) add_vertex(p, bust.field.sample(p).gradient.normalized(), to);
  for (const auto& t : bust.triangles)
    to.triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
}

// A triangle on the ground, so that the bust stands as high as the character that it is part of.
void add_ground(Character& to) {
  const auto first = static_cast<int>(to.positions.size());
  constexpr double kSize_m = 1e-3;
  for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(0, 0, kSize_m), Vector3d(kSize_m, 0, 0)})
    add_vertex(corner, Vector3d::UnitY(), to);
  to.triangles.push_back({first, first + 1, first + 2});
}

baker::RodBone like(const rods::SegmentDef& segment, const LockBone& bone) {
  baker::RodBone out;
  out.begin = bone.begin, out.end = bone.end;
  out.radius_m = static_cast<double>(segment.radius_m);
  out.density_kg_m3 = static_cast<double>(segment.density_kg_m3);
  out.young_modulus_pa = static_cast<double>(segment.young_modulus_pa);
  out.torsion_modulus_pa = static_cast<double>(segment.torsion_modulus_pa);
  out.damping_s = static_cast<double>(segment.damping_s);
  out.drag_per_s = static_cast<double>(segment.drag_per_s);
  return out;
}

void add_lock(const std::vector<rods::SegmentDef>& strand, size_t index, Character& to,
              baker::TissueLayout& layout) {
  baker::Rod rod;
  rod.name = "lock_" + std::to_string(index);
  rod.attach = kHead;
  rod.gravity = kGravityOfHair;
  rod.sag = 1;
  const std::vector<LockBone> bones = bones_of(strand);
  for (size_t i = 0; i < bones.size(); ++i) {
    const auto joint = static_cast<int>(to.joint_node.size());
    add_joint(rod.name + "_" + std::to_string(i), i == 0 ? static_cast<int>(kHead) : joint - 1,
              bones[i].begin, i == 0 ? kAt[kHead] : bones[i - 1].begin, to);
    baker::RodBone bone = like(strand[i + 1], bones[i]);
    if (i > 0) bone.begin = rod.bones.back().end;
    bone.joint = joint;
    bone.parent = static_cast<int>(i) - 1;
    rod.bones.push_back(bone);
  }
  layout.rods.push_back(rod);
}

uint32_t joint_of(const BustProxy& proxy) {
  return proxy.head_share > 0.75 ? kHead : proxy.head_share > 0.25 ? kNeck : kChest;
}

Eigen::Affine3d turned(double angle_rad) {
  return Eigen::Affine3d(Eigen::AngleAxisd(angle_rad, Vector3d::UnitY()));
}

double angle_of(uint32_t joint, const Turning& t) {
  if (joint == kChest) return t.chest_rad;
  return joint == kNeck ? 0.5 * (t.chest_rad + t.head_rad) : t.head_rad;
}

Matrix34 matrix(const Eigen::Affine3d& from) {
  Matrix34 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out.m[r][c] = static_cast<float>(from(r, c));
  return out;
}

}  // namespace

std::vector<std::byte> pack_haired(const Bust& bust, const Locks& locks) {
  Character character;
  character.name = "haired bust";
  const char* const names[] = {"chest", "neck", "head"};
  for (uint32_t j = 0; j < kBustJoints; ++j)
    add_joint(names[j], static_cast<int>(j) - 1, kAt[j], j == 0 ? Vector3d::Zero() : kAt[j - 1], character);
  add_skin(bust, character);
  add_ground(character);
  baker::TissueLayout layout;
  for (size_t s = 0; s < locks.size(); ++s) add_lock(locks[s], s, character, layout);
  for (const BustProxy& p : bust.proxies)
    layout.proxies.push_back({static_cast<int>(joint_of(p)), p.from, p.to, p.radius_m});
  layout.stiffness = character.stiffness;
  // A second control graph like the first, on which rods touch the capsules.
  const baker::GraphLevel same{layout, {}};
  return baker::pack_character(character, layout, {}, nullptr, {&same, 1});
}

std::vector<Matrix34> haired_pose(std::span<const LockBone> bones, const Turning& turning) {
  std::vector<Matrix34> out;
  for (uint32_t j = 0; j < kBustJoints; ++j)
    out.push_back(matrix(turned(angle_of(j, turning)) * Eigen::Translation3d(kAt[j])));
  for (const LockBone& bone : bones)
    out.push_back(matrix(turned(turning.head_rad) * Eigen::Translation3d(bone.begin)));
  return out;
}

std::vector<LockBone> lock_bones(const Locks& locks) {
  std::vector<LockBone> out;
  for (const auto& strand : locks) {
    const std::vector<LockBone> bones = bones_of(strand);
    out.insert(out.end(), bones.begin(), bones.end());
  }
  return out;
}

std::vector<float> haired_skin(const Bust& bust, const Turning& turning) {
  std::vector<float> out;
  out.reserve(3 * bust.rest_m.size());
  for (const Vector3d& p : bust.rest_m) {
    const auto shares = shares_at(p);
    Vector3d place = Vector3d::Zero();
    for (uint32_t j = 0; j < kBustJoints; ++j) place += shares[j] * (turned(angle_of(j, turning)) * p);
    for (int k = 0; k < 3; ++k) out.push_back(static_cast<float>(place[k]));
  }
  return out;
}

}  // namespace sinew::sample

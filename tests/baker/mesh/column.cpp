// column.cpp  Vertices, bones and weights of the column.
#include "column.hpp"

#include <algorithm>
#include <cmath>

using namespace sinew::baker;

namespace {

constexpr int kSides = 24, kRings = 41, kJoints = 4;
constexpr double kRadius = 0.2, kStep = 0.05, kBone = 0.5, kBlend = 0.2;

Influences influences_at(double y) {
  Influences skin;
  const double place = y / kBone, nearest = std::round(place);
  const double share = std::clamp(0.5 + (place - nearest) * kBone / kBlend, 0.0,
                                  1.0);  // of the joint that begins at `nearest`
  const int above = std::clamp(static_cast<int>(nearest), 0, kJoints - 1),
            below = std::clamp(static_cast<int>(nearest) - 1, 0, kJoints - 1);
  skin.joint[0] = share >= 0.5 || above == below ? above : below;
  skin.weight[0] = above == below ? 1 : std::max(share, 1 - share);
  if (skin.weight[0] < 1)
    skin.joint[1] = skin.joint[0] == above ? below : above, skin.weight[1] = 1 - skin.weight[0];
  return skin;
}

void add_vertex(Character& character, const Vector3& place, const Vector3& normal, int welded) {
  character.positions.push_back(place);
  character.normals.push_back(normal);
  character.skin.push_back(influences_at(place.y()));
  character.colors.push_back({255, 255, 255, 255});
  character.welded.push_back(welded < 0 ? static_cast<int>(character.positions.size()) - 1 : welded);
}

void add_bones(Character& character) {
  for (int j = 0; j < kJoints; ++j) {
    Node node;
    node.name = "bone_" + std::to_string(j);
    node.parent = j - 1;
    node.translation = Vector3(0, j == 0 ? 0 : kBone, 0);
    character.nodes.push_back(node);
    character.joint_node.push_back(j);
    character.joint_parent.push_back(j - 1);
    Matrix4 bind = Matrix4::Identity();
    bind(1, 3) = -kBone * j;
    character.inverse_bind.push_back(bind);
  }
}

}  // namespace

Character column() {
  Character character;
  character.name = "column";
  add_bones(character);
  for (int ring = 0; ring < kRings; ++ring)
    for (int side = 0; side <= kSides; ++side) {  // the last one doubles the first
      const double angle = 2 * M_PI * (side % kSides) / kSides;
      const Vector3 out(std::cos(angle), 0, std::sin(angle));
      add_vertex(character, kRadius * out + Vector3(0, kStep * ring, 0), out,
                 side == kSides ? ring * (kSides + 1) : -1);
    }
  const int bottom = static_cast<int>(character.positions.size()), top = bottom + 1;
  add_vertex(character, Vector3::Zero(), -Vector3::UnitY(), -1);
  add_vertex(character, Vector3(0, kStep * (kRings - 1), 0), Vector3::UnitY(), -1);
  for (int side = 0; side < kSides; ++side) {
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      const int a = ring * (kSides + 1) + side, b = a + kSides + 1;
      character.triangles.push_back({a, b, a + 1});
      character.triangles.push_back({a + 1, b, b + 1});
    }
    const int last = (kRings - 1) * (kSides + 1) + side;
    character.triangles.push_back({bottom, side, side + 1});
    character.triangles.push_back({top, last + 1, last});
  }
  return character;
}

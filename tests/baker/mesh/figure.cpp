// figure.cpp  Tubes, strips and balls on bones.
#include "figure.hpp"

#include <algorithm>
#include <cmath>

using namespace sinew::baker;

namespace {

constexpr int kSides = 10, kRings = 13;

Influences on_one(int joint) {
  Influences skin;
  skin.joint[0] = joint;
  skin.weight[0] = 1;
  return skin;
}

Influences on_two(int a, double share_of_a, int b) {
  Influences skin;
  const bool a_first = share_of_a >= 0.5;
  skin.joint[0] = a_first ? a : b;
  skin.weight[0] = std::max(share_of_a, 1 - share_of_a);
  if (skin.weight[0] < 1) skin.joint[1] = a_first ? b : a, skin.weight[1] = 1 - skin.weight[0];
  return skin;
}

// At `along` of the way over the bones: wholly the joint's in the middle of its bone, halves where two meet.
Influences along_bones(const std::vector<int>& joints, double along) {
  const double at = along * static_cast<double>(joints.size());
  const auto bone = std::min(static_cast<size_t>(at), joints.size() - 1);
  const double within = at - static_cast<double>(bone) - 0.5;
  const int own = joints[bone];
  if (within > 0 && bone + 1 < joints.size()) return on_two(own, 1 - within, joints[bone + 1]);
  if (within < 0 && bone > 0) return on_two(own, 1 + within, joints[bone - 1]);
  return on_one(own);
}

}  // namespace

Vector3 Figure::place(int joint) const {
  return -character.inverse_bind[static_cast<size_t>(joint)].topRightCorner<3, 1>();
}

int Figure::joint(const std::string& name, int parent, const Vector3& at) {
  Node node;
  node.name = name;
  node.parent = parent < 0 ? -1 : character.joint_node[static_cast<size_t>(parent)];
  node.translation = parent < 0 ? at : Vector3(at - place(parent));
  character.joint_node.push_back(static_cast<int>(character.nodes.size()));
  character.nodes.push_back(node);
  character.joint_parent.push_back(parent);
  Matrix4 bind = Matrix4::Identity();
  bind.topRightCorner<3, 1>() = -at;
  character.inverse_bind.push_back(bind);
  return static_cast<int>(character.joint_node.size()) - 1;
}

std::vector<int> Figure::chain(const std::string& name, int parent, const Vector3& begin, const Vector3& step,
                               int count) {
  std::vector<int> joints;
  for (int i = 0; i < count; ++i)
    joints.push_back(joint(name + std::to_string(i + 1), i == 0 ? parent : joints.back(), begin + i * step));
  end_site(joints.back(), step);
  return joints;
}

void Figure::end_site(int joint, const Vector3& offset) {
  Node node;
  node.name = "end";
  node.parent = character.joint_node[static_cast<size_t>(joint)];
  node.translation = offset;
  character.nodes.push_back(node);
}

int Figure::vertex(const Vector3& at, const Vector3& normal, const Influences& skin) {
  character.positions.push_back(at);
  character.normals.push_back(normal);
  character.skin.push_back(skin);
  character.colors.push_back({255, 255, 255, 255});
  const int own = static_cast<int>(character.positions.size()) - 1;
  character.welded.push_back(own);
  return own;
}

void Figure::tube(const std::vector<int>& joints, const Vector3& end, double radius) {
  std::vector<Vector3> path;
  for (const int j : joints) path.push_back(place(j));
  path.push_back(end);
  const Vector3 axis = (path.back() - path.front()).normalized();
  const Vector3 side = axis.unitOrthogonal(), other = axis.cross(side);
  std::vector<int> rings;
  for (int ring = 0; ring < kRings; ++ring) {
    const double along = ring / (kRings - 1.0), at = along * static_cast<double>(joints.size());
    const auto bone = std::min(static_cast<size_t>(at), joints.size() - 1);
    const Vector3 centre = path[bone] + (at - static_cast<double>(bone)) * (path[bone + 1] - path[bone]);
    for (int s = 0; s < kSides; ++s) {
      const double angle = 2 * M_PI * s / kSides;
      const Vector3 out = std::cos(angle) * side + std::sin(angle) * other;
      rings.push_back(vertex(centre + radius * out, out, along_bones(joints, along)));
    }
  }
  const int bottom = vertex(path.front(), -axis, along_bones(joints, 0)),
            top = vertex(end, axis, along_bones(joints, 1));
  const auto at = [&](int ring, int s) { return rings[static_cast<size_t>(ring * kSides + s % kSides)]; };
  for (int s = 0; s < kSides; ++s) {
    character.triangles.push_back({bottom, at(0, s + 1), at(0, s)});
    character.triangles.push_back({top, at(kRings - 1, s), at(kRings - 1, s + 1)});
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      character.triangles.push_back({at(ring, s), at(ring, s + 1), at(ring + 1, s)});
      character.triangles.push_back({at(ring, s + 1), at(ring + 1, s + 1), at(ring + 1, s)});
    }
  }
}

void Figure::sheet(const std::vector<int>& joints, const Vector3& end, const Vector3& half_width) {
  const Vector3 begin = place(joints.front()), normal = (end - begin).cross(half_width).normalized();
  int before = -1;
  for (int ring = 0; ring < kRings; ++ring) {
    const double along = ring / (kRings - 1.0);
    const Vector3 centre = begin + along * (end - begin);
    const int left = vertex(centre - half_width, normal, along_bones(joints, along));
    vertex(centre + half_width, normal, along_bones(joints, along));
    if (before >= 0) {
      character.triangles.push_back({before, before + 1, left});
      character.triangles.push_back({before + 1, left + 1, left});
    }
    before = left;
  }
}

void Figure::bulge(int joint, int on, double radius) {
  const Vector3 centre = place(joint);
  std::vector<int> rings;
  for (int ring = 1; ring < kRings; ++ring) {
    const double polar = M_PI * ring / kRings;
    for (int s = 0; s < kSides; ++s) {
      const double angle = 2 * M_PI * s / kSides;
      const Vector3 out(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                        std::cos(polar));
      rings.push_back(vertex(centre + radius * out, out, on_two(joint, 0.4 * std::max(0.0, out.z()), on)));
    }
  }
  const int front = vertex(centre + Vector3(0, 0, radius), Vector3::UnitZ(), on_two(joint, 0.4, on)),
            back = vertex(centre - Vector3(0, 0, radius), -Vector3::UnitZ(), on_one(on));
  const auto at = [&](int ring, int s) { return rings[static_cast<size_t>(ring * kSides + s % kSides)]; };
  for (int s = 0; s < kSides; ++s) {
    character.triangles.push_back({front, at(0, s), at(0, s + 1)});
    character.triangles.push_back({back, at(kRings - 2, s + 1), at(kRings - 2, s)});
    for (int ring = 0; ring + 2 < kRings; ++ring) {
      character.triangles.push_back({at(ring, s), at(ring + 1, s), at(ring, s + 1)});
      character.triangles.push_back({at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1)});
    }
  }
}

void Figure::mesh(const std::string& name, bool skinned) {
  Node node;
  node.name = name;
  character.nodes.push_back(node);
  character.meshes.push_back(
      {static_cast<int>(character.nodes.size()) - 1, meshed_, character.positions.size() - meshed_, skinned});
  meshed_ = character.positions.size();
}

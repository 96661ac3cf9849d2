// bodies.hpp  Boxes for tests: as tetrahedra, and as skinned surfaces.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <vector>

#include "baker/import/character/character.hpp"
#include "baker/truth/cage/voxel_split.hpp"

namespace sinew::test {

using baker::Vector3;

struct Body {
  std::vector<Vector3> nodes;
  std::vector<std::array<int, 4>> tetrahedra;
  std::vector<bool> held(const std::function<bool(const Vector3&)>& is_held) const {
    std::vector<bool> flags;
    for (const Vector3& node : nodes) flags.push_back(is_held(node));
    return flags;
  }
  Eigen::VectorXd flat() const {
    return Eigen::Map<const Eigen::VectorXd>(nodes.data()->data(),
                                             3 * static_cast<Eigen::Index>(nodes.size()));
  }
};

inline Body box_body(const std::array<int, 3>& cells, double cell_m) {
  Body body;
  const auto id = [&](int i, int j, int k) { return (k * (cells[1] + 1) + j) * (cells[0] + 1) + i; };
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) body.nodes.push_back(cell_m * Vector3(i, j, k));
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        for (const auto& corner : baker::kVoxelSplit[static_cast<size_t>((i + j + k) % 2)]) {
          std::array<int, 4> t{};
          for (size_t a = 0; a < 4; ++a)
            t[a] = id(i + (corner[a] & 1), j + (corner[a] >> 1 & 1), k + (corner[a] >> 2 & 1));
          body.tetrahedra.push_back(t);
        }
  return body;
}

// A closed box of squares no larger than `spacing`, all of it moved by joint `joint`. `open`: without its
// top.
inline void add_box(baker::Character& c, const Vector3& low, const Vector3& high, double spacing, int joint,
                    bool open = false) {
  std::map<std::array<int, 3>, int> number;
  std::array<int, 3> parts{};
  for (int a = 0; a < 3; ++a)
    parts[static_cast<size_t>(a)] =
        std::max(1, static_cast<int>(std::ceil((high - low)[a] / spacing - 1e-9)));
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, added] = number.try_emplace(at, static_cast<int>(c.positions.size()));
    if (!added) return entry->second;
    Vector3 p, normal = Vector3::Zero();
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<size_t>(a);
      p[a] = low[a] + (high - low)[a] * at[axis] / parts[axis];
      normal[a] = at[axis] == 0 ? -1 : at[axis] == parts[axis] ? 1 : 0;
    }
    c.positions.push_back(p);
    c.normals.push_back(normal.normalized());
    c.skin.emplace_back();
    c.skin.back().joint[0] = joint;
    c.skin.back().weight[0] = 1;
    c.colors.push_back({255, 255, 255, 255});
    c.welded.push_back(entry->second);
    return entry->second;
  };
  for (size_t axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      if (open && axis == 1 && side == 1) continue;
      const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int i = 0; i < parts[u]; ++i)
        for (int j = 0; j < parts[v]; ++j) {
          const auto corner = [&](int di, int dj) {
            std::array<int, 3> at{};
            at[axis] = side * parts[axis], at[u] = i + di, at[v] = j + dj;
            return vertex(at);
          };
          const int p = corner(0, 0), q = corner(1, 0), r = corner(1, 1), s = corner(0, 1);
          if (side == 1)
            c.triangles.push_back({p, q, r}), c.triangles.push_back({p, r, s});
          else
            c.triangles.push_back({p, r, q}), c.triangles.push_back({p, s, r});
        }
    }
}

inline baker::Character bare_character(const std::vector<Vector3>& joints) {
  baker::Character c;
  c.name = "test";
  for (size_t j = 0; j < joints.size(); ++j) {
    c.nodes.emplace_back();
    c.nodes.back().name = "joint_" + std::to_string(j);
    c.nodes.back().parent = static_cast<int>(j) - 1;
    c.nodes.back().translation = j == 0 ? joints[0] : Vector3(joints[j] - joints[j - 1]);
    c.joint_node.push_back(static_cast<int>(j));
    c.joint_parent.push_back(static_cast<int>(j) - 1);
    c.inverse_bind.push_back(baker::Matrix4::Identity());
    c.inverse_bind.back().block<3, 1>(0, 3) = -joints[j];
  }
  return c;
}

}  // namespace sinew::test

// smooth_groups.cpp  see smooth_groups.hpp.
#include "baker/import/character/smooth_groups.hpp"

#include <Eigen/Geometry>
#include <numeric>

namespace sinew::baker {
namespace {

// Cosines. Normals of a seam's two sides differ by what bytes round them to, facets of a low-poly body by
// more; edges of a mesh that states no normals look hard from 60 degrees on.
constexpr double kSameNormal = 0.9999, kSmoothEdge = 0.5;

struct Facing {
  Vector3 direction = Vector3::Zero();
  bool stated = false;
};

}  // namespace

std::vector<Vector3> area_vectors(const Character& character, const std::vector<int>& groups) {
  std::vector<Vector3> sum(character.positions.size(), Vector3::Zero());
  for (const auto& face : character.triangles) {
    const Vector3& a = character.positions[static_cast<size_t>(face[0])];
    const Vector3 twice_area = (character.positions[static_cast<size_t>(face[1])] - a)
                                   .cross(character.positions[static_cast<size_t>(face[2])] - a);
    for (const int corner : face) sum[static_cast<size_t>(groups[static_cast<size_t>(corner)])] += twice_area;
  }
  std::vector<Vector3> of_vertex;
  for (const int first : groups) of_vertex.push_back(sum[static_cast<size_t>(first)]);
  return of_vertex;
}

std::vector<int> smooth_groups(const Character& character) {
  const size_t count = character.positions.size();
  std::vector<int> groups(count);
  std::iota(groups.begin(), groups.end(), 0);
  const std::vector<Vector3> own = area_vectors(character, groups);
  std::vector<Facing> facing(count);
  for (size_t v = 0; v < count; ++v) {
    facing[v].stated = !character.normals[v].isZero(0);
    const Vector3& direction = facing[v].stated ? character.normals[v] : own[v];
    if (direction.norm() > 0) facing[v].direction = direction.normalized();
  }
  std::vector<int> next(count, -1);  // the next first of a group at the same place
  for (size_t v = 0; v < count; ++v) {
    const int welded = character.welded[v];
    int last = -1;
    for (int first = welded; first >= 0 && first < static_cast<int>(v);
         first = next[static_cast<size_t>(first)]) {
      const Facing &a = facing[static_cast<size_t>(first)], &b = facing[v];
      const double alike = a.stated && b.stated ? kSameNormal : kSmoothEdge;
      if (a.direction.dot(b.direction) > alike || b.direction.isZero(0)) {
        groups[v] = first;
        break;
      }
      last = first;
    }
    if (groups[v] == static_cast<int>(v) && last >= 0) next[static_cast<size_t>(last)] = static_cast<int>(v);
  }
  return groups;
}

}  // namespace sinew::baker

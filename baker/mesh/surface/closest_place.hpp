// closest_place.hpp  The place of a set of triangles that is closest to a point.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "baker/import/character/character.hpp"

namespace sinew::baker {

// On an edge, of the triangle that faces the point most.
struct SurfacePlace {
  int triangle = 0;               // of the character
  std::array<double, 3> share{};  // barycentric, of its corners
  Vector3 position = Vector3::Zero();
  double distance_m = 0;
  double facing = 0;  // cosine between the triangle's normal and the way to the point, of either side
};

// A tree of boxes, split at the median. Building costs n log n, a query about log n.
class ClosestPlace {
 public:
  // The character outlives it.
  ClosestPlace(const Character& character, std::vector<int> triangles);

  // None where nothing is within reach.
  std::optional<SurfacePlace> find(const Vector3& point, double reach_m) const;
  Eigen::AlignedBox3d box() const { return boxes_.empty() ? Eigen::AlignedBox3d() : boxes_.front().box; }

 private:
  struct Box {
    Eigen::AlignedBox3d box = {};
    int first = 0, count = 0;  // of triangles_
    int second = 0;            // the other half's; the first one's follows its parent. 0: it has no halves
  };
  struct Boxed {
    int triangle = 0;
    Eigen::AlignedBox3d box = {};
  };
  int build(std::vector<Boxed>& all, int first, int count);
  void search(int at, const Vector3& point, SurfacePlace& best) const;
  bool second_is_nearer(int at, const Vector3& point) const;

  const Character& character_;
  std::vector<int> triangles_;
  std::vector<Box> boxes_;
};

}  // namespace sinew::baker

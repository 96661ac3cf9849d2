// flesh_shape.cpp  Rays through a part, and pieces of surface on one bone.
#include "baker/mesh/surface/flesh_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace sinew::baker {
namespace {

constexpr double kWholly = 0.99;        // skin weight of the one joint
constexpr size_t kMostRays = 48;        // a part; enough for a median
constexpr double kBesideVertex = 1e-6;  // of a ray's reach: where it begins

struct Ray {
  Vector3 from, along;
  int vertex = 0;  // welded; its own triangles do not end it
};

// Metres to where the ray leaves matter through this triangle; infinity where it does not.
double exit_through(const Character& character, const std::array<int, 3>& face, const Ray& ray) {
  const auto corner = [&](size_t k) -> const Vector3& {
    return character.positions[static_cast<size_t>(face[k])];
  };
  const Vector3 ab = corner(1) - corner(0), ac = corner(2) - corner(0), p = ray.along.cross(ac);
  const double determinant = ab.dot(p), none = std::numeric_limits<double>::infinity();
  if (determinant >= 0) return none;  // it faces the ray: matter begins here
  const Vector3 to = ray.from - corner(0), q = to.cross(ab);
  const double u = to.dot(p) / determinant, v = ray.along.dot(q) / determinant;
  if (u < 0 || v < 0 || u + v > 1) return none;
  for (const int v_own : face)
    if (character.welded[static_cast<size_t>(v_own)] == ray.vertex) return none;
  return ac.dot(q) / determinant;
}

double way_through(const Character& character, const Ray& ray, double reach) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& face : character.triangles) {
    const double t = exit_through(character, face, ray);
    if (t > kBesideVertex * reach) nearest = std::min(nearest, t);
  }
  return std::isfinite(nearest) ? nearest : 0;
}

}  // namespace

std::vector<int> fastened_to(const Character& character, const Surface& surface) {
  const std::vector<int> piece =
      connected_parts(surface, std::vector<bool>(character.positions.size(), true));
  constexpr int kNone = -2, kMany = -1;
  std::vector<int> joint_of_piece;
  for (size_t v = 0; v < piece.size(); ++v) {
    if (piece[v] < 0) continue;
    const auto id = static_cast<size_t>(piece[v]);
    if (id >= joint_of_piece.size()) joint_of_piece.resize(id + 1, kNone);
    int& joint = joint_of_piece[id];
    const Influences& skin = character.skin[v];
    if (skin.weight[0] < kWholly || (joint != kNone && joint != skin.joint[0]))
      joint = kMany;
    else if (joint == kNone)
      joint = skin.joint[0];
  }
  std::vector<int> joints(piece.size(), kMany);
  for (size_t v = 0; v < piece.size(); ++v)
    if (piece[v] >= 0) joints[v] = joint_of_piece[static_cast<size_t>(piece[v])];
  return joints;
}

double extent_m(const Character& character, const std::vector<int>& vertices) {
  Eigen::AlignedBox3d box;
  for (const int v : vertices) box.extend(character.positions[static_cast<size_t>(v)]);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

double thickness_share(const Character& character, const std::vector<int>& vertices) {
  const double extent = extent_m(character, vertices);
  if (!(extent > 0)) return 0;
  std::vector<double> ways;
  const size_t step = std::max<size_t>(1, vertices.size() / kMostRays);
  for (size_t i = 0; i < vertices.size(); i += step) {
    const auto v = static_cast<size_t>(vertices[i]);
    ways.push_back(
        way_through(character, {character.positions[v], -character.normals[v], character.welded[v]}, extent));
  }
  std::ranges::nth_element(ways, ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2));
  return ways[ways.size() / 2] / extent;
}

}  // namespace sinew::baker

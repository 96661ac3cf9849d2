// tangents.cpp  see tangents.hpp.
#include "baker/import/meshes/tangents.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "baker/import/character/smooth_groups.hpp"

namespace sinew::baker {
namespace {

// How the picture lies on a triangle.
struct Spread {
  Vector3 along;  // growing u, unit
  bool mirrored;
};

struct Sum {
  Vector3 along = Vector3::Zero();
  double angle_rad = 0;
};

// Of the triangles that show the picture upright, and of those that show it mirrored.
using Sides = std::array<Sum, 2>;

// Nothing where it is not spread over the triangle. v runs down the picture: upright on a triangle that goes
// round counterclockwise, its corners go round clockwise in uv.
std::optional<Spread> spread_on(const std::array<int, 3>& face, const Character& character,
                                const std::vector<Vector2>& uv) {
  const auto place = [&](size_t corner) { return character.positions[static_cast<size_t>(face[corner])]; };
  const auto at = [&](size_t corner) { return uv[static_cast<size_t>(face[corner])]; };
  const Vector2 a = at(1) - at(0), b = at(2) - at(0);
  const double twice_area = a.x() * b.y() - a.y() * b.x();
  const Vector3 along =
      std::copysign(1.0, twice_area) * (b.y() * (place(1) - place(0)) - a.y() * (place(2) - place(0)));
  const bool is_spread =
      std::isfinite(twice_area) && twice_area != 0 && along.allFinite() && along.norm() > 0;
  if (!is_spread) return std::nullopt;
  return Spread{along.normalized(), twice_area > 0};
}

double angle_at(size_t corner, const std::array<int, 3>& face, const Character& character) {
  const auto place = [&](size_t k) { return character.positions[static_cast<size_t>(face[k % 3])]; };
  const Vector3 one = place(corner + 1) - place(corner), other = place(corner + 2) - place(corner);
  return std::atan2(one.cross(other).norm(), one.dot(other));
}

// Vertices at one place that face alike and lie at one uv have one tangent: vertex -> its number.
std::vector<size_t> number_frames(const std::vector<Vector2>& uv, const Character& character) {
  const std::vector<int> groups = smooth_groups(character);
  std::map<std::tuple<int, double, double>, size_t> numbers;
  std::vector<size_t> frames(uv.size());
  for (size_t v = 0; v < uv.size(); ++v)  // a NaN would have no place in the order
    frames[v] = numbers
                    .try_emplace(uv[v].allFinite() ? std::tuple(groups[v], uv[v].x(), uv[v].y())
                                                   : std::tuple(-1, 0.0, 0.0),
                                 numbers.size())
                    .first->second;
  return frames;
}

Vector3 square_to(const Vector3& normal, const Vector3& direction) {
  return direction - normal * normal.dot(direction);
}

std::vector<Sides> add_up(const std::vector<size_t>& frames, const std::vector<Vector2>& uv,
                          const Character& character) {
  std::vector<Sides> sums(uv.size());
  for (const std::array<int, 3>& face : character.triangles) {
    const std::optional<Spread> spread = spread_on(face, character, uv);
    if (!spread) continue;
    for (size_t corner = 0; corner < 3; ++corner) {
      const auto vertex = static_cast<size_t>(face[corner]);
      const Vector3 along = square_to(character.normals[vertex], spread->along);
      if (!(along.norm() > 0)) continue;
      const double angle_rad = angle_at(corner, face, character);
      Sum& sum = sums[frames[vertex]][spread->mirrored ? 1 : 0];
      sum.along += angle_rad * along.normalized();
      sum.angle_rad += angle_rad;
    }
  }
  return sums;
}

Tangent tangent_of(const Sides& sides, const Vector3& normal) {
  constexpr double kNoDirection = 1e-9;  // of the angles: what rounding leaves of sums that cancel
  const bool mirrored = sides[1].angle_rad > sides[0].angle_rad;
  const Sum& sum = sides[mirrored ? 1 : 0];
  const Vector3 along = square_to(normal, sum.along);
  if (!(along.norm() > kNoDirection * sum.angle_rad)) return {normal.unitOrthogonal(), 1};
  return {along.normalized(), mirrored ? -1.0 : 1.0};
}

}  // namespace

void compute_missing_tangents(const std::vector<Vector2>& uv, Character& character) {
  const auto is_missing = [](const Tangent& tangent) { return tangent.along.isZero(0); };
  const bool has_uv = std::ranges::any_of(uv, [](const Vector2& at) { return at.allFinite(); });
  if (!has_uv && std::ranges::all_of(character.tangents, is_missing)) return character.tangents.clear();
  const std::vector<size_t> frames = number_frames(uv, character);
  const std::vector<Sides> sums = add_up(frames, uv, character);
  for (size_t v = 0; v < uv.size(); ++v)
    if (is_missing(character.tangents[v]))
      character.tangents[v] = tangent_of(sums[frames[v]], character.normals[v]);
}

}  // namespace sinew::baker

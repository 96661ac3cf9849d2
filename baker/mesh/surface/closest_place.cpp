// closest_place.cpp  see closest_place.hpp.
#include "baker/mesh/surface/closest_place.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::baker {
namespace {

constexpr int kFewTriangles = 4;
constexpr double kSameDistance = 1e-9;  // of it: triangles that share an edge are as near

struct Corners {
  const Vector3 &a, &b, &c;
};

Corners corners_of(const Character& character, int triangle) {
  const auto& face = character.triangles[static_cast<size_t>(triangle)];
  const auto at = [&](size_t k) -> const Vector3& {
    return character.positions[static_cast<size_t>(face[k])];
  };
  return {at(0), at(1), at(2)};
}

// By which of the triangle's corners, edges and face is nearest (Ericson 2005, 5.1.5).
std::array<double, 3> nearest_share(const Corners& t, const Vector3& p) {
  const Vector3 ab = t.b - t.a, ac = t.c - t.a, ap = p - t.a, bp = p - t.b, cp = p - t.c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double of_c = d1 * d4 - d3 * d2, of_b = d5 * d2 - d1 * d6, of_a = d3 * d6 - d5 * d4;
  if (of_c <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (of_b <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (of_a <= 0 && d4 >= d3 && d5 >= d6) {
    const double way = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - way, way};
  }
  const double all = of_a + of_b + of_c;
  return {of_a / all, of_b / all, of_c / all};
}

}  // namespace

ClosestPlace::ClosestPlace(const Character& character, std::vector<int> triangles)
    : character_(character), triangles_(std::move(triangles)) {
  if (triangles_.empty()) return;
  std::vector<Boxed> all;
  for (const int triangle : triangles_) {
    const Corners t = corners_of(character_, triangle);
    Boxed& one = all.emplace_back(Boxed{triangle, Eigen::AlignedBox3d(t.a)});
    one.box.extend(t.b).extend(t.c);
  }
  build(all, 0, static_cast<int>(all.size()));
  for (size_t i = 0; i < all.size(); ++i) triangles_[i] = all[i].triangle;
}

int ClosestPlace::build(std::vector<Boxed>& all, int first, int count) {
  const auto at = boxes_.size();
  boxes_.push_back({{}, first, count, 0});
  const auto begin = all.begin() + first;
  for (auto i = begin; i < begin + count; ++i) boxes_[at].box.extend(i->box);
  if (count <= kFewTriangles) return static_cast<int>(at);
  Eigen::Index axis = 0;
  boxes_[at].box.sizes().maxCoeff(&axis);
  std::nth_element(begin, begin + count / 2, begin + count, [&](const Boxed& a, const Boxed& b) {
    const double at_a = a.box.center()[axis], at_b = b.box.center()[axis];
    return at_a != at_b ? at_a < at_b : a.triangle < b.triangle;
  });
  build(all, first, count / 2);
  const int second = build(all, first + count / 2, count - count / 2);
  boxes_[at].second = second;
  return static_cast<int>(at);
}

std::optional<SurfacePlace> ClosestPlace::find(const Vector3& point, double reach_m) const {
  SurfacePlace best;
  best.triangle = -1;
  best.distance_m = reach_m;
  if (!boxes_.empty()) search(0, point, best);
  if (best.triangle < 0) return std::nullopt;
  return best;
}

bool ClosestPlace::second_is_nearer(int at, const Vector3& point) const {
  const auto away = [&](int half) { return boxes_[static_cast<size_t>(half)].box.exteriorDistance(point); };
  return away(boxes_[static_cast<size_t>(at)].second) < away(at + 1);
}

void ClosestPlace::search(int at, const Vector3& point, SurfacePlace& best) const {
  const Box& box = boxes_[static_cast<size_t>(at)];
  if (box.box.exteriorDistance(point) > (1 + kSameDistance) * best.distance_m) return;
  if (box.second > 0) {
    const bool swap = second_is_nearer(at, point);
    search(swap ? box.second : at + 1, point, best);
    search(swap ? at + 1 : box.second, point, best);
    return;
  }
  for (int i = box.first; i < box.first + box.count; ++i) {
    const int triangle = triangles_[static_cast<size_t>(i)];
    const Corners t = corners_of(character_, triangle);
    const auto share = nearest_share(t, point);
    const Vector3 place = share[0] * t.a + share[1] * t.b + share[2] * t.c;
    const double distance = (place - point).norm();
    if (distance > (1 + kSameDistance) * best.distance_m) continue;
    const Vector3 normal = (t.b - t.a).cross(t.c - t.a).normalized();
    const double facing = distance > 0 ? std::abs((point - place).dot(normal)) / distance : 1;
    if (best.triangle < 0 || distance < (1 - kSameDistance) * best.distance_m || facing > best.facing)
      best = {triangle, share, place, distance, facing};
  }
}

}  // namespace sinew::baker

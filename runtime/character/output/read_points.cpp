// read_points.cpp  see read_points.hpp.
#include "character/output/read_points.hpp"

#include <algorithm>
#include <cmath>

#include "character/motion/placement.hpp"
#include "character/output/read.hpp"
#include "character/output/shown_skin.hpp"
#include "core/status.hpp"

namespace sinew::world {
namespace {

using core::make_status;
using Eigen::Matrix3f;
using Eigen::Vector3f;

Vector3f bind_place(const pack::PackView& pack, uint32_t vertex) noexcept {
  return Vector3f(&pack.positions[size_t{3} * vertex]);
}

// Of one vertex, in bind-pose axes.
Vector3f carried(const Instance& instance, uint32_t vertex) noexcept {
  Vector3f sum = Vector3f::Zero();
  const SoftVertices& soft = instance.asset->soft;
  const uint32_t slot = instance.marks.displaced ? soft.slot_of(vertex) : soft.count;
  if (slot == soft.count) return sum;
  for (const SoftVertices::Place& place : soft.places_of(slot)) {
    const float* delta = instance.published.carried + place.first;
    sum += instance.published.carried_share * Vector3f(delta[0], delta[place.pitch], delta[2 * place.pitch]);
  }
  return sum;
}

// matrix(joint): of its skin.
template <class Matrix>
Vector3f shown_place(const Instance& instance, uint32_t vertex, const Matrix& matrix) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const Vector3f moved = bind_place(pack, vertex) + carried(instance, vertex);
  const pack::SkinRecord& record = pack.skin[vertex];
  SkinMatrix skin = SkinMatrix::Zero();
  for (uint32_t k = 0; k < pack::kInfluences && record.weight[k] > 0; ++k)
    skin += record.weight[k] * matrix(record.joint[k]);
  return skin.leftCols<3>() * moved + skin.col(3);
}

// x along the first edge, z along the normal; none where the triangle has no area.
bool axes_of(const Vector3f (&corners)[3], Matrix3f* out) noexcept {
  const Vector3f edge = corners[1] - corners[0], normal = edge.cross(corners[2] - corners[0]);
  const float edge2 = edge.squaredNorm(), normal2 = normal.squaredNorm();
  if (!(edge2 > 0 && normal2 > 0 && std::isfinite(normal2))) return false;
  out->col(0) = edge / std::sqrt(edge2);
  out->col(2) = normal / std::sqrt(normal2);
  out->col(1) = out->col(2).cross(out->col(0));
  return true;
}

template <class Matrix>
Matrix34 frame_at(const Instance& instance, const Placement& to, const SurfacePlace& place,
                  const Matrix& matrix) noexcept {
  const pack::PackView& pack = instance.level->pack;
  const uint32_t* vertices = &pack.triangles[size_t{3} * place.triangle];
  Vector3f corners[3], bind[3], point = Vector3f::Zero();
  for (int k = 0; k < 3; ++k) {
    corners[k] = shown_place(instance, vertices[k], matrix);
    point += place.weights[k] * corners[k];
  }
  Matrix3f axes = Matrix3f::Identity();
  if (!axes_of(corners, &axes)) {
    for (int k = 0; k < 3; ++k) bind[k] = bind_place(pack, vertices[k]);
    axes_of(bind, &axes);
  }
  Matrix34 out;
  Eigen::Map<SkinMatrix> frame(&out.m[0][0]);
  frame.leftCols<3>() = to.rotation * axes;
  frame.col(3) = to.place(point);
  return out;
}

Status check_place(const SurfacePlace& place, size_t index, uint32_t triangles) noexcept {
  constexpr float kSumTolerance = 1e-3f;
  if (place.triangle >= triangles)
    return make_status(StatusCode::kInvalidArgument, "read_points: point %zu: triangle %u, the asset has %u",
                       index, place.triangle, triangles);
  const float sum = place.weights[0] + place.weights[1] + place.weights[2];
  if (!std::isfinite(sum))
    return make_status(StatusCode::kNotFinite, "read_points: point %zu: a weight is not finite", index);
  if (std::abs(sum - 1) > kSumTolerance)
    return make_status(StatusCode::kInvalidArgument, "read_points: point %zu: weights add up to %g, not to 1",
                       index, static_cast<double>(sum));
  return {};
}

}  // namespace

Status check_points(const PointsDef& def, std::span<const SurfacePlace> places, const Asset& asset) noexcept {
  if (def.space != Space::kCharacter && def.space != Space::kWorld)
    return make_status(StatusCode::kInvalidArgument, "read_points: space must be kCharacter or kWorld");
  if (Status status = check_origin(def.origin_m); !status.ok()) return status;
  for (size_t i = 0; i < places.size(); ++i)
    if (Status status = check_place(places[i], i, asset.pack.character->triangle_count); !status.ok())
      return status;
  return {};
}

void read_points(const Instance& instance, const PointsDef& def, std::span<const SurfacePlace> places,
                 Matrix34* out) noexcept {
  const Placement to = placement_of(instance, def.space, def.origin_m);
  // Three corners of some three joints each: of more joints than that all skin matrices together are cheaper.
  if (9 * places.size() < instance.level->pack.joints.size()) {
    for (size_t i = 0; i < places.size(); ++i)
      out[i] = frame_at(instance, to, places[i], [&](uint32_t joint) { return shown_skin(instance, joint); });
    return;
  }
  const ShownSkin skin(instance);
  for (size_t i = 0; i < places.size(); ++i)
    out[i] = frame_at(instance, to, places[i], [&](uint32_t joint) {
      return Eigen::Map<const SkinMatrix>(skin.matrices() + size_t{12} * joint);
    });
}

}  // namespace sinew::world

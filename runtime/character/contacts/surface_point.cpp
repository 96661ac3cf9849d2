// surface_point.cpp  see surface_point.hpp.
#include "character/contacts/surface_point.hpp"

#include <Eigen/Geometry>

#include "character/output/displacement_bound.hpp"
#include "character/transition/shares.hpp"

namespace sinew::world {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Matrix34f = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

Vector3f carried(const pack::PackView& pack, uint32_t region, uint32_t column, const float* displacement) {
  const pack::RegionRecord& record = pack.regions[region];
  const float* weight = pack.carry.data() + record.carry + column;
  Vector3f sum = Vector3f::Zero();
  for (uint32_t n = record.first_node; n < record.first_node + record.node_count;
       ++n, weight += record.padded_vertices)
    sum += *weight * Eigen::Map<const Vector3f>(displacement + size_t{3} * n);
  return sum;
}

Matrix34f blended(const pack::SkinRecord& skin, const float* matrices) {
  Matrix34f sum = Matrix34f::Zero();
  for (uint32_t k = 0; k < pack::kInfluences && skin.weight[k] > 0; ++k)
    sum += skin.weight[k] * Eigen::Map<const Matrix34f>(matrices + size_t{12} * skin.joint[k]);
  return sum;
}

// Where a region's columns begin in what is laid out as `carried`.
size_t columns_before(const pack::PackView& pack, uint32_t region) noexcept {
  size_t before = 0;
  for (uint32_t r = 0; r < region; ++r) before += size_t{3} * pack.regions[r].padded_vertices;
  return before;
}

// What is left of a change of level.
Vector3f seam(const Instance& instance, uint32_t region, uint32_t column) noexcept {
  const float share = seam_share(instance);
  if (share == 0) return Vector3f::Zero();
  const pack::PackView& pack = instance.level->pack;
  const float* at = instance.transition.seam + columns_before(pack, region) + column;
  const size_t pitch = pack.regions[region].padded_vertices;
  return share * Vector3f(at[0], at[pitch], at[2 * pitch]);
}

SurfacePoint placed(const Instance& instance, const SurfacePatches::Vertex& vertex,
                    const Vector3f& bind_place, uint32_t age) noexcept {
  const Matrix34f skin = blended(instance.level->pack.skin[vertex.index], instance.contacts.tick_skin[age]);
  const Matrix3f root =
      Eigen::Map<const Eigen::Quaternionf>(instance.contacts.tick_turn[age]).toRotationMatrix();
  return {root * (skin.leftCols<3>() * bind_place + skin.col(3)), root * skin.leftCols<3>()};
}

Vector3f push_at(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex) noexcept {
  size_t pitch = 0;
  const float* push = push_of(instance, region, vertex, &pitch);
  return Vector3f(push[0], push[pitch], push[2 * pitch]);
}

// As it is shown: within its bound.
Vector3f displaced_by(const Instance& instance, uint32_t region, uint32_t column, const float* displacement,
                      const Vector3f& push) noexcept {
  const Vector3f all =
      carried(instance.level->pack, region, column, displacement) + seam(instance, region, column) + push;
  return within_bound(all, displacement_bound_m(*instance.asset, region));
}

Vector3f bind_place(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
                    const float* displacement, const Vector3f& push) noexcept {
  const SurfacePatches& patches = instance.level->patches;
  Vector3f place =
      Eigen::Map<const Vector3f>(instance.level->pack.positions.data() + size_t{3} * vertex.index) +
      displaced_by(instance, region, vertex.carried, displacement, push);
  for (uint32_t o = vertex.also; o < patches.other_count && patches.others[o].index == vertex.index; ++o)
    place += displaced_by(instance, patches.others[o].region, patches.others[o].carried, displacement,
                          Vector3f::Zero());
  return place;
}

}  // namespace

SurfacePoint surface_point(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
                           const float* displacement, uint32_t age) noexcept {
  return placed(instance, vertex, bind_place(instance, region, vertex, displacement, Vector3f::Zero()), age);
}

Vector3f pushed_place(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
                      const float* displacement, uint32_t age) noexcept {
  const Vector3f push = push_at(instance, region, vertex);
  return placed(instance, vertex, bind_place(instance, region, vertex, displacement, push), age).place_m;
}

float* push_of(const Instance& instance, uint32_t region, const SurfacePatches::Vertex& vertex,
               size_t* pitch) noexcept {
  const pack::PackView& pack = instance.level->pack;
  *pitch = pack.regions[region].padded_vertices;
  return instance.contacts.pushes + columns_before(pack, region) + vertex.carried;
}

}  // namespace sinew::world

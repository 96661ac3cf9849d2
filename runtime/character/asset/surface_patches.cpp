// surface_patches.cpp  see surface_patches.hpp.
#include "character/asset/surface_patches.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <new>
#include <utility>

#include "core/status.hpp"

namespace sinew::world {
namespace {

using Eigen::Vector3f;

constexpr float kHardlyCarried = 0.05f;  // a vertex's weights together

Vector3f place(std::span<const float> positions, uint32_t vertex) {
  return Eigen::Map<const Vector3f>(positions.data() + size_t{3} * vertex);
}

// One region's share in a vertex.
struct Share {
  uint32_t index, region, carried, node;
  float largest, sum;  // of its weights
};

Share share_of(const pack::PackView& pack, uint32_t r, uint32_t carried) {
  const pack::RegionRecord& region = pack.regions[r];
  const float* weights = pack.carry.data() + region.carry + carried;
  Share share{pack.region_vertices[region.first_vertex + carried], r, carried, region.first_node, 0, 0};
  for (uint32_t n = 0; n < region.node_count; ++n) {
    const float weight = weights[size_t{n} * region.padded_vertices];
    share.sum += weight;
    if (weight <= share.largest) continue;
    share.largest = weight;
    share.node = region.first_node + n;
  }
  return share;
}

// By vertex, the one that carries most of it first.
bool comes_before(const Share& a, const Share& b) {
  if (a.index != b.index) return a.index < b.index;
  return a.largest != b.largest ? a.largest > b.largest : a.region < b.region;
}

void add_areas(const pack::PackView& pack, float* areas_m2) {
  for (size_t t = 0; t + 2 < pack.triangles.size(); t += 3) {
    const uint32_t* corner = pack.triangles.data() + t;
    const Vector3f a = place(pack.positions, corner[0]), b = place(pack.positions, corner[1]),
                   c = place(pack.positions, corner[2]);
    const float third = (b - a).cross(c - a).norm() / 6;
    for (int k = 0; k < 3; ++k) areas_m2[corner[k]] += third;
  }
}

bool hangs_on_rods(const pack::PackView& pack, uint32_t vertex) {
  if (pack.rods.empty()) return false;
  const pack::SkinRecord& skin = pack.skin[vertex];
  for (uint32_t k = 0; k < pack::kInfluences && skin.weight[k] > 0; ++k) {
    if (pack.joint_rods[skin.joint[k]] != pack::kNoIndex) return true;
  }
  return false;
}

// Puts vertices in their nodes' order; `shares` are sorted.
void lay_out(const pack::PackView& pack, std::span<const Share> shares, const float* areas_m2,
             SurfacePatches& to) {
  const auto each_vertex = [&](auto work) {
    for (size_t begin = 0, end = 0; begin < shares.size(); begin = end) {
      float sum = 0;
      for (; end < shares.size() && shares[end].index == shares[begin].index; ++end) sum += shares[end].sum;
      if (sum > kHardlyCarried && !hangs_on_rods(pack, shares[begin].index))
        work(shares.subspan(begin, end - begin));
    }
  };
  each_vertex([&](std::span<const Share> of) { ++to.first[of[0].node + 1], ++to.vertex_count; });
  for (size_t n = 0; n < pack.nodes.size(); ++n) to.first[n + 1] += to.first[n];
  each_vertex([&](std::span<const Share> of) {
    SurfacePatches::Vertex& vertex = to.vertices[to.first[of[0].node]++];
    vertex = {of[0].index, of[0].carried, of.size() > 1 ? to.other_count : pack::kNoIndex,
              areas_m2[of[0].index]};
    for (const Share& other : of.subspan(1))
      to.others[to.other_count++] = {other.index, other.region, other.carried};
  });
  for (size_t n = pack.nodes.size(); n > 0; --n) to.first[n] = to.first[n - 1];
  to.first[0] = 0;
}

void measure_radii(const pack::PackView& pack, SurfacePatches& to) {
  for (uint32_t n = 0; n < pack.nodes.size(); ++n) {
    to.radii_m[n] = 0;
    for (const SurfacePatches::Vertex& vertex : to.of(n)) {
      const float far = (place(pack.positions, vertex.index) - Vector3f(pack.nodes[n].position_m)).norm();
      to.radii_m[n] = std::max(to.radii_m[n], far);
    }
  }
}

}  // namespace

Status make_surface_patches(const pack::PackView& pack, SurfacePatches* out) noexcept {
  const size_t count = pack.region_vertices.size();
  std::unique_ptr<Share[]> shares(new (std::nothrow) Share[count]);
  std::unique_ptr<float[]> areas_m2(new (std::nothrow) float[pack.positions.size() / 3]());
  SurfacePatches made;
  made.vertices.reset(new (std::nothrow) SurfacePatches::Vertex[count]);
  made.others.reset(new (std::nothrow) SurfacePatches::Other[count]);
  made.first.reset(new (std::nothrow) uint32_t[pack.nodes.size() + 1]());
  made.radii_m.reset(new (std::nothrow) float[pack.nodes.size()]);
  if (!shares || !areas_m2 || !made.vertices || !made.others || !made.first || !made.radii_m)
    return core::make_status(StatusCode::kOutOfCapacity, "no memory for the patches of the soft surface");
  Share* share = shares.get();
  for (uint32_t r = 0; r < pack.regions.size(); ++r) {
    for (uint32_t v = 0; v < pack.regions[r].vertex_count; ++v) *share++ = share_of(pack, r, v);
  }
  std::sort(shares.get(), shares.get() + count, comes_before);
  add_areas(pack, areas_m2.get());
  lay_out(pack, {shares.get(), count}, areas_m2.get(), made);
  measure_radii(pack, made);
  *out = std::move(made);
  return {};
}

}  // namespace sinew::world

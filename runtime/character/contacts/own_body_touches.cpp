// own_body_touches.cpp  see own_body_touches.hpp.
#include "character/contacts/own_body_touches.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>
#include <utility>

#include "core/status.hpp"
#include "rods/contacts/find/sweep.hpp"
#include "rods/vector.hpp"

namespace sinew::world {
namespace {

using rods::Axis, rods::Vector;

constexpr double kNear = 0.1;  // of a capsule's radius: flesh is pressed beside it, too

// ---- what a region passes ----

constexpr double kTouching = 1 + kNear;  // of a capsule's radius, in the bind pose
constexpr float kCarried = 0.05f;        // of a vertex's skin

bool carries(uint32_t joint, const pack::SkinRecord& skin) noexcept {
  for (uint32_t k = 0; k < pack::kInfluences; ++k)
    if (skin.joint[k] == joint && skin.weight[k] > kCarried) return true;
  return false;
}

bool overlaps(const pack::ProxyRecord& proxy, const float* place_m) noexcept {
  const Axis axis = {rods::vector_of(proxy.from_m), rods::vector_of(proxy.to_m)};
  const Vector place = {place_m[0], place_m[1], place_m[2]};
  const Vector nearest = rods::between(axis.from, axis.to, rods::nearest(axis, place));
  return rods::length(rods::difference(place, nearest)) < kTouching * static_cast<double>(proxy.radius_m);
}

bool passes(const pack::PackView& pack, const pack::RegionRecord& region,
            const pack::ProxyRecord& proxy) noexcept {
  for (const uint32_t v : pack.region_vertices.subspan(region.first_vertex, region.vertex_count))
    if (carries(proxy.joint, pack.skin[v]) || overlaps(proxy, pack.positions.data() + size_t{3} * v))
      return true;
  return false;
}

// ---- what touches in a tick ----

constexpr double kNearWay = 0.25;  // of how far probe and capsule go against each other

struct MovingCapsule {
  Axis start, end;
  double radius_m;
};

Vector in_world(const RodCounters& rods, const double* place_m) noexcept {
  const auto& anchor = rods.anchor_m;
  return {anchor[0] + place_m[0], anchor[1] + place_m[1], anchor[2] + place_m[2]};
}

MovingCapsule capsule_of(const Instance& instance, uint32_t proxy) noexcept {
  const double *before = instance.contacts.proxy_before + size_t{6} * proxy,
               *now = instance.contacts.proxy_ends[0] + size_t{6} * proxy;
  return {{in_world(instance.state->rods, before), in_world(instance.state->rods, before + 3)},
          {in_world(instance.state->rods, now), in_world(instance.state->rods, now + 3)},
          static_cast<double>(instance.level->pack.proxies[proxy].radius_m)};
}

// A ball's middle.
struct Way {
  Vector start, end;
};

Way way_of(const ContactProbe& probe) noexcept {
  return {{probe.start_m[0][0], probe.start_m[0][1], probe.start_m[0][2]},
          {probe.end_m[0][0], probe.end_m[0][1], probe.end_m[0][2]}};
}

double closing_m(const MovingCapsule& capsule, const Way& way) noexcept {
  const Vector own = rods::difference(way.end, way.start);
  return std::max(rods::length(rods::difference(own, rods::difference(capsule.end.from, capsule.start.from))),
                  rods::length(rods::difference(own, rods::difference(capsule.end.to, capsule.start.to))));
}

// Out of the capsule, from a point of its axis.
struct WayOut {
  double share;
  Vector apart;
};

WayOut way_out(const Axis& axis, const Vector& place) noexcept {
  const double share = rods::nearest(axis, place);
  return {share, rods::difference(place, rods::between(axis.from, axis.to, share))};
}

// As seen from the axis, going straight.
double nearest_m(const Vector& start, const Vector& end) noexcept {
  return rods::length(rods::between(start, end, rods::nearest(Axis{start, end}, Vector{})));
}

// When what goes straight comes so near to the axis; 0 where it begins nearer, 1 where it never does.
double first_touch(const Vector& start, const Vector& end, double reach_m) noexcept {
  const Vector way = rods::difference(end, start);
  const double a = rods::dot(way, way), b = rods::dot(start, way),
               c = rods::dot(start, start) - reach_m * reach_m;
  if (!(c > 0)) return 0;
  const double under_root = b * b - a * c;
  if (!(b < 0 && under_root > 0)) return 1;
  return std::min(1.0, c / (std::sqrt(under_root) - b));
}

WayOut between(const WayOut& start, const WayOut& end, double time) noexcept {
  return {start.share + time * (end.share - start.share), rods::between(start.apart, end.apart, time)};
}

WayOut touched(const WayOut& start, const WayOut& end, double reach_m, NormalsOf normals) noexcept {
  const WayOut first = between(start, end, first_touch(start.apart, end.apart, reach_m));
  return normals == NormalsOf::kEnd && rods::dot(first.apart, end.apart) > 0 ? end : first;
}

// False: no contact. By compare, so that NaN is none.
bool touch(const MovingCapsule& capsule, const ContactProbe& probe, NormalsOf normals, WayOut* out) noexcept {
  const Way way = way_of(probe);
  const double reach_m = capsule.radius_m + static_cast<double>(probe.radius_m);
  const double closing = closing_m(capsule, way);
  const double near_m = reach_m + kNear * capsule.radius_m + kNearWay * closing;
  const WayOut end = way_out(capsule.end, way.end);
  if (!(rods::length(end.apart) < near_m + closing)) return false;
  const WayOut start = way_out(capsule.start, way.start);
  if (!(nearest_m(start.apart, end.apart) < near_m)) return false;
  *out = touched(start, end, reach_m, normals);
  return true;
}

// On the axis no way out is better than another.
Vector normal_of(const Vector& apart) noexcept {
  const double size = rods::length(apart);
  return size > 0 ? rods::scaled(1 / size, apart) : Vector{0, 1, 0};
}

ContactHit hit_of(const MovingCapsule& capsule, const ContactProbe& probe, const WayOut& out,
                  double tick_s) noexcept {
  const Vector from = rods::between(capsule.start.from, capsule.start.to, out.share),
               to = rods::between(capsule.end.from, capsule.end.to, out.share);
  const Vector normal = normal_of(out.apart);
  const Vector velocity = rods::scaled(1 / tick_s, rods::difference(to, from));
  ContactHit hit;
  hit.gap_m = rods::dot(normal, rods::difference(way_of(probe).start, from)) - capsule.radius_m -
              static_cast<double>(probe.radius_m);
  for (size_t k = 0; k < 3; ++k) {
    hit.normal[k] = static_cast<float>(normal[k]);
    hit.velocity_m_s[k] = static_cast<float>(velocity[k]);
  }
  return hit;
}

template <class Work>
void for_each_capsule(const Instance& instance, uint64_t capsules, Work work) noexcept {
  for (; capsules != 0; capsules &= capsules - 1) {
    const auto proxy = static_cast<uint32_t>(std::countr_zero(capsules));
    work(proxy, capsule_of(instance, proxy));
  }
}

}  // namespace

uint64_t touchable_by(const pack::PackView& pack, const pack::RegionRecord& region) noexcept {
  uint64_t capsules = 0;
  for (size_t i = 0; region.touches_body && i < pack.proxies.size(); ++i)
    if (!passes(pack, region, pack.proxies[i])) capsules |= uint64_t{1} << i;
  return capsules;
}

Status find_touchable(const pack::PackView& pack, std::unique_ptr<uint64_t[]>* out) noexcept {
  const size_t count = pack.regions.size();
  std::unique_ptr<uint64_t[]> made(new (std::nothrow) uint64_t[count]);
  if (!made) return core::make_status(StatusCode::kOutOfCapacity, "load_asset: no memory for its regions");
  for (size_t r = 0; r < count; ++r) made[r] = touchable_by(pack, pack.regions[r]);
  const bool any =
      std::any_of(made.get(), made.get() + count, [](uint64_t capsules) { return capsules != 0; });
  if (any) *out = std::move(made);
  return {};
}

uint64_t touchable(const Instance& instance, uint32_t region) noexcept {
  return instance.contacts.proxy_before ? instance.asset->touchable[region] : 0;
}

uint32_t find_own_body(const Instance& instance, uint64_t capsules, NormalsOf normals,
                       std::span<const ContactProbe> probes, std::span<ContactHit> hits) noexcept {
  uint32_t count = 0;
  for_each_capsule(instance, capsules, [&](uint32_t proxy, const MovingCapsule& capsule) {
    for (uint32_t p = 0; p < probes.size(); ++p) {
      WayOut out;
      if (!touch(capsule, probes[p], normals, &out)) continue;
      if (count < hits.size()) {
        hits[count] = hit_of(capsule, probes[p], out, instance.asset->tick_s);
        hits[count].probe = p;
        hits[count].name = proxy;
      }
      ++count;
    }
  });
  return count;
}

uint64_t near_own_body(const Instance& instance, uint64_t capsules, const ContactProbe& probe) noexcept {
  uint64_t near = 0;
  for_each_capsule(instance, capsules, [&](uint32_t proxy, const MovingCapsule& capsule) {
    WayOut unused;
    if (touch(capsule, probe, NormalsOf::kFirstTouch, &unused)) near |= uint64_t{1} << proxy;
  });
  return near;
}

}  // namespace sinew::world

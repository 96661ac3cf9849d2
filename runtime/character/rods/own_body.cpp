// own_body.cpp  see own_body.hpp.
#include "character/rods/own_body.hpp"

#include <algorithm>
#include <array>

#include "character/rest/asleep.hpp"
#include "math/rotation.hpp"
#include "math/turn_between.hpp"
#include "rods/contacts/find/sweep.hpp"
#include "rods/vector.hpp"

namespace sinew::world {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using MapPlace = Eigen::Map<Vector3d>;

constexpr float kFriction = 0.3f;
constexpr double kStill = 1e-3;     // of a capsule's radius, in a tick, or all the while that rods sleep
constexpr double kTouching = 1.05;  // of the sum of radii

Vector3d vector(const float (&v)[3]) noexcept { return Eigen::Map<const Eigen::Vector3f>(v).cast<double>(); }

MapPlace end_of(const ContactState& contacts, uint32_t tick, uint32_t proxy, uint32_t end) noexcept {
  return MapPlace(contacts.proxy_ends[tick] + size_t{6} * proxy + size_t{3} * end);
}

Vector3d moved(const Matrix34& m, const Vector3d& p) noexcept {
  const auto matrix =
      Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(&m.m[0][0]).cast<double>();
  return matrix.leftCols<3>() * p + matrix.col(3);
}

Matrix34 inverse_bind(const pack::JointRecord& joint) noexcept {
  Matrix34 m;
  std::copy_n(joint.inverse_bind, 12, &m.m[0][0]);
  return m;
}

rods::Axis axis_of(const float (&from)[3], const float (&to)[3]) noexcept {
  return {rods::vector_of(from), rods::vector_of(to)};
}

bool touch_at_rest(const pack::RodSegmentRecord& segment, const pack::ProxyRecord& proxy) noexcept {
  const rods::Axis a = axis_of(segment.begin_m, segment.end_m), b = axis_of(proxy.from_m, proxy.to_m);
  const rods::Nearest n = rods::nearest(a, b);
  const rods::Vector apart =
      rods::difference(rods::between(a.from, a.to, n.a), rods::between(b.from, b.to, n.b));
  return rods::length(apart) < kTouching * (double{segment.radius_m} + double{proxy.radius_m});
}

uint64_t touched_at_rest(const pack::PackView& pack, const pack::RodSegmentRecord& segment) noexcept {
  uint64_t touched = 0;
  for (size_t i = 0; i < pack.proxies.size(); ++i)
    if (touch_at_rest(segment, pack.proxies[i])) touched |= uint64_t{1} << i;
  return touched;
}

uint64_t passed_by(const pack::PackView& pack, const pack::RodRecord& rod, uint32_t own) noexcept {
  uint64_t passed = ~uint64_t{0};
  while (own != pack::kNoIndex && passed != 0) {
    const pack::RodSegmentRecord& segment = pack.rod_segments[rod.first_segment + own];
    passed &= touched_at_rest(pack, segment);
    own = segment.parent;
  }
  return passed | rod.passed_proxies;
}

rods::Capsule capsule_of(const Instance& instance, uint32_t proxy) noexcept {
  const Vector3d from = end_of(instance.contacts, 0, proxy, 0), to = end_of(instance.contacts, 0, proxy, 1);
  const Vector3d was_from = end_of(instance.contacts, 1, proxy, 0),
                 was_to = end_of(instance.contacts, 1, proxy, 1);
  rods::Capsule capsule;
  std::copy_n(from.data(), 3, capsule.ends_m[0]);
  std::copy_n(to.data(), 3, capsule.ends_m[1]);
  capsule.radius_m = instance.level->pack.proxies[proxy].radius_m;
  capsule.friction = kFriction;
  const double tick_s = instance.asset->tick_s;
  const Vector3d linear = (from + to - was_from - was_to) / (2 * tick_s);
  Eigen::Map<Eigen::Vector3f>(capsule.motion.linear_m_s) = linear.cast<float>();
  if (!((to - from).norm() > 0) || !((was_to - was_from).norm() > 0)) return capsule;
  const Eigen::AngleAxisd turn(core::turn_between(was_to - was_from, to - from));
  const Vector3d spin = turn.angle() / tick_s * turn.axis();
  Eigen::Map<Eigen::Vector3f>(capsule.motion.angular_rad_s) = spin.cast<float>();
  return capsule;
}

}  // namespace

uint32_t proxy_count(const Instance& instance) noexcept {
  return instance.contacts.proxy_ends[0] ? static_cast<uint32_t>(instance.level->pack.proxies.size()) : 0;
}

void pass_proxies(const Instance& instance, uint32_t batch, rods::RodCollider& collider) noexcept {
  const pack::PackView& pack = instance.level->pack;
  for (uint32_t rod = 0; rod < instance.asset->rods.rod_count; ++rod) {
    const RodSeat& seat = instance.asset->rods.seats()[rod];
    if (seat.batch != batch) continue;
    for (uint32_t k = 1; k <= seat.segment_count(); ++k) {
      (void)collider.set_passed(seat.strand, k, passed_by(pack, pack.rods[rod], k - 1));  // it is there
    }
  }
}

void pose_proxies(Instance& instance, const Matrix34* joints, const RootTransform& root) noexcept {
  const uint32_t count = proxy_count(instance);
  if (count == 0) return;
  if (instance.contacts.proxy_before)
    std::copy_n(instance.contacts.proxy_ends[0], size_t{6} * count, instance.contacts.proxy_before);
  if (rods_asleep(instance) == 0)
    std::copy_n(instance.contacts.proxy_ends[0], size_t{6} * count, instance.contacts.proxy_ends[1]);
  const Quaterniond turn = quaternion(root.rotation_xyzw);
  const Vector3d place_m =
      Eigen::Map<const Vector3d>(root.position_m) - Eigen::Map<const Vector3d>(instance.state->rods.anchor_m);
  for (uint32_t i = 0; i < count; ++i) {
    const pack::ProxyRecord& proxy = instance.level->pack.proxies[i];
    const Matrix34 bind = inverse_bind(instance.level->pack.joints[proxy.joint]);
    for (uint32_t end = 0; end < 2; ++end) {
      const Vector3d rest = vector(end == 0 ? proxy.from_m : proxy.to_m);
      end_of(instance.contacts, 0, i, end) = place_m + turn * moved(joints[proxy.joint], moved(bind, rest));
    }
  }
}

void turn_proxies(Instance& instance, const Quaterniond& turn, const Vector3d& centre_m) noexcept {
  for (double* ends : {instance.contacts.proxy_ends[0], instance.contacts.proxy_ends[1]}) {
    for (uint32_t end = 0; end < 2 * proxy_count(instance); ++end) {
      MapPlace place(ends + size_t{3} * end);
      place = (centre_m + turn * (place - centre_m)).eval();
    }
  }
}

void move_last_proxies(Instance& instance, const Vector3d& by_m) noexcept {
  for (uint32_t end = 0; end < 2 * proxy_count(instance); ++end)
    MapPlace(instance.contacts.proxy_ends[1] + size_t{3} * end) += by_m;
}

void set_proxies(Instance& instance, rods::RodCollider& collider) noexcept {
  std::array<rods::Capsule, pack::kMostProxies> capsules;
  const uint32_t count = proxy_count(instance);
  for (uint32_t i = 0; i < count; ++i) capsules[i] = capsule_of(instance, i);
  // A pose that flung a bone out of all bounds is refused: the last capsules stay.
  (void)collider.set_capsules({capsules.data(), count});
}

bool proxies_move(const Instance& instance) noexcept {
  for (uint32_t i = 0; i < proxy_count(instance); ++i) {
    const double still = kStill * double{instance.level->pack.proxies[i].radius_m};
    for (uint32_t end = 0; end < 2; ++end)
      if (!((end_of(instance.contacts, 0, i, end) - end_of(instance.contacts, 1, i, end)).norm() <= still))
        return true;
  }
  return false;
}

}  // namespace sinew::world

// probe_on_surface.hpp  Where a probe touches one surface in a tick.
//
// One walk through the tree looks at every triangle that the probe may come to. Looked at are both ends and
// the middle of its axis, where the tick begins, and the ends' and the whole axis' first touch on the way. If
// none of the three is inside, the contacts are the axis' touch and those of the ends that touch as well; if
// one is, the contacts are the shortest ways out of those that are inside, and the touches of the ends that
// are not.
#pragma once
#include "embree/side.hpp"
#include "rods/sweep.hpp"

namespace sinew::embree {

class ProbeOnSurface {
 public:
  static constexpr uint32_t kMostContacts = 3;

  // dt_s is the tick, the probe is checked.
  ProbeOnSurface(const Surface& surface, const ContactProbe& probe, const SurfaceFilter& filter,
                 bool grows_here, double reach_m, double dt_s) noexcept;

  // All but probe, name's upper part and body's; the triangle's index is in body.
  uint32_t find(ContactHit (&hits)[kMostContacts]) noexcept;

 private:
  static constexpr uint32_t kNone = ~0u;
  enum Where : uint32_t { kFrom, kTo, kMiddle, kSamples };  // of the axis; a contact's name as well

  struct Nearby {
    double distance_m;
    uint32_t triangle = kNone;
    OnTriangle on = {};
    bool inside = false;
  };
  struct Touched {
    TriangleTouch touch = {};
    uint32_t triangle = kNone;
  };
  static double along(uint32_t where) { return where == kFrom ? 0 : where == kTo ? 1 : 0.5; }
  Vector sample(uint32_t where) const;
  Sweep sweep_of_end(uint32_t where) const;
  double look(uint32_t triangle) noexcept;
  void look_at_sample(uint32_t where, uint32_t triangle, const Triangle& start) noexcept;
  void look_at_ways(uint32_t triangle, const MovingTriangle& moving, double distance_m) noexcept;
  double radius_left() const noexcept;
  void tell_sides() noexcept;
  bool grows_from(uint32_t triangle, const OnTriangle& on) const noexcept;
  bool near(const Touched& touched) const noexcept;
  void add(const Touched& touched, uint32_t name) noexcept;
  void add_way_out(uint32_t where) noexcept;
  void add_outside() noexcept;
  void put(uint32_t triangle, const std::array<double, 3>& weights, double along, const Vector& normal,
           double gap_m, uint32_t name) noexcept;
  Vector relative_way(uint32_t triangle, const std::array<double, 3>& weights, double along) const noexcept;

  const Surface& surface_;
  const SurfaceFilter& filter_;
  bool grows_here_;
  double reach_m_, share_, half_m_, way_m_;
  Sweep sweep_;
  bool round_;  // a ball: only its beginning counts
  Nearby samples_[kSamples];
  Touched ends_[2], axis_;
  ContactHit* hits_ = nullptr;
  uint32_t count_ = 0;
};

}  // namespace sinew::embree

// probe_on_surface.hpp  Where a probe touches one surface in a tick.
//
// A first walk through the tree finds what is nearest to the middle of the axis; where that is too far off to
// be touched, and the middle is not inside, that is all. Others find what is nearest to both ends, where the
// tick begins, and the ends' and the whole axis' first touch on the way. If none of the three is inside, the
// contacts are the touches of the ends, that of the axis and that of its middle, each of the latter where it
// is deeper than those beside it keep the axis; and in a valley, for which each contact walks once more along
// its way, the other side of it (adapters/embree/fold.hpp). If one is inside, they are the shortest ways out
// of those that are, and the touches of the ends that are not.
#pragma once
#include "adapters/embree/fold.hpp"
#include "adapters/embree/side.hpp"
#include "adapters/embree/surface.hpp"
#include "rods/contacts/find/sweep.hpp"

namespace sinew::embree {

// That a triangle lies in: nothing of it is nearer.
struct Ball {
  Vector middle;
  double radius_m;
  double gap_m(const Vector& point) const;
};

class ProbeOnSurface {
 public:
  static constexpr uint32_t kMostContacts = 8;

  // dt_s is the tick, the probe is checked.
  // What is known beforehand saves time. guess: a triangle that may be nearest, or none that is there.
  // from_outside: the axis begins outside, where the tick does. roots: a bit for each of the filter's on it.
  ProbeOnSurface(const Surface& surface, const ContactProbe& probe, const SurfaceFilter& filter,
                 uint32_t roots, double reach_m, double dt_s, uint32_t guess, bool from_outside) noexcept;

  // All but probe, name's upper part and body's; the triangle's index is in body.
  uint32_t find(ContactHit (&hits)[kMostContacts]) noexcept;
  // About, to the axis, where something was looked for and found.
  uint32_t nearest() const noexcept { return glance_.triangle == kNone ? axis_.triangle : glance_.triangle; }

  // All of the axis is outside a closed surface where the tick begins, for sure.
  bool is_outside() const noexcept { return outside_; }

  static constexpr uint32_t kNone = ~0u;

 private:
  // Of the axis. A contact's name as well: the axis' touch is kMiddle's, its middle's beside that kSamples'.
  enum Where : uint32_t { kFrom, kTo, kMiddle, kSamples };
  static constexpr uint32_t kFolds = 4;  // what a fold adds to a contact's name

  struct Nearby {
    double distance_m;
    uint32_t triangle = kNone;
    OnTriangle on;
    bool inside = false;
  };
  struct Touched {
    TriangleTouch touch;
    uint32_t triangle = kNone;
  };
  // A touch as it is where the tick begins.
  struct AtStart {
    double along;
    Vector normal;
    double gap_m;
  };
  // Contacts that are asked whether they say what another would; by default all of them.
  struct Facing {
    Vector normal = {};
    double least_cosine = -1;
    bool is_that_of(const ContactHit& hit) const noexcept;
  };
  static double along(uint32_t where) { return where == kFrom ? 0 : where == kTo ? 1 : 0.5; }
  Vector sample(uint32_t where) const;
  Sweep sweep_of_end(uint32_t where) const;
  bool is_near_or_inside() noexcept;
  bool look_about() noexcept;
  void add_ways_out_and_ends() noexcept;
  void find_nearest(uint32_t where) noexcept;
  void look_at_sample(uint32_t where, uint32_t triangle) noexcept;
  double near_m(double speed_m) const noexcept;
  void find_touches() noexcept;
  void look_at_nearest_first(std::span<const uint32_t> triangles) noexcept;
  void look_at_ways(uint32_t triangle, double axis_m) noexcept;
  bool is_beaten(const Touched& best, const Sweep& sweep, const MovingTriangle& m) const noexcept;
  void take_first(const Touched& touched, Touched* best) const noexcept;
  double farthest_touch() const noexcept;
  bool is_inside(uint32_t where) const noexcept;
  bool crosses() const noexcept;
  void tell_side(uint32_t where) noexcept;
  void tell_sides_of_ends() noexcept;
  bool grows_from(uint32_t triangle, const OnTriangle& on) const noexcept;
  bool near(uint32_t triangle, const OnTriangle& on, double along, double gap_m) const noexcept;
  bool near(const Touched& touched) const noexcept;
  AtStart at_start(const Touched& touched, uint32_t name) const noexcept;
  void add(const Touched& touched, const AtStart& start, uint32_t name) noexcept;
  Facing facing_of(const Touched& touched, const AtStart& start) const noexcept;
  bool is_told_beside(double along, double gap_m, const Facing& facing) const noexcept;
  bool is_told_between(double along, double gap_m, const Facing& facing) const noexcept;
  void add_axis() noexcept;
  void add_middle() noexcept;
  HeldPoint held_by(const ContactHit& hit) const noexcept;
  void add_fold(const ContactHit& first) noexcept;
  void add_folds() noexcept;
  void add_way_out(uint32_t where) noexcept;
  void add_outside() noexcept;
  void put(uint32_t triangle, const std::array<double, 3>& weights, double along, const Vector& normal,
           double gap_m, uint32_t name) noexcept;
  Vector relative_way(uint32_t triangle, const std::array<double, 3>& weights, double along) const noexcept;

  const Surface& surface_;
  const SurfaceFilter& filter_;
  uint32_t roots_;
  uint32_t guess_;
  double reach_m_, share_, half_m_;
  double speed_m_;  // no point of the probe and the surface near each other faster in the tick
  Sweep sweep_;
  bool round_;  // a ball: only its middle counts
  bool from_outside_, closed_, outside_ = false;
  Surface::Glance glance_;    // of the middle
  Nearby samples_[kSamples];  // of what was looked at more closely
  Touched ends_[2], axis_;
  ContactHit* hits_ = nullptr;
  uint32_t count_ = 0;
};

}  // namespace sinew::embree

// probe_contacts.hpp  All contacts of one probe, gathered body by body.
#pragma once
#include "adapters/bullet/near_bodies.hpp"

class btCollisionShape;
class btCompoundShape;
class btConcaveShape;

namespace sinew::bullet {

class ProbeContacts {
 public:
  ProbeContacts(const Path& path, double dt_s, Problems& problems) noexcept
      : path_(path), dt_s_(dt_s), problems_(problems) {}

  // Body and probe near each other in the tick by no more than `closing_m`.
  void add(const Body& body, double closing_m) noexcept;
  // Leaves out what others say as well: on a mesh, of a face's contacts all but its outermost, and edges that
  // a face next to them covers.
  void reduce() noexcept;
  uint32_t size() const noexcept { return count_; }
  // With gap, normal, velocity and all that is the body's; `probe` is left to the caller.
  const ContactHit& operator[](uint32_t i) const noexcept { return found_[i].hit; }
  // Also where there is no handle.
  uint32_t body(uint32_t i) const noexcept { return found_[i].body; }
  static constexpr uint32_t kMost = 48;

 private:
  friend struct TriangleCollector;

  struct Found {
    ContactHit hit;
    Vector surface;  // at the moment it was found at
    Vector normal;
    double share;
    uint32_t body;
    bool mesh, face;
  };
  // Where a shape hangs on its body, and its number there.
  struct Part {
    Place place;
    uint32_t number;
  };

  struct Feature {
    uint32_t number;
    bool mesh, face;
  };

  double reach_m() const noexcept;
  double end_reach_m() const noexcept;
  Box own_box(const Body& body, const Place& part) const noexcept;
  void add_shape(const Body& body, const Part& part, const btCollisionShape& shape) noexcept;
  void add_children(const Body& body, const Part& part, const btCompoundShape& shape) noexcept;
  void add_convex(const Body& body, const Part& part, const Convex& shape) noexcept;
  void add_concave(const Body& body, const Part& part, const btConcaveShape& shape) noexcept;
  // `up`: of what is solid below it; zero: a sheet.
  void add_triangle(const Body& body, const Part& part, const Triangle& triangle, const Vector& up,
                    uint32_t number) noexcept;
  Found* free_slot(double gap_m) noexcept;
  // `at_end_m`: how far that point of the axis would be from the surface at the tick's end.
  void add_contact(const Body& body, const Part& part, double time, const Near& near, double at_end_m,
                   const Feature& feature) noexcept;
  double length_m() const noexcept;
  bool coplanar(const Found& a, const Found& b) const noexcept;
  bool said_by_others(uint32_t i) const noexcept;

  const Path& path_;
  double dt_s_, closing_m_ = 0;  // of the body that is added
  Problems& problems_;
  uint32_t count_ = 0;
  Found found_[kMost];
};

}  // namespace sinew::bullet

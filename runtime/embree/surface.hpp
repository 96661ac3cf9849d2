// surface.hpp  One deforming triangle mesh: where it is, where it goes in a tick, and the tree over that.
#pragma once
#include <embree3/rtcore.h>

#include <memory>

#include "embree/topology.hpp"
#include "embree/triangle.hpp"
#include "sinew/surface_contacts.hpp"

namespace sinew::embree {

class Surface {
 public:
  // Checked; rest places are where it begins.
  static Status create(RTCDevice device, const SurfaceDef& def, std::unique_ptr<Surface>* out);
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // Refused: numbers as SurfacePose says; nothing is changed then but a count.
  Status move(const SurfacePose& pose) noexcept;
  SurfaceReport report() const noexcept;

  const Topology& topology() const noexcept { return topology_; }
  const double (&origin_m() const noexcept)[3] { return origin_m_; }
  double motion_s() const noexcept { return motion_s_; }  // that moves span; 0: it stands
  double longest_move_m() const noexcept { return longest_move_m_; }
  float friction() const noexcept { return friction_; }
  float restitution() const noexcept { return restitution_; }
  bool two_sided() const noexcept { return two_sided_; }
  uint32_t groups(uint32_t triangle) const noexcept { return groups_.empty() ? ~0u : groups_[triangle]; }

  // From origin_m, at the tick's start.
  Vector start(uint32_t vertex) const noexcept { return vector(starts_, vertex); }
  Triangle start_triangle(uint32_t triangle) const noexcept;
  // With moves of a share of motion_s.
  MovingTriangle moving_triangle(uint32_t triangle, double share) const noexcept;
  Triangle rest_triangle(uint32_t triangle) const noexcept;

  // All triangles whose way crosses a ball about a point, from origin_m; visit(triangle) may return a smaller
  // radius.
  template <class Visit>
  void visit_ball(const Vector& middle_m, double radius_m, Visit visit) const noexcept {
    if (!may_reach(middle_m, radius_m)) return;
    alignas(16) RTCPointQuery query = {static_cast<float>(middle_m[0]), static_cast<float>(middle_m[1]),
                                       static_cast<float>(middle_m[2]), 0, rounded_up(radius_m)};
    alignas(16) RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &query, &context, &visit_triangle<Visit>, &visit);
  }

 private:
  Surface() = default;
  static Vector vector(const std::vector<float>& of, uint32_t vertex) noexcept {
    return {of[3 * size_t{vertex}], of[3 * size_t{vertex} + 1], of[3 * size_t{vertex} + 2]};
  }
  // Embree's places are floats: a little more is looked at.
  static float rounded_up(double radius_m) noexcept {
    return static_cast<float>(radius_m * (1 + 1e-6) + 1e-6);
  }
  template <class Visit>
  static bool visit_triangle(RTCPointQueryFunctionArguments* args) {
    const double radius = (*static_cast<Visit*>(args->userPtr))(args->primID);
    const float rounded = rounded_up(radius);
    if (!(rounded < args->query->radius)) return false;
    args->query->radius = rounded;
    return true;
  }
  static void bound(const RTCBoundsFunctionArguments* args);
  bool may_reach(const Vector& middle_m, double radius_m) const noexcept;
  void place(const SurfacePose& pose) noexcept;
  bool build(RTCDevice device) noexcept;
  void commit() noexcept;

  Topology topology_;
  std::vector<uint32_t> groups_;
  std::vector<float> rest_m_, starts_, moves_, last_;  // [vertices][3]; last_: where the last pose put it
  double origin_m_[3] = {0, 0, 0};
  double motion_s_ = 0, longest_move_m_ = 0;
  float friction_ = 0, restitution_ = 0;
  bool two_sided_ = false;
  uint32_t poses_refused_ = 0;
  float low_m_[3] = {0, 0, 0}, high_m_[3] = {0, 0, 0};  // of all its way
  RTCScene scene_ = nullptr;
  RTCGeometry geometry_ = nullptr;
};

}  // namespace sinew::embree

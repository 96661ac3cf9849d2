// surface.hpp  One deforming triangle mesh: where it is, where it goes in a tick, and the tree over that.
#pragma once
#include <cmath>
#include <memory>

#include "adapters/embree/topology.hpp"
#include "adapters/embree/tree.hpp"
#include "adapters/embree/triangle.hpp"
#include "rods/vector.hpp"
#include "sinew/surface_contacts.hpp"

namespace sinew::embree {

class Surface {
 public:
  // Checked; rest places are where it begins. Throws std::bad_alloc; *out is then untouched.
  static Status create(const SurfaceDef& def, std::unique_ptr<Surface>* out);
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  // Refused: numbers as SurfacePose says; nothing is changed then but a count.
  Status move(const SurfacePose& pose) noexcept;
  SurfaceReport report() const noexcept;

  const Topology& topology() const noexcept { return topology_; }
  const double (&origin_m() const noexcept)[3] { return origin_m_; }
  double motion_s() const noexcept { return motion_s_; }  // that moves span; 0: it stands
  // Whether one cannot get to another side without going through triangles of the groups.
  bool is_closed(uint32_t groups) const noexcept {
    return topology_.border_edges == 0 && !some_ungrouped_ && (every_group_ & ~groups) == 0;
  }
  float friction() const noexcept { return friction_; }
  float restitution() const noexcept { return restitution_; }
  bool two_sided() const noexcept { return two_sided_; }
  uint32_t groups(uint32_t triangle) const noexcept { return groups_.empty() ? ~0u : groups_[triangle]; }

  // From origin_m, at the tick's start.
  Vector start(uint32_t vertex) const noexcept { return vector(starts_, vertex); }
  Triangle start_triangle(uint32_t triangle) const noexcept {
    const Corners& t = topology_.triangles[triangle];
    return {{start(t[0]), start(t[1]), start(t[2])}};
  }
  // With moves of a share of motion_s.
  MovingTriangle moving_triangle(uint32_t triangle, double share) const noexcept {
    MovingTriangle out = {start_triangle(triangle), {}};
    for (size_t k = 0; k < 3; ++k) {
      out.moves[k] = rods::scaled(share, vector(moves_, topology_.triangles[triangle][k]));
    }
    return out;
  }
  Triangle rest_triangle(uint32_t triangle) const noexcept;

  // Of vertices, less what all of the surface goes, of motion_s.
  double longest_own_move_m() const noexcept { return longest_own_move_m_; }
  // That, with a share of motion_s: what the tree's boxes do not count.
  Vector drift(double share) const noexcept {
    return {share * drift_[0], share * drift_[1], share * drift_[2]};
  }

  // Whether any triangle's way may come so near to a point, from origin_m, that goes with the surface.
  bool may_reach(const Vector& middle_m, double radius_m) const noexcept;
  // What is nearest to a point where the tick begins, as far as can be told quickly.
  struct Glance {
    uint32_t triangle = kBorder;  // about the nearest; kBorder: there is none within that distance
    double at_least_m = 0;        // to the nearest
    bool outside = false;         // beyond doubt, or there is none; what lies on borders may be not told
  };
  // guess: a triangle that may be near, or any other number.
  Glance glance(const Vector& point_m, uint32_t groups, double within_m, uint32_t guess) const noexcept;
  // visit(triangle): all that may be nearer to a point than `nearer`, where the tick begins; it makes that
  // less as it finds nearer ones.
  template <class Visit>
  void visit_nearest(const Vector& point_m, uint32_t groups, uint32_t guess, const double* nearer,
                     Visit visit) const noexcept {
    simd::SurfacePoint of = as_point(point_m);
    simd::SurfaceWalk walk;
    for (walk.begin(groups, leaf_near(guess)); !walk.done();) {
      of.within_m = static_cast<float>(*nearer * (1 + 1e-6)) + of.rounding_m;
      walks_->nearest(tree_.view(), &of, &walk);
      for (uint32_t i = 0; i < walk.found_count; ++i) {
        if (static_cast<double>(walk.at_least_m[i] - 2 * of.rounding_m) <= *nearer) visit(walk.found[i]);
      }
    }
  }
  // visit(triangles): all that may come within so much of a sweep's axis in a share of motion_s, some at a
  // time.
  template <class Visit>
  void visit_near(const Sweep& sweep, double share, double within_m, uint32_t groups,
                  Visit visit) const noexcept {
    const simd::SurfaceSweep of = without_drift(sweep, share, within_m);
    simd::SurfaceWalk walk;
    for (walk.begin(groups); !walk.done();) {
      walks_->near_sweep(tree_.view(), of, &walk);
      visit(std::span<const uint32_t>(walk.found, walk.found_count));
    }
  }

 private:
  Surface() = default;
  static Vector vector(const std::vector<float>& of, uint32_t vertex) noexcept {
    return {of[3 * size_t{vertex}], of[3 * size_t{vertex} + 1], of[3 * size_t{vertex} + 2]};
  }
  uint32_t leaf_near(uint32_t guess) const noexcept {
    return guess < topology_.triangles.size() ? tree_.leaf_of(guess) : simd::SurfaceWalk::kNoLeaf;
  }
  simd::SurfacePoint as_point(const Vector& m) const noexcept {
    return {{static_cast<float>(m[0]), static_cast<float>(m[1]), static_cast<float>(m[2])}, rounding_m(m), 0};
  }
  simd::SurfaceSweep without_drift(const Sweep& sweep, double share, double within_m) const noexcept;
  // What float does to a place and to differences of places, at most.
  float rounding_m(const Vector& at_m) const noexcept {
    return 2e-6f *
           (farthest_m_ + static_cast<float>(std::fabs(at_m[0]) + std::fabs(at_m[1]) + std::fabs(at_m[2])));
  }
  void place(const SurfacePose& pose) noexcept;
  void measure_moves() noexcept;
  void refit() noexcept;

  Topology topology_;
  std::vector<uint32_t> groups_;
  std::vector<float> rest_m_, starts_, moves_, last_;  // [vertices][3]; last_: where the last pose put it
  double origin_m_[3] = {0, 0, 0};
  double motion_s_ = 0, longest_own_move_m_ = 0;
  float drift_[3] = {0, 0, 0}, farthest_m_ = 0;  // of any place from origin_m, at most
  float friction_ = 0, restitution_ = 0;
  bool two_sided_ = false;
  uint32_t every_group_ = ~0u;   // of any triangle
  bool some_ungrouped_ = false;  // triangles that no filter asks for
  uint32_t poses_refused_ = 0;
  bool changed_ = true;  // by the last pose
  Tree tree_;
  const simd::SurfaceWalks* walks_ = nullptr;
};

}  // namespace sinew::embree

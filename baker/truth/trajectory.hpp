// trajectory.hpp  A simulated motion as the file the trainer and the demo read.
//
// T ticks after the start, N nodes, V vertices, J joints; region-frame axes (tissue/drive.hpp), metres:
//   drive (T+1,N,21) f32   displacement (T+1,N,3) f32   joints (T+1,J,12) f32 character-from-joint
//   root (T+1,7) f64 place and quaternion xyzw   energy (T+1,2) f64 elastic and kinetic, joules
//   node.rest_position (N,3) less the region's centre, in radii   node.rest_normal (N,3)   node.stiffness
//   (N,1)   node.region (N) i32 edges (m,2) i32   region.radius_m (R) with `surface`: surface (T+1,Vr,3) f16
//   true displacement of the carried vertices, region after region;
//     region.vertices (Vr) i32, region.vertex_count (R) i32, carry.{r} (nodes, vertices of region r)
//   with `positions`: positions (T+1,V,3) f32 truth relative to the root
// Metadata: sinew.trajectory = 1 and the caller's.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "baker/common/safetensors.hpp"
#include "baker/truth/tissue_truth.hpp"
#include "tissue/drive.hpp"

namespace sinew::baker {

struct TrajectoryOptions {
  double rate_hz = 60;
  bool surface = false, positions = false;
};

// Takes the start, then one tick after the other. Drives come from runtime/tissue, so that network and
// runtime cannot disagree.
class TrajectoryRecorder {
 public:
  TrajectoryRecorder(const Character& character, const TissueLayout& layout,
                     const TrajectoryOptions& options);

  void add(const TruthFrame& frame);
  Safetensors finish(std::map<std::string, std::string> metadata) const;

 private:
  void add_region(size_t region, const TruthFrame& frame);
  void add_surface(const Eigen::Matrix3d& region_from_world, const Region& region, const TruthFrame& frame);
  void add_pose(const TruthFrame& frame);
  void add_statics(Safetensors* file) const;
  tissue::RegionFrame frame_of(const Region& region, const WorldPose& pose) const;

  const Character& character_;
  const TissueLayout& layout_;
  TrajectoryOptions options_;
  std::vector<tissue::RegionMotion> motions_;
  std::vector<std::vector<float>> places_;  // region-frame places of all nodes, newest tick first
  std::vector<float> drive_, displacement_, joints_, positions_;
  std::vector<Eigen::half> surface_;
  std::vector<double> root_, energy_;
  size_t ticks_ = 0;
};

}  // namespace sinew::baker

// trajectory.hpp  A simulated motion as the file the trainer and the demo read.
//
// T ticks after the start, N nodes, R regions, V vertices, J joints; metres:
//   drive (T+1,N,15) f32 of tissue/frames/node_drive.hpp   rotation (T+1,N,9) f32 node frames, world from
//   bind axes displacement (T+1,N,3) f32 along the node's own frame (tissue/frames/node_bend.hpp) joints
//   (T+1,J,12) f32 character-from-joint   root (T+1,7) f64 place and quaternion xyzw energy (T+1,2) f64
//   elastic and kinetic, joules node.rest_position (N,3) less the region's centre, in radii node.rest_normal
//   (N,3)   node.stiffness (N,1)   node.region (N) i32   edges (m,2) i32   region.radius_m (R)
//   modes.{r}.rad_per_s, .damping_ratio (1,K)   .shape, .turn (3n,K)   .force (K,3n)   .rest (3n,3n)
//   .rest_oscillator, .first (1,2) rad/s and damping ratio, of modal_basis.hpp
// with `surface`: surface (T+1,Vr,3) f16 true displacement of the carried vertices, each along the axes of
//   its own skin, region after region; region.vertices (Vr) i32, region.vertex_count (R) i32,
//   carry.{r} (nodes, vertices of region r)
// with `positions`: positions (T+1,V,3) f32 truth relative to the root
// Metadata: sinew.trajectory = 5 and the caller's.
#pragma once
#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/truth/tissue_truth.hpp"
#include "tissue/frames/node_drive.hpp"

namespace sinew::baker {

inline constexpr char kTrajectoryVersion[] = "5";

struct TrajectoryOptions {
  double rate_hz = 60;
  bool surface = false, positions = false;
};

// Takes the start, then one tick after the other; one basis a region, else BadInput. Frames and drives come
// from runtime/tissue, so that network and runtime cannot disagree.
class TrajectoryRecorder {
 public:
  TrajectoryRecorder(const Character& character, const TissueLayout& layout, const TrajectoryOptions& options,
                     std::vector<ModalBasis> modes);

  void add(const TruthFrame& frame);
  Safetensors finish(std::map<std::string, std::string> metadata) const;

 private:
  void add_nodes(const TruthFrame& frame);
  void add_surface(const TruthFrame& frame);
  void add_pose(const TruthFrame& frame);
  void add_statics(Safetensors* file) const;
  void add_carry(Safetensors* file) const;
  void add_modes(Safetensors* file) const;
  std::vector<tissue::NodePose> poses_of(const std::vector<pack::NodeRecord>& points,
                                         const WorldPose& pose) const;

  const Character& character_;
  const TissueLayout& layout_;
  TrajectoryOptions options_;
  std::vector<ModalBasis> modes_;
  std::vector<pack::NodeRecord> nodes_, carried_;  // carried_: a vertex of each region, as if it were a node
  std::vector<std::vector<tissue::NodePose>> poses_;  // of the last three ticks, newest first
  std::vector<Vector3> roots_;                        // likewise
  std::vector<float> drive_, rotation_, displacement_, joints_, positions_;
  std::vector<Eigen::half> surface_;
  std::vector<double> root_, energy_;
  float most_m_s2_;  // NodeMotion, as the runtime has it
  size_t ticks_ = 0;
};

}  // namespace sinew::baker

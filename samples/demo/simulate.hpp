// simulate.hpp  The character loop: poses in, one step, surfaces out, every frame timed. No picture is made
// here.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "samples/demo/character_file.hpp"
#include "samples/demo/motion.hpp"
#include "samples/demo/options.hpp"
#include "samples/demo/part_motion.hpp"
#include "samples/demo/trajectory.hpp"
#include "sinew/sinew.hpp"

namespace sinew::demo {

// Mean over the vertices that tissue moves.
struct Error {
  float skinning_mm = 0, sinew_mm = 0;
};

struct FrameRecord {
  double time_s = 0;
  FrameReport step{};
  float poses_us = 0, read_us = 0;  // the engine's side: set_pose and read_positions of all instances
  InstanceReport first{};           // the instance that is filmed and measured
  Error error{};                    // of the first instance, with a truth
};

// The first instance at one frame, in character space.
struct Snapshot {
  double time_s = 0;
  std::string motion{};
  RootTransform root{};
  Error error{};
  std::vector<Eigen::Vector3f> skinned{}, sinew{}, truth{};  // truth is empty without one
};

struct CrowdMember {
  Tier tier = Tier::kSkinning;
  bool hidden = false;                       // the camera does not show it
  std::vector<Eigen::Vector3f> positions{};  // world
};

struct Run {
  std::string name{};  // of the pack's file
  AssetInfo asset{};
  int instances = 0;
  bool contacts = false;  // with its own body
  double fps = 60;
  std::vector<FrameRecord> frames{};
  std::vector<Snapshot> snapshots{};  // empty unless pictures were asked for
  std::vector<PartMotion> parts{};    // of the first instance
  std::vector<CrowdMember> crowd{};   // all instances (at most 100) after the last frame, with pictures
  std::array<uint64_t, kTierReasonCount> reasons{};                  // all instances, all frames
  uint64_t input_clamps = 0, displacement_clamps = 0, restarts = 0;  // all instances, all frames
};

// Throws baker::BadInput with what the world refused. truth may be null.
Run simulate(const CharacterFile& character, const Motion& motion, const Trajectory* truth,
             const Options& options);

}  // namespace sinew::demo

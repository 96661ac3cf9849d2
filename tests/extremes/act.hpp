// act.hpp  One character in a world of its own, and the next frame as a scene makes it.
#pragma once
#include <cstddef>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "sinew/sinew.hpp"
#include "tests/scenes/half_spaces.hpp"

namespace sinew::extremes {

// Draws that are the same on every machine.
class Draws {
 public:
  explicit Draws(uint64_t seed) : random_(seed) {}
  double between(double from, double to);         // even
  double of_any_size(double least, double most);  // even in its logarithm
  bool chance(double share) { return between(0, 1) < share; }
  uint32_t below(uint32_t count);
  void direction(double (&out)[3]);

 private:
  std::mt19937_64 random_;
};

// Valid hits, and, where it may, hits that are none: of any depth, direction and speed, others at each
// question.
class AnyHits : public ContactSource {
 public:
  double depth_m = 0, speed_m_s = 0, share = 0, bad_share = 0;
  uint64_t seed = 1;
  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override;
};

// A character's pack, loaded into worlds that differ in what they take for a teleport.
class Subject {
 public:
  Subject(std::string name, std::span<const std::byte> pack);  // a pack that is no good: std::runtime_error
  explicit Subject(const std::string& path);                   // a .sinew file

  std::string name;
  World worlds[3];  // teleports as by default; none; as by default, for twins
  AssetId assets[3];
  AssetInfo info;
  std::vector<Matrix34> bind;
  std::vector<RegionInfo> regions;
  std::vector<RodInfo> rods;
  std::vector<uint32_t> parents;
  float extent_m = 0;    // of the bind pose, the largest
  bool one_rest = true;  // false: a limp horn that stands up may come to rest on either side

 private:
  void make_worlds();
  void look();
};

// What a scene makes of each frame. It begins each as the subject's clip, or its bind pose, has it.
struct Act {
  Subject& subject;
  World& world;
  AssetId asset;
  InstanceId instance;
  Draws draws;
  scenes::HalfSpaces walls;
  AnyHits hits;
  uint32_t clip = kNone;

  // Of the coming frame.
  int frame = 0;
  double time_s = 0, dt_s = 1.0 / 60;
  std::vector<Matrix34> joints;
  RootTransform root;
  bool teleport = false, poses = true;

  Act(Subject& of, uint32_t world_index, uint64_t seed);
  ~Act();
  Act(const Act&) = delete;
  Act& operator=(const Act&) = delete;

  void begin_frame();  // the clip's pose at time_s, a root at its origin
  FrameReport step();  // and time_s goes on
  void undo();         // what a scene has set in the world or of the instance
  // The joint and all below it turned, scaled, moved about the joint's place.
  void move_joint(uint32_t joint, const double (&matrix)[3][3], const double (&by_m)[3]);
};

// What is read after a frame, held against the bounds.
struct Reading {
  float displacement = 0;  // of any vertex from its skinned place, bind pose, share of the largest extent
  float outside = 0;       // of World::bounds, of any vertex, share of the ball's radius; with normals alone
  bool finite = true;
};
Reading read(const Act& act, bool normals);
// Bind-space displacements of all moved vertices, and rods' joint places, one after the other: for twins.
std::vector<float> shown(const Act& act);

}  // namespace sinew::extremes

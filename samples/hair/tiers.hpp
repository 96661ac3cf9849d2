// tiers.hpp  Hair of a character whose control graph changes: on its skin where the graph affords it, else on
// capsules.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "baker/common/lone_instance.hpp"
#include "character/describe_instance.hpp"
#include "core/aligned_block.hpp"
#include "samples/hair/character.hpp"
#include "samples/hair/hair.hpp"

namespace sinew::sample {

// What its control graph affords: the finest its skin, a coarser one the capsules about its bones.
enum class Touches { kSkin, kCapsules };

class TieredHair {
 public:
  using Places = std::vector<Eigen::Vector3d>;  // where bones begin and end, one after the other
  struct Mark {
    std::vector<std::byte> state;
    uint32_t tick;
  };

  TieredHair(const HairStyle& style, size_t vertices);
  // One tick of a sixtieth of a second. `measures`: looks for penetration as well, which is not timed.
  void step(Touches touches, bool measures = false);
  Places places() const;

  Mark mark() const;
  void go_back(const Mark& mark);

  double time_s() const { return tick_ * lone_->tick_s(); }
  const Bust& bust() const { return bust_; }
  const Locks& locks() const { return locks_; }
  double height_m() const { return lone_->height_m(); }
  InstanceReport report() const { return world::describe(lone_->instance(), {}); }
  // Since the last call.
  HairMeasure take_measure() { return std::exchange(measure_, {}); }

 private:
  void move_skin(double time_s, float dt_s);
  void look();

  Bust bust_;
  Locks locks_;
  std::vector<LockBone> bones_;
  core::AlignedBlock pack_;
  SurfaceContacts skin_, looked_at_;
  SurfaceId skin_id_, looked_id_;
  std::unique_ptr<baker::LoneInstance> lone_;
  uint32_t tick_ = 0;
  HairMeasure measure_;
};

// Since its measure was taken last: what rods touch, cost, and how deep they are in the skin.
std::string tier_line(TieredHair& hair, const char* name);

// How far the end of a bone goes from one frame to the next in the 44 after a change of tier, beyond what it
// did in that frame and the two before it in either tier all along: what no tier's own motion explains.
struct TierJump {
  double after_m = 0, later_m = 0;  // the latter in the 44 frames behind: what locks do that slip elsewhere
};
struct TierJumps {
  TierJump to_capsules, to_skin;
};
// A change every quarter of a second in either direction, so many ticks.
TierJumps tier_jumps(TieredHair& hair, uint32_t ticks);

}  // namespace sinew::sample

// lone_instance.hpp  One instance of a character outside a world: stepped a tick at a time in the tier that
// it is told, where a world's scheduler would choose.
//
// What measures, draws and tests single tiers is built on it; nothing else steps a world::Instance by hand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "character/instance.hpp"
#include "sinew/types.hpp"

namespace sinew::baker {

class LoneInstance {
 public:
  struct Plan {
    Tier tier = Tier::kSkinning;
    uint32_t level = 0;  // of control graphs; where nothing is simulated it stays as it is
  };

  // `pack` must be a character's, 64-byte aligned, and outlive it. Throws BadInput with the reader's reason.
  explicit LoneInstance(std::span<const std::byte> pack, const ContactDef& contacts = {});
  LoneInstance(const LoneInstance&) = delete;
  LoneInstance& operator=(const LoneInstance&) = delete;

  // The pose at the end of the coming step, to be written; without a change it is the last one.
  std::span<Matrix34> joints();
  RootTransform& root() { return instance_.state->motion.next_root; }

  // A step of `ticks` ticks, 0 or 1, that lasts a tick. A guard may change the tier.
  void step(const Plan& plan, uint32_t ticks = 1);
  // A tick out of sight: what is shown stays as it was.
  void step_hidden();

  std::vector<float> positions(Space space = Space::kCharacter) const;  // [vertices][3], metres
  std::vector<std::byte> save() const;
  // Throws BadInput where the bytes are not what save gave for this character.
  void restore(std::span<const std::byte> state);

  double tick_s() const { return asset_.tick_s; }
  double height_m() const { return static_cast<double>(asset_.pack.character->height_m); }
  const world::Asset& asset() const { return asset_; }
  world::Instance& instance() { return instance_; }
  const world::Instance& instance() const { return instance_; }

  float sleep_tolerance = 0;  // WorldDef::sleep_tolerance; 0: regions never sleep

 private:
  world::Asset asset_;
  world::Instance instance_;
};

}  // namespace sinew::baker

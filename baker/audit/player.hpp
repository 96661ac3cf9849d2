// player.hpp  One character in a world of its own along a motion, as an engine sees it: best tier, no budget.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "baker/audit/audited_pack.hpp"
#include "baker/audit/motions.hpp"
#include "sinew/world.hpp"

namespace sinew::baker {

class Player {
 public:
  // The pack and the motion outlive it. Throws BadInput where the runtime refuses the pack.
  Player(const AuditedPack& pack, const AuditMotion& motion);

  size_t ticks() const { return ticks_; }  // of the motion
  size_t moving_ticks() const { return moving_ticks_; }
  size_t tick() const { return tick_; }
  void advance();  // by one tick

  using Surface = Eigen::Matrix3Xf;                // a column a vertex, character space
  const Surface& shown() const { return shown_; }  // by the last read
  const Surface& skinned() const { return skinned_; }
  void read();  // both
  // How a joint is turned against the pose by the rods: the identity for what is on none.
  Eigen::Matrix3f turn_of(uint32_t joint) const;
  // Of the ends of a rod's segments, the largest distance from the pose.
  Eigen::Matrix3Xf rod_ends(const pack::RodRecord& rod, bool posed) const;
  InstanceReport report() const;

 private:
  void set_pose();

  const AuditedPack pack_;
  const AuditMotion& motion_;
  World world_;
  InstanceId instance_;
  double tick_s_ = 0;
  size_t tick_ = 0, ticks_ = 0, moving_ticks_ = 0;
  std::vector<Matrix34> posed_, displayed_;
  Surface shown_, skinned_;
};

}  // namespace sinew::baker

// replace_asset.cpp  see replace_asset.hpp.
#include "character/life/replace_asset.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "character/motion/pose_bound.hpp"
#include "character/motion/teleport.hpp"
#include "character/output/publish.hpp"
#include "character/rods/rod_blend.hpp"
#include "character/transition/shares.hpp"
#include "core/status.hpp"

namespace sinew::world {
namespace {

bool same_name(const pack::PackView& a, uint32_t name_a, const pack::PackView& b, uint32_t name_b) noexcept {
  return std::strcmp(pack::string_at(a, name_a), pack::string_at(b, name_b)) == 0;
}

// Of records with names, that of the same name; kNoIndex: there is none.
template <class Record>
uint32_t find_namesake(const pack::PackView& in, std::span<const Record> records, const pack::PackView& of,
                       uint32_t name) noexcept {
  for (uint32_t i = 0; i < records.size(); ++i)
    if (same_name(in, records[i].name, of, name)) return i;
  return pack::kNoIndex;
}

void take_state(const Instance& from, Instance& to) noexcept {
  InstanceState& state = *to.state;
  state = *from.state;
  state.remainder_s = std::min(state.remainder_s, to.asset->tick_s);
  state.level = 0;
  state.tier = Tier::kExtrapolate;
  state.left_tier = Tier::kSkinning;
  state.dormant = state.restarting = state.fallback_ticks = state.poses.still_ticks = state.rods.quiet_ticks =
      0;
  state.transition.missed_ticks = state.transition.tail_rides = state.tissue.is_off = 0;
  state.blend_ticks = 0;
  state.transition.tail_ticks = 0;
  state.transition.fade_ticks = kFadeTicks;
  state.transition.seam_ticks = kBlendInTicks;
  state.poses.motion_stale = state.tissue.forgotten = 1;
  for (int k = 0; k < 4; ++k)
    std::copy_n(from.motion.pose_joints[k], to.asset->pack.character->joint_count, to.motion.pose_joints[k]);
  point_to_state(to);
}

uint32_t nearest_node(const pack::PackView& pack, const pack::RegionRecord& region,
                      const float (&place_m)[3]) noexcept {
  uint32_t nearest = region.first_node;
  float nearest2 = std::numeric_limits<float>::infinity();
  for (uint32_t n = region.first_node; n < region.first_node + region.node_count; ++n) {
    float distance2 = 0;
    for (int k = 0; k < 3; ++k) {
      const float apart = pack.nodes[n].position_m[k] - place_m[k];
      distance2 += apart * apart;
    }
    if (distance2 < nearest2) nearest = n, nearest2 = distance2;
  }
  return nearest;
}

void take_region(const Instance& from, uint32_t region, Instance& to,
                 const pack::RegionRecord& record) noexcept {
  const pack::PackView& was = from.level->pack;
  if (was.regions[region].node_count == 0) return;
  for (uint32_t n = record.first_node; n < record.first_node + record.node_count; ++n) {
    const size_t at = nearest_node(was, was.regions[region], to.level->pack.nodes[n].position_m);
    for (int tick = 0; tick < 2; ++tick)
      std::copy_n(from.transition.shown[tick] + 3 * at, 3, to.transition.shown[tick] + size_t{3} * n);
  }
}

void take_flesh(const Instance& from, Instance& to) noexcept {
  const pack::PackView &was = from.level->pack, &now = to.level->pack;
  for (uint32_t r = 0; r < now.regions.size(); ++r) {
    const uint32_t namesake = find_namesake(was, was.regions, now, now.regions[r].name);
    if (namesake == pack::kNoIndex) continue;
    to.parameters.region_tunings[r] = from.parameters.region_tunings[namesake];
    if (shown_share(from) > 0) take_region(from, namesake, to, now.regions[r]);
  }
  const size_t floats = size_t{3} * to.level->node_count();
  for (size_t i = 0; i < floats; ++i) {
    to.transition.tail[i] = to.transition.shown[0][i];
    to.transition.tail_velocity[i] = to.transition.shown[0][i] - to.transition.shown[1][i];
  }
}

// The bone of a joint in a rod; kNoIndex: it is none.
uint32_t slot_of_bone(const RodRig& rig, uint32_t joint) noexcept {
  const std::span<const RodSlot> slots = rig.slots();
  for (uint32_t s = 0; s < slots.size(); ++s)
    if (slots[s].bone == joint) return s;
  return pack::kNoIndex;
}

void take_rods(const Instance& from, Instance& to) noexcept {
  const std::span<const RodSlot> slots = to.asset->rods.slots();
  for (uint32_t s = 0; s < slots.size(); ++s) {
    const uint32_t was =
        slots[s].bone == pack::kNoIndex ? pack::kNoIndex : slot_of_bone(from.asset->rods, slots[s].bone);
    if (was == pack::kNoIndex) continue;
    for (int tick = 0; tick < 2; ++tick)
      std::copy_n(from.rods.shown[tick] + size_t{4} * was, 4, to.rods.shown[tick] + size_t{4} * s);
  }
  const pack::PackView &old = from.asset->pack, &now = to.asset->pack;
  for (uint32_t r = 0; r < now.rods.size(); ++r) {
    const uint32_t namesake = find_namesake(old, old.rods, now, now.rods[r].name);
    if (namesake != pack::kNoIndex) to.parameters.rod_tunings[r] = from.parameters.rod_tunings[namesake];
  }
  begin_rod_tails(to, 1);
}

}  // namespace

Status check_same_skeleton(const Asset& from, const Asset& to) noexcept {
  const std::span<const pack::JointRecord> was = from.pack.joints, now = to.pack.joints;
  if (was.size() != now.size())
    return core::make_status(StatusCode::kInvalidArgument,
                             "replace_asset: %zu joints in the place of %zu; bake the same character again",
                             now.size(), was.size());
  for (size_t j = 0; j < now.size(); ++j)
    if (was[j].parent != now[j].parent || !same_name(from.pack, was[j].name, to.pack, now[j].name))
      return core::make_status(
          StatusCode::kInvalidArgument,
          "replace_asset: joint %zu is '%.60s', it was '%.60s'; bake the same character again", j,
          pack::string_at(to.pack, now[j].name), pack::string_at(from.pack, was[j].name));
  return {};
}

void go_on_as(const Instance& from, Instance& to) noexcept {
  take_state(from, to);
  take_flesh(from, to);
  take_rods(from, to);
  forget_carried(to);
  to.marks.displaced = from.marks.displaced;
  bound_pose(to);
  publish(to);
}

}  // namespace sinew::world

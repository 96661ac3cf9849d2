// lone_instance.cpp  see lone_instance.hpp.
#include "baker/common/lone_instance.hpp"

#include "baker/common/bad_input.hpp"
#include "character/asset/open_asset.hpp"
#include "character/life/create_instance.hpp"
#include "character/life/snapshot.hpp"
#include "character/output/read.hpp"
#include "character/rest/hidden.hpp"
#include "character/tick.hpp"
#include "schedule/front.hpp"
#include "world/step/plan_row.hpp"

namespace sinew::baker {
namespace {

void accept(const Status& status) {
  if (!status.ok()) throw BadInput(status.message);
}

}  // namespace

LoneInstance::LoneInstance(std::span<const std::byte> pack, const ContactDef& contacts) {
  accept(world::open_asset(pack, &asset_));
  InstanceDef def;
  def.contacts = contacts;
  accept(world::make_instance(asset_, def, &instance_));
}

std::span<Matrix34> LoneInstance::joints() {
  return {instance_.motion.next_joints, asset_.pack.character->joint_count};
}

void LoneInstance::step(const Plan& plan, uint32_t ticks) {
  instance_.state->poses.has_next = 1;
  const uint32_t level = frame::is_simulated(plan.tier) ? plan.level : instance_.state->level;
  instance_.plan = {.decision = {.level = level, .tier = plan.tier},
                    .ticks = {.ticks = ticks, .first_tick_s = asset_.tick_s},
                    .dt_s = asset_.tick_s};
  instance_.parameters.sleep_tolerance = sleep_tolerance;
  world::step_instance(instance_, {.clock = {}, .profiler = {}, .frame_s = asset_.tick_s});
}

void LoneInstance::step_hidden() {
  instance_.state->poses.has_next = 1;
  if (instance_.state->hidden == 0) world::hide(instance_);
  world::PlanRow row;
  row.state = instance_.state;
  world::copy_to_row(instance_, &row);
  world::pass_by({.ticks = 1}, row);
  world::keep_hidden_ticks(row);
}

std::vector<float> LoneInstance::positions(Space space) const {
  std::vector<float> out(size_t{3} * asset_.vertex_count());
  world::read_surface(instance_,
                      {.space = space, .capacity = asset_.vertex_count(), .positions = {out.data()}});
  return out;
}

std::vector<std::byte> LoneInstance::save() const {
  std::vector<std::byte> state(world::snapshot_bytes(instance_));
  accept(world::save(instance_, state));
  return state;
}

void LoneInstance::restore(std::span<const std::byte> state) { accept(world::restore(instance_, state)); }

}  // namespace sinew::baker

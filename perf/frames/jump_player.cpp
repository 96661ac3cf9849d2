// jump_player.cpp  see jump_player.hpp.
#include "perf/frames/jump_player.hpp"

#include <algorithm>
#include <stdexcept>

#include "world/hidden.hpp"
#include "world/read.hpp"
#include "world/snapshot.hpp"
#include "world/tick.hpp"

namespace sinew::perf {
namespace {

constexpr double kBehind_s = 0.1;  // that the last tick does not meet the tape's beginning

void must(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.message);
}

}  // namespace

JumpPlayer::JumpPlayer(const demo::CharacterFile& character, const std::string& clip, double seconds)
    : seconds_(seconds), tape_(character, seconds + kBehind_s, clip) {
  must(world::open_asset(character.file.bytes(), &asset_));
  must(world::make_instance(asset_, {}, &instance_));
}

void JumpPlayer::step(const Way& way) {
  const std::span<const Matrix34> joints = tape_.joints(static_cast<double>(++tick_) * asset_.tick_s);
  std::ranges::copy(joints, instance_.next_joints);
  instance_.state->has_next = 1;
  if (way.hidden) return pass_by();
  instance_.plan = {.ticks = {.ticks = 1, .first_tick_s = asset_.tick_s},
                    .dt_s = asset_.tick_s,
                    .tier = way.tier,
                    .level = frame::is_simulated(way.tier) ? way.level : instance_.state->level};
  world::step_instance(instance_, {});
}

void JumpPlayer::pass_by() {
  if (instance_.state->hidden == 0) world::hide(instance_);
  world::PlanRow row;
  row.state = instance_.state;
  world::copy_to_row(instance_, &row);
  world::pass_by({.ticks = 1}, row);
  world::keep_hidden_ticks(row);
}

Surface JumpPlayer::surface() const {
  Surface out(size_t{3} * asset_.vertex_count());
  world::read_positions(instance_,
                        {.space = Space::kBind, .out = out.data(), .capacity = asset_.vertex_count()});
  return out;
}

JumpPlayer::Mark JumpPlayer::mark() const {
  std::vector<std::byte> state(world::snapshot_bytes(instance_));
  must(world::save(instance_, state));
  return {std::move(state), tick_};
}

void JumpPlayer::go_back(const Mark& mark) {
  must(world::restore(instance_, mark.state));
  tick_ = mark.tick;
}

size_t JumpPlayer::ticks() const { return static_cast<size_t>(seconds_ / asset_.tick_s); }

}  // namespace sinew::perf

// events.cpp  see events.hpp.
#include "character/output/events.hpp"

#include <algorithm>

namespace sinew::world {
namespace {

uint8_t bit(EventKind kind, bool is_set) noexcept {
  return static_cast<uint8_t>(is_set ? 1u << static_cast<uint32_t>(kind) : 0u);
}

}  // namespace

void log_event(EventLog& log, const Event& event) noexcept {
  if (log.count == log.capacity) {
    ++log.lost;
    if (log.capacity == 0) return;
    log.first = (log.first + 1) % log.capacity;
    --log.count;
  }
  log.ring[(log.first + log.count++) % log.capacity] = event;
}

size_t take_events(EventLog& log, std::span<Event> out) noexcept {
  const auto taken = static_cast<uint32_t>(std::min<size_t>(log.count, out.size()));
  for (uint32_t i = 0; i < taken; ++i) out[i] = log.ring[(log.first + i) % log.capacity];
  if (taken > 0) log.first = (log.first + taken) % log.capacity;
  log.count -= taken;
  return taken;
}

EventCounts event_counts(const Instance& instance) noexcept {
  const InstanceState& state = *instance.state;
  return {state.teleports.root_teleports, state.teleports.part_teleports, state.rods.recoveries};
}

uint8_t events_since(const EventCounts& before, const Instance& instance) noexcept {
  const EventCounts now = event_counts(instance);
  return static_cast<uint8_t>(bit(EventKind::kTeleport, now.root_teleports != before.root_teleports) |
                              bit(EventKind::kPartTeleport, now.part_teleports != before.part_teleports) |
                              bit(EventKind::kNetworkGivenUp, instance.marks.fell_back) |
                              bit(EventKind::kRestart, instance.marks.restarted) |
                              bit(EventKind::kRodRecovery, now.rod_recoveries != before.rod_recoveries));
}

}  // namespace sinew::world

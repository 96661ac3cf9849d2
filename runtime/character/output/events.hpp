// events.hpp  What happened to instances since somebody asked, in the order of steps and slots.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "character/instance.hpp"
#include "sinew/event.hpp"

namespace sinew::world {

// A ring; of more than it holds the oldest are lost.
struct EventLog {
  std::unique_ptr<Event[]> ring;
  uint32_t capacity = 0, first = 0, count = 0;
  uint64_t lost = 0;
};

void log_event(EventLog& log, const Event& event) noexcept;
size_t take_events(EventLog& log, std::span<Event> out) noexcept;

// Counters that tell events, before an instance's share of a step; afterwards a bit for each EventKind.
struct EventCounts {
  uint32_t root_teleports, part_teleports, rod_recoveries;
};
EventCounts event_counts(const Instance& instance) noexcept;
uint8_t events_since(const EventCounts& before, const Instance& instance) noexcept;

}  // namespace sinew::world

// region_part.hpp  A soft part of an instance at its level: its records, and where its numbers begin.
#pragma once
#include <algorithm>

#include "character/instance.hpp"
#include "character/parameters/tuned_parts.hpp"
#include "character/rest/asleep.hpp"
#include "tissue/modes/modal_base.hpp"

namespace sinew::world {

struct Part {
  const pack::RegionRecord& record;
  tissue::ModalBase base;
  size_t index, node, vector, mode;
  float first_rad_per_s;  // as baked
  float limit_m;          // of what is shown, before its intensity
};

// Of what swings: an engine that lets less be shown lets it swing on beneath.
inline float swing_limit_m(const Part& part, float limit_m) noexcept {
  return std::max(limit_m, part.record.displacement_limit_m);
}

inline tissue::TickForce force_of(const Instance& instance, const Part& part) noexcept {
  const tissue::TickForce& all = instance.tissue.tick_force;
  return {all.q + part.mode,         all.r + part.vector,   all.added_q + part.mode,
          all.added_r + part.vector, all.off_q + part.mode, all.off_r + part.vector};
}

template <class Work>
void for_each_part(const Instance& instance, Work work) noexcept {
  const pack::PackView& pack = instance.level->pack;
  for (size_t r = 0; r < pack.regions.size(); ++r) {
    const size_t node = pack.regions[r].first_node;
    const Part part{pack.regions[r],
                    base_of(instance, r),
                    r,
                    node,
                    3 * node,
                    pack.region_modes[r].first_mode,
                    pack.region_modes[r].first_rad_per_s,
                    limit_m(instance, r)};
    work(part);
  }
}

template <class Work>
void for_each_awake_part(const Instance& instance, Work work) noexcept {
  for_each_part(instance, [&](const Part& part) {
    if (!instance.level->leaves_out(part.index) && !is_asleep(instance, part.index)) work(part);
  });
}

}  // namespace sinew::world

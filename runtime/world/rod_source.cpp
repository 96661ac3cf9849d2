// rod_source.cpp  see rod_source.hpp.
#include "world/rod_source.hpp"

#include <algorithm>

namespace sinew::world {

// Of hits of the surface: no body of the source's is here.
uint64_t RodSource::own_body() const noexcept { return reinterpret_cast<uintptr_t>(this); }

uint32_t RodSource::find(std::span<const ContactProbe> probes, float dt_s,
                         std::span<ContactHit> hits) noexcept {
  const uint32_t before = source_ ? source_->find(probes, dt_s, hits) : 0;
  const std::span<ContactHit> room = hits.subspan(std::min<size_t>(before, hits.size()));
  const uint32_t found = surface_->find(probes, dt_s, room);
  for (ContactHit& hit : room.first(std::min<size_t>(found, room.size()))) {
    hit.body = own_body();
    hit.name = ~hit.name;  // apart from the source's, which count from 0 as a rule
  }
  return before + found;
}

void RodSource::push(const ContactHit& hit, const double (&point_m)[3],
                     const float (&impulse_n_s)[3]) noexcept {
  if (source_ && hit.body != own_body()) source_->push(hit, point_m, impulse_n_s);
}

}  // namespace sinew::world

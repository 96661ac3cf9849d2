// rod_source.cpp  see rod_source.hpp.
#include "character/rods/rod_source.hpp"

#include <algorithm>

namespace sinew::world {

// Of hits of the surface: no body of the source's is here.
uint64_t RodSource::own_body() const noexcept { return reinterpret_cast<uintptr_t>(this); }

uint32_t RodSource::find_on_surface(std::span<const ContactProbe> probes, float dt_s,
                                    std::span<ContactHit> room) noexcept {
  const uint32_t found = surface_->find(probes, dt_s, room);
  for (ContactHit& hit : room.first(std::min<size_t>(found, room.size()))) {
    hit.body = own_body();
    hit.name = ~hit.name;  // apart from the source's, which count from 0 as a rule
  }
  return found;
}

// A heap of rubble does not crowd out skin: of what is too much for half the room the surface leaves room,
// too.
uint32_t RodSource::find(std::span<const ContactProbe> probes, float dt_s,
                         std::span<ContactHit> hits) noexcept {
  if (!source_) return find_on_surface(probes, dt_s, hits);
  const size_t half = (hits.size() + 1) / 2;
  const uint32_t of_source = source_->find(probes, dt_s, hits.first(half));
  if (of_source <= half) return of_source + find_on_surface(probes, dt_s, hits.subspan(of_source));
  const uint32_t of_surface = find_on_surface(probes, dt_s, hits.first(hits.size() - half));
  const size_t taken = std::min<size_t>(of_surface, hits.size() - half);
  return of_surface + source_->find(probes, dt_s, hits.subspan(taken));
}

void RodSource::push(const ContactHit& hit, const double (&point_m)[3],
                     const float (&impulse_n_s)[3]) noexcept {
  if (source_ && hit.body != own_body()) source_->push(hit, point_m, impulse_n_s);
}

}  // namespace sinew::world

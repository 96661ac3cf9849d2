// rod_source.hpp  What an instance's rods ask on tiers that afford it: ContactDef::source and the surface,
// each of which has half of the room and what the other leaves.
#pragma once
#include "sinew/contact_source.hpp"

namespace sinew::world {

class RodSource final : public ContactSource {
 public:
  // source: null: there is none. Both outlive it.
  RodSource(ContactSource* source, ContactSource* surface) noexcept : source_(source), surface_(surface) {}

  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override;
  // The source alone is told.
  void push(const ContactHit& hit, const double (&point_m)[3],
            const float (&impulse_n_s)[3]) noexcept override;

 private:
  uint64_t own_body() const noexcept;
  uint32_t find_on_surface(std::span<const ContactProbe> probes, float dt_s,
                           std::span<ContactHit> room) noexcept;

  ContactSource *source_, *surface_;
};

}  // namespace sinew::world

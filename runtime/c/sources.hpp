// sources.hpp  A caller's functions as the runtime's sources.
#pragma once
#include "sinew/contact_source.hpp"
#include "sinew/sinew.h"
#include "sinew/view.hpp"

namespace sinew::c {

class HeldSource final : public ContactSource {
 public:
  explicit HeldSource(const sinew_contact_source& functions) noexcept : functions_(functions) {}
  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override {
    return functions_.find(reinterpret_cast<const sinew_contact_probe*>(probes.data()),
                           static_cast<uint32_t>(probes.size()), dt_s,
                           reinterpret_cast<sinew_contact_hit*>(hits.data()),
                           static_cast<uint32_t>(hits.size()), functions_.context);
  }
  void push(const ContactHit& hit, const double (&point_m)[3],
            const float (&impulse_n_s)[3]) noexcept override {
    if (functions_.push)
      functions_.push(reinterpret_cast<const sinew_contact_hit*>(&hit), point_m, impulse_n_s,
                      functions_.context);
  }

 private:
  sinew_contact_source functions_;
};

// Of an instance; they live as long as it does.
struct HeldContacts {
  HeldSource source, surface;
};

class HeldOcclusion final : public OcclusionSource {
 public:
  sinew_occlusion_source functions = {};
  bool is_blocked(const double (&from_m)[3], const double (&to_m)[3]) noexcept override {
    return functions.is_blocked(from_m, to_m, functions.context);
  }
};

}  // namespace sinew::c

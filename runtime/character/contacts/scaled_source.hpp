// scaled_source.hpp  A contact source as an instance asks it: in its own metres, those of its bind pose.
#pragma once
#include <cstddef>
#include <memory>
#include <new>

#include "sinew/contact_source.hpp"

namespace sinew::world {

// What is asked and told is multiplied by the root's scale on the way to the source, what is answered divided
// by it; times, directions, impulses and numbers without a unit stay. At a scale of 1 all passes as it is.
class ScaledSource final : public ContactSource {
 public:
  // most: probes in one question; a longer one is cut off. The source outlives it.
  ScaledSource(ContactSource* source, size_t most) noexcept
      : source_(source), asked_(new (std::nothrow) ContactProbe[most]), most_(most) {}
  bool is_complete() const noexcept { return asked_ != nullptr; }
  void set_scale(double scale) noexcept { scale_ = scale; }

  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override;
  void push(const ContactHit& hit, const double (&point_m)[3],
            const float (&impulse_n_s)[3]) noexcept override;

 private:
  ContactSource* source_;
  std::unique_ptr<ContactProbe[]> asked_;
  size_t most_;
  double scale_ = 1;
};

}  // namespace sinew::world

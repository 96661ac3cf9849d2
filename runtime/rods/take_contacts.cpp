// take_contacts.cpp  The contact forces of one collider into another of the same strands.
#include "core/status.hpp"
#include "rods/collider.hpp"

namespace sinew::rods {

Status RodCollider::take_state(const RodCollider& from) noexcept {
  if (from.strand_count_ != strand_count_ || from.segment_count_ != segment_count_) {
    return core::make_status(
        StatusCode::kInvalidArgument,
        "the other collider is for %u strands of %u segments, this one for %u of %u; give "
        "one made for the same batch",
        from.strand_count_, from.segment_count_, strand_count_, segment_count_);
  }
  if (from.capacity_ > capacity_) {
    return core::make_status(
        StatusCode::kOutOfCapacity,
        "the other collider has room for %u contacts, this one for %u; create it with as "
        "large a contact_capacity",
        from.capacity_, capacity_);
  }
  if (&from == this) return {};
  ++steps_;  // forgets its own
  kept_in_use_ = kept_size_;
  for (uint32_t i = 0; i < from.kept_size_; ++i) {
    Kept kept = from.kept_[i];
    if (kept.step != from.steps_) continue;
    kept.step = steps_;
    *find_kept(kept.name) = kept;
  }
  return {};
}

}  // namespace sinew::rods

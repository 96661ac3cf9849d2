// take_contacts.cpp  The contact forces of one collider into another of the same strands.
#include "core/status.hpp"
#include "rods/contacts/collider.hpp"

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
  keep_nothing(capacity_);
  for (uint32_t i = 0; i < from.kept_forces_.kept_count; ++i) keep(from.kept_forces_.kept[i]);
  return {};
}

}  // namespace sinew::rods

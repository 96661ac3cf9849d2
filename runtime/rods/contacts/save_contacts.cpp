// save_contacts.cpp  The contact forces of a collider as bytes.
#include <algorithm>
#include <cstddef>
#include <cstring>

#include "rods/contacts/collider.hpp"

namespace sinew::rods {
namespace {

struct Saved {
  uint64_t name;
  ForceInNewtons force, change;
};

// A saved one where it lies, at any address.
struct SavedBytes {
  std::byte at[sizeof(Saved)];
  uint64_t name() const {
    uint64_t out;
    std::memcpy(&out, at, sizeof out);
    return out;
  }
};
static_assert(offsetof(Saved, name) == 0);

}  // namespace

size_t RodCollider::state_bytes() const noexcept { return sizeof(uint64_t) + capacity_ * sizeof(Saved); }

// By name: in what order contacts were found depends on others, and the same forces have the same bytes.
void RodCollider::save_state(std::byte* out) const noexcept {
  const uint64_t count = kept_forces_.kept_count;
  for (uint32_t i = 0; i < kept_forces_.kept_count; ++i) {
    const Saved one = {kept_forces_.kept[i].name, kept_forces_.kept[i].force, kept_forces_.kept[i].change};
    std::memcpy(out + sizeof count + i * sizeof one, &one, sizeof one);
  }
  std::memcpy(out, &count, sizeof count);
  auto* saved = reinterpret_cast<SavedBytes*>(out + sizeof count);
  std::sort(saved, saved + count,
            [](const SavedBytes& a, const SavedBytes& b) { return a.name() < b.name(); });
  std::memset(out + sizeof count + count * sizeof(Saved), 0, (capacity_ - count) * sizeof(Saved));
}

void RodCollider::restore_state(const std::byte* from) noexcept {
  keep_nothing(capacity_);
  uint64_t count = 0;
  std::memcpy(&count, from, sizeof count);
  for (uint64_t i = 0; i < count && i < capacity_; ++i) {
    Saved saved;
    std::memcpy(&saved, from + sizeof count + i * sizeof saved, sizeof saved);
    keep({saved.name, saved.force, saved.change});
  }
}

}  // namespace sinew::rods

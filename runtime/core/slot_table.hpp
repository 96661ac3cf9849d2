// slot_table.hpp  Objects in an array of fixed capacity, named by value ids with a generation.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>

#include "core/bring_near.hpp"

namespace sinew::core {

// Id is {index1, generation}. The array is allocated once, so pointers stay good until destroy. A slot whose
// generation would wrap is retired: an old id never becomes valid again.
template <class T, class Id>
class SlotTable {
 public:
  bool reserve(uint32_t capacity) noexcept {  // false: no memory
    slots_.reset(new (std::nothrow) Slot[capacity]);
    capacity_ = slots_ ? capacity : 0;
    return slots_ != nullptr;
  }

  // Null id when full.
  Id create(T&& item) noexcept {
    const uint32_t index = take_index();
    if (index == capacity_) return {};
    Slot& slot = slots_[index];
    slot.item = std::move(item);
    slot.live = true;
    ++count_;
    return {index + 1, ++slot.generation};
  }

  void destroy(Id id) noexcept {
    if (!find(id)) return;
    Slot& slot = slots_[id.index1 - 1];
    slot.item = T();
    slot.live = false;
    --count_;
    if (slot.generation == UINT32_MAX) return;  // retired
    slot.next_free = first_free_;
    first_free_ = id.index1;
  }

  T* find(Id id) const noexcept {
    if (id.index1 == 0 || id.index1 > end_) return nullptr;
    Slot& slot = slots_[id.index1 - 1];
    return slot.live && slot.generation == id.generation ? &slot.item : nullptr;
  }

  // Slots 0 .. end()-1 have been used; at() is null where the slot is free.
  uint32_t end() const noexcept { return end_; }
  T* at(uint32_t index) const noexcept { return slots_[index].live ? &slots_[index].item : nullptr; }
  // The first `bytes` of an item, and its slot's own, come into the cache meanwhile.
  void bring_near(uint32_t index, size_t bytes) const noexcept {
    if (index >= end_) return;
    const Slot& slot = slots_[index];
    const auto before =
        reinterpret_cast<const std::byte*>(&slot.item) - reinterpret_cast<const std::byte*>(&slot);
    core::bring_near(&slot, static_cast<size_t>(before) + bytes);
  }
  Id id_at(uint32_t index) const noexcept { return {index + 1, slots_[index].generation}; }
  uint32_t count() const noexcept { return count_; }
  uint32_t capacity() const noexcept { return capacity_; }

 private:
  struct alignas(64) Slot {  // a cache line
    uint32_t generation = 0;
    uint32_t next_free = 0;  // slot + 1
    bool live = false;
    T item{};
  };

  uint32_t take_index() noexcept {
    if (first_free_ == 0) return end_ < capacity_ ? end_++ : capacity_;
    const uint32_t index = first_free_ - 1;
    first_free_ = slots_[index].next_free;
    return index;
  }

  std::unique_ptr<Slot[]> slots_;
  uint32_t capacity_ = 0, end_ = 0, count_ = 0;
  uint32_t first_free_ = 0;  // slot + 1; 0: none
};

}  // namespace sinew::core

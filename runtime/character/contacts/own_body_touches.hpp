// own_body_touches.hpp  Soft parts against the capsules about the instance's own bones.
//
// Where ContactDef::own_body asks, of regions that touch it (pack::RegionRecord). A region passes for ever
// the capsules that overlap its vertices in the bind pose, and those of joints that carry its skin.
#pragma once
#include <memory>
#include <span>

#include "character/instance.hpp"
#include "sinew/contact_source.hpp"

namespace sinew::world {

// A bit for each capsule that the region may touch.
uint64_t touchable_by(const pack::PackView& pack, const pack::RegionRecord& region) noexcept;
// That of each region; null: none for any. kOutOfCapacity: no memory.
Status find_touchable(const pack::PackView& pack, std::unique_ptr<uint64_t[]>* out) noexcept;
// 0 where the instance's soft parts do not touch its body.
uint64_t touchable(const Instance& instance, uint32_t region) noexcept;

// Of the first touch: of what rests on a capsule, where it was shown, not where it would be if nothing
// pressed, which may be beyond the axis. Or where the way ends, if that is on the side of the first touch: of
// what was pushed, exactly.
enum class NormalsOf : uint32_t { kFirstTouch, kEnd };

// Contacts of balls or points on their way through the tick, as of ContactSource::find. Tells how many there
// are.
uint32_t find_own_body(const Instance& instance, uint64_t capsules, NormalsOf normals,
                       std::span<const ContactProbe> probes, std::span<ContactHit> hits) noexcept;
// Which of the capsules have contacts with a probe.
uint64_t near_own_body(const Instance& instance, uint64_t capsules, const ContactProbe& probe) noexcept;

}  // namespace sinew::world

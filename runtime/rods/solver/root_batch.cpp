// root_batch.cpp  Which segment the elimination ends at, and the order of records that follows from it.
#include "rods/create/batch_builder.hpp"

namespace sinew::rods {

uint32_t most_held(std::span<const StrandDef> strands) {
  uint32_t best = 0, most = 0;
  for (uint32_t i = 0; i < strands[0].segments.size(); ++i) {
    uint32_t count = 0;
    for (const StrandDef& strand : strands) count += strand.segments[i].fixed;
    if (count > most) best = i, most = count;
  }
  return best;
}

// From the new root to the first segment listed joints are told from their other end; all others follow as
// listed. What is held then ends the elimination, where it costs nothing: as the child of what moves it would
// be a joint without give to what has no mobility.
void RodBatchBuilder::root_at(uint32_t segment) {
  const uint32_t count = batch.segment_count_;
  uint32_t next = 0;
  for (uint32_t i = 0; i < count; ++i) batch.slots_[i] = count, batch.joint_segments_[i] = i;
  for (uint32_t i = segment;; i = batch.parents_[i]) {
    batch.slot_parents_[next] = next > 0 ? next - 1 : 0;
    batch.slots_[i] = next++;
    if (i == 0) break;
    batch.joint_segments_[i] = batch.parents_[i];
  }
  for (uint32_t i = 1; i < count; ++i) {
    if (batch.slots_[i] < count) continue;
    batch.slot_parents_[next] = batch.slots_[batch.parents_[i]];
    batch.slots_[i] = next++;
  }
}

}  // namespace sinew::rods

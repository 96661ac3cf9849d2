// broad_phase.cpp  Which segments may touch something at all, a group at a time: what the kernels are told.
#include <algorithm>

#include "kernels/kernels.hpp"
#include "rods/contacts/find/find_contacts.hpp"

namespace sinew::rods {
namespace {

const simd::RodTouchCalls& calls(uint32_t width) {
  const simd::RodTouchKernels& kernels = *simd::kernels().rod_touches;
  return width == 16 ? kernels.wide : kernels.narrow;
}

}  // namespace

const Sweep& ContactFinder::sweep(uint32_t strand, uint32_t segment) const {
  if (!to.near_by_.swept[local(strand, segment)]) add_sweep(strand, segment);
  return to.near_by_.sweeps[local(strand, segment)];
}

simd::RodReachJob ContactFinder::reach_job(uint32_t group) const {
  const size_t w = batch.width_, segments = batch.segment_count_, g = place_of(group);
  return {.records = &batch.records_[group * segments * simd::kRodKeptFields * w],
          .scratch = to.scratch(static_cast<uint32_t>(g)),
          .radii_m = batch.radii_m_ + group * segments * w,
          .length_m = to.near_by_.lengths_m + g * w,
          .origin_m = to.near_by_.origins_m + g * 3 * w,
          .reaches = to.near_by_.reaches + g * segments * simd::kReachRows * w,
          .boxes = to.near_by_.reach_boxes + g * simd::kBoxRows * w,
          .segments = batch.segment_count_,
          .strands = std::min(batch.width_, batch.strand_count_ - group * batch.width_)};
}

// Lanes without a strand repeat the first one's, as the batch's records do.
void ContactFinder::place_lanes(uint32_t group) const {
  const size_t w = batch.width_, g = place_of(group);
  for (size_t k = 0; k < w; ++k) {
    const size_t strand = group * w + k < batch.strand_count_ ? group * w + k : 0;
    const RodBatch::Units& units = batch.units_[strand];
    to.near_by_.lengths_m[g * w + k] = units.length_m;
    for (size_t i = 0; i < 3; ++i) to.near_by_.origins_m[(g * 3 + i) * w + k] = units.origin_m[i];
  }
}

void ContactFinder::find_reaches() const {
  for (uint32_t g = to.places_.range.first_group; g < to.places_.range.first_group + to.places_.range.groups;
       ++g) {
    place_lanes(g);
    calls(batch.width_).reach(reach_job(g));
  }
  std::fill_n(to.near_by_.swept + local(first_strand(), 0),
              size_t{end_strand() - first_strand()} * batch.segment_count_, uint8_t{0});
}

bool ContactFinder::near(uint32_t group, const simd::RodRound& round) const {
  return calls(batch.width_).near_round(reach_job(group), round, to.near_by_.near_lanes);
}

bool ContactFinder::near(uint32_t group, const simd::RodFlat& flat) const {
  return calls(batch.width_).near_flat(reach_job(group), flat, to.near_by_.near_lanes);
}

bool ContactFinder::may_enter(uint32_t group) const {
  return calls(batch.width_).enter(reach_job(group), to.near_by_.near_lanes);
}

void ContactFinder::touch(uint32_t group, uint32_t segment, uint32_t lanes, const simd::RodRound& round,
                          simd::RodTouches* out) const {
  calls(batch.width_).touch(reach_job(group), round, batch.slots_[segment], lanes, out);
}

}  // namespace sinew::rods

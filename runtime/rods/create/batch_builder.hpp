// batch_builder.hpp  Lays out and fills one batch.
#pragma once
#include <span>

#include "core/arena.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

// The segment that is fixed in most strands, the first of several; 0 if none is.
uint32_t most_held(std::span<const StrandDef> strands);

// A friend of the batch, so that the class shows only what a user calls.
struct RodBatchBuilder {
  RodBatch& batch;

  size_t groups() const { return (batch.strand_count_ + batch.width_ - 1) / batch.width_; }
  void lay_out(std::byte* base, size_t* bytes);
  void lay_out_start(core::Arena& arena);
  // Puts the records in the order of a tree whose root this segment is.
  void root_at(uint32_t segment);
  void set_units(const StrandDef& strand, uint32_t index);
  // All of a batch that is laid out; refuses what check_units and check_filled refuse.
  Status fill_all(std::span<const StrandDef> strands);
  // `slot` may lie behind the last strand: lanes that nobody looks at repeat the first strand's numbers.
  void fill(const StrandDef& strand, uint32_t slot, uint32_t index);
  void keep_rest(uint32_t strand);
  void keep_radii(const StrandDef& strand, uint32_t slot);
  // Of the strand's units, before they divide.
  Status check_units(const StrandDef& strand, uint32_t index) const;
  // Of what fill() left of a strand.
  Status check_filled(const StrandDef& strand, uint32_t index) const;

 private:
  struct Kept;
  Status check_above_zero(uint32_t strand, uint32_t i, uint32_t record, std::span<const Kept> kept) const;
  Status check_joint(const SegmentDef& s, uint32_t strand, uint32_t i) const;
  void set_body(const SegmentDef& s, uint32_t slot, uint32_t i, const RodBatch::Units& units);
  void set_joint(const SegmentDef& parent, const SegmentDef& s, uint32_t slot, uint32_t i,
                 const RodBatch::Units& units);
  void set_pose(const SegmentDef& s, uint32_t slot, uint32_t i, const RodBatch::Units& units);
  void put(uint32_t slot, uint32_t segment, uint32_t field, double value) {
    batch.at(slot, segment, field) = static_cast<float>(value);
  }
};

}  // namespace sinew::rods

// create_batch.cpp  Lays a batch out and has it filled.
#include "core/arena.hpp"
#include "core/status.hpp"
#include "rods/create/batch_builder.hpp"
#include "rods/create/check_batch.hpp"

namespace sinew::rods {
namespace {

constexpr uint32_t kWide = 16, kNarrow = 4;

}  // namespace

void RodBatchBuilder::lay_out(std::byte* base, size_t* bytes) {
  core::Arena arena(base);
  const size_t rows = groups() * batch.segment_count_ * simd::kRodKeptFields;
  batch.records_ = arena.take<float>(rows * batch.width_);
  const size_t group_floats = size_t{batch.segment_count_} * batch.width_;
  batch.scratch_ = arena.take<float>(group_floats * simd::kRodScratchRows);
  batch.work_ = arena.take<float>(group_floats * simd::kRodWorkRows);
  batch.lanes_ = arena.take<float>(groups() * simd::kLaneFields * batch.width_);
  lay_out_start(arena);
  batch.rest_ =
      arena.take<float>(size_t{batch.strand_count_} * batch.segment_count_ * RodBatch::kRestNumbers);
  batch.radii_m_ = arena.take<float>(groups() * batch.segment_count_ * batch.width_);
  batch.made_joints_ =
      arena.take<float>(groups() * batch.segment_count_ * RodBatch::kMadeJoint * batch.width_);
  batch.units_ = arena.take<RodBatch::Units>(batch.strand_count_);
  for (uint32_t** list : {&batch.parents_, &batch.slots_, &batch.joint_segments_, &batch.slot_parents_}) {
    *list = arena.take<uint32_t>(batch.segment_count_);
  }
  *bytes = arena.used_bytes();
}

void RodBatchBuilder::lay_out_start(core::Arena& arena) {
  if (!batch.has_history()) return;
  const size_t rows = groups() * batch.segment_count_ * batch.width_;
  batch.history_ = arena.take<float>(rows * simd::kRodStartAges * simd::kRodStartNumbers);
  if (!batch.has_inputs()) return;
  batch.inputs_ = arena.take<float>(rows * simd::kRodStartInputs);
  batch.continued_ = arena.take<float>(rows * simd::kRodStartNumbers);
  batch.scales_ = arena.take<float>(groups() * simd::kRodStartTriples * batch.width_);
  if (batch.net_.latent == 0) return;
  batch.encodings_ = arena.take<float>(rows * batch.net_.latent);
  batch.planes_ =
      arena.take<float>(simd::rod_net_floats(batch.segment_count_, batch.net_.latent, batch.width_));
}

Status RodBatchBuilder::fill_all(std::span<const StrandDef> strands) {
  for (uint32_t i = 1; i < batch.segment_count_; ++i) batch.parents_[i] = strands[0].segments[i].parent;
  root_at(most_held(strands));
  Status status;
  for (uint32_t i = 0; i < batch.strand_count_ && status.ok(); ++i) {
    set_units(strands[i], i);
    status = check_units(strands[i], i);
  }
  for (uint32_t slot = 0; status.ok() && slot < groups() * batch.width_; ++slot) {
    const uint32_t strand = slot < batch.strand_count_ ? slot : 0;
    fill(strands[strand], slot, strand);
    keep_radii(strands[strand], slot);
    if (slot >= batch.strand_count_) continue;
    keep_rest(slot);
    status = check_filled(strands[slot], slot);
  }
  return status;
}

size_t RodBatch::memory_bytes(uint32_t strands, uint32_t segments, const RodSettings& settings) noexcept {
  RodBatch measured;
  measured.settings_ = settings;
  if (settings.start == RodStart::kLearned) measured.net_ = start_net(*settings.network);
  measured.strand_count_ = strands;
  measured.segment_count_ = segments;
  measured.width_ = strands > kNarrow ? kWide : kNarrow;
  size_t bytes = 0;
  RodBatchBuilder{measured}.lay_out(nullptr, &bytes);
  return bytes;
}

Status RodBatch::create(std::span<const StrandDef> strands, const RodSettings& settings,
                        RodBatch* out) noexcept {
  Status status = check_batch(strands, settings);
  if (!status.ok()) return status;
  RodBatch made;
  RodBatchBuilder builder{made};
  made.settings_ = settings;
  if (settings.start == RodStart::kLearned) made.net_ = start_net(*settings.network);
  made.strand_count_ = static_cast<uint32_t>(strands.size());
  made.segment_count_ = static_cast<uint32_t>(strands[0].segments.size());
  made.width_ = strands.size() > kNarrow ? kWide : kNarrow;
  size_t bytes = 0;
  builder.lay_out(nullptr, &bytes);
  made.memory_ = core::AlignedBlock(bytes);
  if (!made.memory_.data()) {
    return core::make_status(StatusCode::kOutOfCapacity, "no memory for %zu bytes of rods; make fewer",
                             bytes);
  }
  builder.lay_out(made.memory_.data(), &bytes);
  status = builder.fill_all(strands);
  if (!status.ok()) return status;
  made.tell_fixed_inputs();
  *out = static_cast<RodBatch&&>(made);
  return status;
}

}  // namespace sinew::rods

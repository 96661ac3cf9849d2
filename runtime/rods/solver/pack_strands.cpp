// pack_strands.cpp  Which lanes strands that go on are moved to, and back.
#include <algorithm>

#include "kernels/kernels.hpp"
#include "rods/solver/strand_packer.hpp"

namespace sinew::rods {
namespace {

constexpr uint32_t kLanes = 16, kVector = 8;

}  // namespace

// A kernel's call for each pair of groups.
struct StrandPacker::Moves {
  const StrandPacker& packer;
  bool ended;
  uint32_t from = 0, to = 0;
  bool any = false;
  int8_t lanes[kLanes] = {};

  void add(uint32_t from_seat, uint32_t to_seat) {
    if (any && (from != from_seat / kLanes || to != to_seat / kLanes)) end();
    if (!any) std::fill_n(lanes, kLanes, int8_t{-1});
    any = true, from = from_seat / kLanes, to = to_seat / kLanes;
    lanes[to_seat % kLanes] = static_cast<int8_t>(from_seat % kLanes);
  }
  void end() {
    if (any) simd::kernels().rods->wide.move_lanes(packer.job(from), packer.job(to), lanes, ended);
    any = false;
  }
};

template <class Each>
void StrandPacker::for_each_strand(const Each& each) const {
  const GroupRange& range = to.places_.range;
  for (uint32_t place = range.first_place; place < range.first_place + range.groups; ++place) {
    const uint32_t first = to.places_.homes[place] * kLanes,
                   end = std::min(first + kLanes, batch.strand_count_);
    for (uint32_t s = first; s < end; ++s) each(s, place * kLanes + s - first);
  }
}

simd::RodJob StrandPacker::job(uint32_t place) const {
  simd::RodJob job = {};
  job.segments = batch.segment_count_;
  if (place >= to.places_.home_groups) return to.packed_job(job, place - to.places_.home_groups);
  const size_t group = to.places_.homes[place];
  job.records = batch.records_ + group * job.segments * simd::kRodKeptFields * kLanes;
  job.scratch = to.scratch(place);
  job.lanes = batch.lanes_ + group * simd::kLaneFields * kLanes;
  return job;
}

// All that are packed, or those that do not go on.
void StrandPacker::go_home(bool all) const {
  Moves moves = {*this, true};
  for_each_strand([&](uint32_t s, uint32_t home) {
    if (!packed(s) || (!all && goes_on(s))) return;
    moves.add(to.seat(s), home);
    to.seat(s) = home;
  });
  moves.end();
}

// One behind the other, in their order.
void StrandPacker::take_seats(uint32_t from) const {
  const uint32_t first = to.places_.home_groups * kLanes, end = first + to.places_.packed_groups * kLanes;
  uint32_t seat = first + from;
  Moves moves = {*this, false};
  for_each_strand([&](uint32_t s, uint32_t) {
    if (!goes_on(s) || seat == end) return;
    if (to.seat(s) != seat) moves.add(to.seat(s), seat);
    to.seat(s) = seat++;
  });
  moves.end();
  to.places_.packed_count = seat - first;
  const uint32_t whole = (seat + kLanes - 1) / kLanes * kLanes;
  for (; seat < whole; ++seat) rest(seat);
  for_each_strand([this](uint32_t s, uint32_t home) {
    if (packed(s)) rest(home);
  });
}

void StrandPacker::rest(uint32_t seat) const {
  job(seat / kLanes).lanes[simd::kLaneActive * kLanes + seat % kLanes] = 0;
}

void StrandPacker::add() const noexcept {
  if (to.places_.packed_groups > 0) take_seats(to.places_.packed_count);
}

// Of eight lanes, with one that goes on.
uint32_t StrandPacker::vectors() const {
  uint32_t count = 0, last = ~0u;
  for_each_strand([&](uint32_t s, uint32_t) {
    if (!goes_on(s) || to.seat(s) / kVector == last) return;
    last = to.seat(s) / kVector;
    ++count;
  });
  return count;
}

void StrandPacker::pack(uint32_t active) const noexcept {
  if (active > to.places_.packed_groups * kLanes) return;
  if (2 * ((active + kVector - 1) / kVector) > vectors()) return;
  go_home(false);
  take_seats(0);
}

void StrandPacker::unpack() const noexcept {
  if (to.places_.packed_count == 0) return;
  go_home(true);
  to.places_.packed_count = 0;
}

simd::RodJob RodCollider::packed_job(simd::RodJob job, uint32_t k) const noexcept {
  job.records = places_.packed_records + size_t{k} * segment_count_ * simd::kRodKeptFields * width_;
  job.scratch = scratch(places_.home_groups + k);
  job.lanes = places_.packed_lanes + size_t{k} * simd::kLaneFields * width_;
  give(&job, places_.home_groups + k);
  return job;
}

}  // namespace sinew::rods

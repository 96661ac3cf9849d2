// strand_packer.hpp  Strands of several groups that go on, side by side in few.
//
// On a head that turns one strand in four goes on after the first iteration, one in a hundred after the
// seventh: of their own vectors of eight three in four go on, and one in eight. What a strand comes to does
// not depend on its lane. Not where rods collide, which wake one another.
#pragma once
#include "rods/contacts/collider.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {

struct StrandPacker {
  RodCollider& to;
  const RodBatch& batch;

  // Those of the range that go on, behind those of the ranges before, as far as there is room.
  void add() const noexcept;
  // So many that go on, where that halves their vectors.
  void pack(uint32_t active) const noexcept;
  // Each into its own group.
  void unpack() const noexcept;

 private:
  // Moves from one group to another, told in order.
  struct Moves;

  bool packed(uint32_t strand) const { return batch.group_of(to.seat(strand)) >= to.places_.home_groups; }
  bool goes_on(uint32_t strand) const {
    return (to.progress_.turning[strand] | to.progress_.pending[strand]) != 0;
  }
  // each(strand, its seat in its own group) of the range, in order.
  template <class Each>
  void for_each_strand(const Each& each) const;
  simd::RodJob job(uint32_t place) const;
  void go_home(bool all) const;
  void take_seats(uint32_t from) const;
  void rest(uint32_t seat) const;
  uint32_t vectors() const;
};

}  // namespace sinew::rods

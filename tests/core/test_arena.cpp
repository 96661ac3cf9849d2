// test_arena.cpp  One layout function measures and places; blocks are aligned and zeroed.
#include <catch2/catch.hpp>
#include <cstdint>

#include "core/aligned_block.hpp"
#include "core/arena.hpp"

using sinew::core::AlignedBlock;
using sinew::core::Arena;

namespace {

struct Arrays {
  char* small;
  double* large;
  float* empty;
  float* last;
};

Arrays lay_out(Arena& arena) {
  return {arena.take<char>(3), arena.take<double>(17), arena.take<float>(0), arena.take<float>(1)};
}

bool is_aligned(const void* pointer) { return reinterpret_cast<uintptr_t>(pointer) % Arena::kAlignment == 0; }

}  // namespace

TEST_CASE("arena_without_memory_only_measures") {
  Arena measure;
  const Arrays arrays = lay_out(measure);
  CHECK(arrays.small == nullptr);
  CHECK(arrays.last == nullptr);
  CHECK(measure.used_bytes() == 64 + 192 + 0 + 64);
}

TEST_CASE("arena_places_aligned_arrays_that_do_not_overlap") {
  Arena measure;
  lay_out(measure);
  const AlignedBlock block(measure.used_bytes());
  Arena arena(block.data());
  const Arrays arrays = lay_out(arena);
  CHECK(arena.used_bytes() == measure.used_bytes());
  CHECK(is_aligned(arrays.small));
  CHECK(is_aligned(arrays.large));
  CHECK(is_aligned(arrays.last));
  CHECK(reinterpret_cast<char*>(arrays.large) >= arrays.small + 3);
  CHECK(arrays.last >= static_cast<void*>(arrays.large + 17));
}

TEST_CASE("aligned_block_is_zeroed_and_moves") {
  AlignedBlock block(1000);
  REQUIRE(block.data() != nullptr);
  CHECK(is_aligned(block.data()));
  bool zero = true;
  for (size_t i = 0; i < 1000; ++i) zero = zero && block.data()[i] == std::byte{0};
  CHECK(zero);
  const std::byte* data = block.data();
  AlignedBlock moved(std::move(block));
  CHECK(moved.data() == data);
  AlignedBlock assigned;
  assigned = std::move(moved);
  CHECK(assigned.data() == data);
}

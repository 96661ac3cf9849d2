// test_precision.cpp  A character whose network works in halves or bytes moves as its float32 twin does.
#include "simd/isa.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr int kFrames = 300;

struct Difference {
  double largest_m = 0, moved_m = 0;  // from the twin; of the twin, from its bind pose
};

// Five seconds of walking, bind-space deltas of both.
Difference difference_to_float32(pack::Precision precision) {
  Stage stage(1, {}, test::block_pack(precision)), twin;
  Difference out;
  for (int f = 0; f < kFrames; ++f) {
    stage.step(scenes::walk, kFrame_s), twin.step(scenes::walk, kFrame_s);
    const std::vector<float> places = twin.read(0, Space::kBind);
    out.largest_m = std::max(out.largest_m, test::largest_distance(stage.read(0, Space::kBind), places));
    out.moved_m = std::max(out.moved_m, test::largest_length(places));
  }
  CHECK(stage.report().tier == Tier::kNetwork);
  CHECK(stage.report().fallbacks == 0);
  return out;
}

}  // namespace

// As shares of the largest displacement, three times what is seen: 8e-5 of halves, 0.002 of bytes. The
// block's cells have no memory and y leaks by a fifth a tick, so rounding hardly adds up.
TEST_CASE("reduced_precision_stays_near_float32_over_five_seconds") {
  for (const auto& [precision, most] :
       {std::pair(pack::Precision::kHalfStates, 2.4e-4), std::pair(pack::Precision::kInt8, 0.006)}) {
    const Difference difference = difference_to_float32(precision);
    CAPTURE(static_cast<uint32_t>(precision), difference.largest_m, difference.moved_m);
    CHECK(difference.moved_m > 0.01);
    CHECK(difference.largest_m > 0);
    CHECK(difference.largest_m < most * difference.moved_m);
  }
}

TEST_CASE("states_of_halves_make_an_instance_s_state_smaller") {
  Stage floats;
  for (const pack::Precision precision : {pack::Precision::kHalfStates, pack::Precision::kInt8}) {
    Stage halves(1, {}, test::block_pack(precision));
    // Two regions of 14 nodes, three planes of 16 channels, two bytes a number less.
    CHECK(floats.save().size() - halves.save().size() == 2 * 14 * 3 * 16 * 2);
  }
}

TEST_CASE("a_character_comes_to_rest_in_every_precision") {
  for (const pack::Precision precision : test::kPrecisions) {
    Stage stage(1, {}, test::block_pack(precision));
    stage.play(scenes::walk, 1);
    stage.play([](double) { return scenes::bind_pose(); }, 5);
    CHECK(test::largest_length(stage.read(0, Space::kBind)) < 1e-4);  // as in test_guards
  }
}

// Whatever the vector width: the whole character, not its network alone.
TEST_CASE("every_precision_has_the_same_bits_on_all_targets_with_fma") {
  for (const pack::Precision precision : test::kPrecisions) {
    std::vector<uint64_t> hashes;
    test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
      if (!kernels.fused) return;
      Stage stage(1, {}, test::block_pack(precision));
      stage.play(scenes::walk, 2);
      hashes.push_back(test::hash_of(stage.read()));
    });
    if (hashes.size() < 2) WARN("one instruction set with FMA on this machine: nothing to compare");
    for (const uint64_t hash : hashes) CHECK(hash == hashes.front());
  }
}

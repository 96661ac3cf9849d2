// test_pack_strands.cpp  Strands that go on in a lane of another group.
#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch.hpp>

#include "core/aligned_block.hpp"
#include "kernels/rods/rod_job.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kWidth = 16, kSegments = 5;
constexpr uint32_t kParents[kSegments] = {0, 0, 1, 2, 3};

// A group of sixteen strands, of zeros.
class Group {
 public:
  Group() : memory_(sizeof(float) * kWidth * (kSegments * size_t{simd::kRodFields} + simd::kLaneFields)) {}

  float& at(uint32_t segment, uint32_t field, uint32_t lane) {
    const bool kept = field < simd::kRodKeptFields;
    const uint32_t fields = kept ? uint32_t{simd::kRodKeptFields} : uint32_t{simd::kRodScratchRows};
    const uint32_t row = kept ? field : field - simd::kRodKeptFields;
    return (kept ? records() : scratch())[(segment * fields + row) * kWidth + lane];
  }
  float& lane(uint32_t field, uint32_t k) { return lanes()[field * kWidth + k]; }
  simd::RodJob job() {
    simd::RodJob job = {};
    job.records = records(), job.scratch = scratch(), job.lanes = lanes();
    job.work = scratch() + kSegments * simd::kRodScratchRows * kWidth;
    job.parents = kParents, job.segments = kSegments;
    job.dt_s = 1.0f / 60, job.tolerance_rad = 1e-4f;
    return job;
  }

 private:
  float* lanes() { return reinterpret_cast<float*>(memory_.data()); }
  float* records() { return lanes() + simd::kLaneFields * kWidth; }
  float* scratch() { return records() + kSegments * simd::kRodKeptFields * kWidth; }

  core::AlignedBlock memory_;
};

// Anything that is finite; it need not be a rod.
void fill(Group* group) {
  std::mt19937 random(7);
  for (uint32_t k = 0; k < kWidth; ++k) {
    for (uint32_t i = 0; i < kSegments; ++i) {
      for (uint32_t f = 0; f < simd::kRodScratchFields; ++f)
        group->at(i, f, k) = test::uniform(random, 0.5f, 1.5f);
      group->at(i, simd::kRodFree, k) = i > 0 ? 1 : 0;
      group->at(i, simd::kRodTied, k) = 0;
      for (uint32_t n = 0; n < 4; ++n) group->at(i, simd::kRodNow + n, k) = 0.5f;
    }
    for (uint32_t f = 0; f < simd::kLaneFields; ++f) group->lane(f, k) = test::uniform(random, 0.5f, 1.5f);
    group->lane(simd::kLaneActive, k) = 1;
  }
}

bool same(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

}  // namespace

TEST_CASE("an_iteration_comes_to_the_same_bits_in_a_lane_of_another_group") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    Group from, to;
    fill(&from);
    std::array<int8_t, kWidth> lanes;
    lanes.fill(-1);
    lanes[0] = 3, lanes[1] = 15, lanes[9] = 4;
    const simd::RodCalls& calls = kernels.rods->wide;
    calls.move_lanes(from.job(), to.job(), lanes.data(), false);
    calls.direct(from.job()), calls.direct(to.job());
    for (uint32_t k = 0; k < kWidth; ++k) {
      if (lanes[k] < 0) continue;
      const auto source = static_cast<uint32_t>(lanes[k]);
      for (uint32_t f = 0; f < simd::kLaneFields; ++f) {
        INFO("lane " << k << " field " << f);
        CHECK(same(to.lane(f, k), from.lane(f, source)));
      }
      for (uint32_t i = 0; i < kSegments; ++i) {
        for (uint32_t f = simd::kRodMove; f < simd::kRodMiss; ++f)
          CHECK(same(to.at(i, f, k), from.at(i, f, source)));
      }
    }
    CHECK(from.lane(simd::kLaneMoved, 3) > 0);
  });
}

// test_spatial_hash.cpp  The hash finds exactly the pairs that looking at all pairs finds.
#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <vector>

#include "core/aligned_block.hpp"
#include "rods/contacts/find/spatial_hash.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using rods::SweptBox;

namespace {

using Pairs = std::multiset<std::pair<uint32_t, uint32_t>>;

struct OwnedHash {
  explicit OwnedHash(uint32_t capacity) {
    core::Arena measure;
    hash.lay_out(&measure, capacity);
    memory = core::AlignedBlock(measure.used_bytes());
    core::Arena place(memory.data());
    hash.lay_out(&place, capacity);
  }
  core::AlignedBlock memory;
  rods::SpatialHash hash;
};

Pairs found_pairs(OwnedHash& owned, const std::vector<SweptBox>& boxes) {
  Pairs out;
  owned.hash.build(boxes.data(), static_cast<uint32_t>(boxes.size()));
  owned.hash.for_pairs([&](uint32_t i, uint32_t j) { out.insert({i, j}); });
  return out;
}

Pairs all_pairs(const std::vector<SweptBox>& boxes) {
  Pairs out;
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    for (uint32_t j = i + 1; j < boxes.size(); ++j) {
      bool overlap = true;
      for (size_t k = 0; k < 3; ++k) {
        overlap = overlap && boxes[i].low[k] <= boxes[j].high[k] && boxes[j].low[k] <= boxes[i].high[k];
      }
      if (overlap) out.insert({i, j});
    }
  }
  return out;
}

// Edges from `smallest` to a thousand times that, about a place anywhere within `spread`.
std::vector<SweptBox> random_boxes(std::mt19937& random, size_t count, double spread, double smallest,
                                   double offset) {
  std::vector<SweptBox> boxes(count);
  for (SweptBox& box : boxes) {
    for (size_t k = 0; k < 3; ++k) {
      const double edge = smallest * std::pow(10, static_cast<double>(test::uniform(random, 0, 3)));
      box.low[k] = offset + spread * static_cast<double>(test::uniform(random, -1, 1));
      box.high[k] = box.low[k] + edge;
    }
  }
  return boxes;
}

}  // namespace

TEST_CASE("the_hash_finds_exactly_what_looking_at_all_pairs_finds") {
  OwnedHash owned(200);
  for (uint32_t seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const double spread = std::pow(10, static_cast<double>(test::uniform(random, -1, 1)));
    const double offset = seed % 3 == 0 ? 0 : seed % 3 == 1 ? -1e4 : 1e6;
    const auto boxes = random_boxes(random, 1 + seed % 200, spread, 0.01 * spread, offset);
    INFO("seed " << seed);
    const Pairs expected = all_pairs(boxes);
    CHECK(found_pairs(owned, boxes) == expected);
    if (seed == 199) CHECK(expected.size() > 100);
  }
}

TEST_CASE("boxes_on_cell_edges_of_no_size_alike_and_crowded_are_found_once") {
  OwnedHash owned(64);
  std::vector<SweptBox> grid;
  for (int i = 0; i < 64; ++i) {
    const double x = i % 4, y = i / 4 % 4, z = i / 16;
    grid.push_back({{x, y, z}, {x + 1, y + 1, z + 1}});
  }
  CHECK(found_pairs(owned, grid) == all_pairs(grid));
  const std::vector<SweptBox> points(20, {{0.5, -3, 7}, {0.5, -3, 7}});
  CHECK(found_pairs(owned, points).size() == 190);
}

TEST_CASE("boxes_that_are_not_finite_or_too_far_away_overlap_nothing") {
  OwnedHash owned(8);
  const SweptBox good = {{0, 0, 0}, {1, 1, 1}}, lost = {{std::nan(""), 0, 0}, {1, 1, 1}},
                 endless = {{0, 0, -HUGE_VAL}, {1, 1, 1}}, far = {{0, 0, 0}, {1, 1e300, 1}};
  CHECK(found_pairs(owned, {good, lost, good, endless, far}) == Pairs{{0, 2}});
}

TEST_CASE("pairs_come_in_an_order_that_depends_on_the_boxes_alone") {
  std::mt19937 random(4);
  const auto boxes = random_boxes(random, 100, 1, 0.02, 0);
  OwnedHash first(100), second(100);
  found_pairs(second, random_boxes(random, 60, 3, 0.1, 0));  // used before, for others
  std::vector<std::pair<uint32_t, uint32_t>> a, b;
  first.hash.build(boxes.data(), 100);
  first.hash.for_pairs([&](uint32_t i, uint32_t j) { a.push_back({i, j}); });
  second.hash.build(boxes.data(), 100);
  second.hash.for_pairs([&](uint32_t i, uint32_t j) { b.push_back({i, j}); });
  CHECK(a == b);
  CHECK(a.size() > 20);
}

// spatial_hash.hpp  Which of many boxes overlap, in memory taken once.
//
// Cells are cubes whose edge is a power of two. A box lies in the cells of the first size that is larger than
// it, eight at most, so that fast and slow, long and short ones are found alike, and is looked for in the
// cells of its own and of larger sizes. A pair counts in the cell where its overlap begins: once. O(n) for
// boxes that do not crowd; exact (tests hold it to all pairs).
#pragma once
#include <cstdint>

#include "core/arena.hpp"
#include "rods/vector.hpp"

namespace sinew::rods {

struct SweptBox {
  Vector low, high;  // a box that is not finite, or beyond 2^30 m, overlaps nothing
};

class SpatialHash {
 public:
  // Takes its memory: some 250 bytes a box.
  void lay_out(core::Arena* arena, uint32_t capacity) noexcept;

  // At most as many boxes as there is room for; they stay where they are until the last pair is found.
  void build(const SweptBox* boxes, uint32_t count) noexcept;

  // found(i, j), i < j, each pair once, in an order that depends on the boxes alone.
  template <class Found>
  void for_pairs(const Found& found) const noexcept {
    for (uint32_t i = 0; i < count_; ++i) {
      if (levels_[i] != kNone) for_pairs_of(i, found);
    }
  }

 private:
  struct Cell {
    int64_t x, y, z;
  };
  struct Entry {
    uint32_t box;
    int32_t level;
    Cell cell;
  };
  static constexpr int kSmallest = -31, kLevels = 63, kNone = kLevels;  // edge 2^(kSmallest + level)

  static double per_edge(int level) noexcept { return std::ldexp(1.0, -(kSmallest + level)); }
  static Cell cell_of(const Vector& point, double per_edge) noexcept {
    return {static_cast<int64_t>(std::floor(point[0] * per_edge)),
            static_cast<int64_t>(std::floor(point[1] * per_edge)),
            static_cast<int64_t>(std::floor(point[2] * per_edge))};
  }
  static bool same(const Cell& a, const Cell& b) noexcept { return a.x == b.x && a.y == b.y && a.z == b.z; }
  uint32_t bucket(const Cell& cell, int level) const noexcept;
  bool overlap(uint32_t i, uint32_t j, Vector* begin) const noexcept;

  template <class Body>
  void for_cells(uint32_t i, int level, const Body& body) const noexcept {
    const double scale = per_edge(level);
    const Cell low = cell_of(boxes_[i].low, scale), high = cell_of(boxes_[i].high, scale);
    for (int64_t x = low.x; x <= high.x; ++x) {
      for (int64_t y = low.y; y <= high.y; ++y) {
        for (int64_t z = low.z; z <= high.z; ++z) body(Cell{x, y, z});
      }
    }
  }

  template <class Found>
  void for_pairs_of(uint32_t i, const Found& found) const noexcept {
    for (int level = levels_[i]; level < kLevels; ++level) {
      if (!(present_ >> level & 1)) continue;
      for_cells(i, level, [&](const Cell& cell) {
        const uint32_t b = bucket(cell, level);
        for (uint32_t k = starts_[b]; k < starts_[b + 1]; ++k) {
          const Entry& e = entries_[k];
          if (e.level != level || !same(e.cell, cell) || (level == levels_[i] && e.box <= i)) continue;
          Vector begin;
          if (!overlap(i, e.box, &begin) || !same(cell_of(begin, per_edge(level)), cell)) continue;
          i < e.box ? found(i, e.box) : found(e.box, i);
        }
      });
    }
  }

  const SweptBox* boxes_ = nullptr;
  uint8_t* levels_ = nullptr;   // [capacity]
  uint32_t* starts_ = nullptr;  // [buckets + 1]
  Entry* entries_ = nullptr;    // [8 capacity]
  uint64_t present_ = 0;        // levels
  uint32_t count_ = 0, buckets_ = 0;
};

}  // namespace sinew::rods

// spatial_hash.cpp  Boxes into cells, cells into buckets, by counting.
#include "rods/contacts/find/spatial_hash.hpp"

#include <algorithm>
#include <bit>

namespace sinew::rods {
namespace {

constexpr uint32_t kMostCells = 8;        // of a box at its own level
constexpr double kFurthest = 1073741824;  // m, 2^30

double extent(const SweptBox& box) {
  const Vector size = difference(box.high, box.low);
  return std::max({size[0], size[1], size[2], 0.0});
}

// Where cells of every size can be counted.
bool countable(const SweptBox& box) {
  bool good = finite(box.low) && finite(box.high);
  for (size_t k = 0; k < 3; ++k) {
    good = good && std::fabs(box.low[k]) < kFurthest && std::fabs(box.high[k]) < kFurthest;
  }
  return good;
}

}  // namespace

void SpatialHash::lay_out(core::Arena* arena, uint32_t capacity) noexcept {
  buckets_ = std::bit_ceil(std::max(capacity, 8u)) * 4;
  levels_ = arena->take<uint8_t>(capacity);
  starts_ = arena->take<uint32_t>(size_t{buckets_} + 1);
  entries_ = arena->take<Entry>(size_t{capacity} * kMostCells);
}

uint32_t SpatialHash::bucket(const Cell& cell, int level) const noexcept {
  uint64_t h = static_cast<uint64_t>(cell.x) * 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 32 ^ static_cast<uint64_t>(cell.y)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 32 ^ static_cast<uint64_t>(cell.z)) * 0x94d049bb133111ebu;
  h = (h ^ h >> 32 ^ static_cast<uint64_t>(level)) * 0x9e3779b97f4a7c15u;
  return static_cast<uint32_t>(h >> 32) & (buckets_ - 1);
}

bool SpatialHash::overlap(uint32_t i, uint32_t j, Vector* begin) const noexcept {
  const SweptBox &a = boxes_[i], &b = boxes_[j];
  for (size_t k = 0; k < 3; ++k) {
    (*begin)[k] = std::max(a.low[k], b.low[k]);
    if ((*begin)[k] > std::min(a.high[k], b.high[k])) return false;
  }
  return true;
}

void SpatialHash::build(const SweptBox* boxes, uint32_t count) noexcept {
  boxes_ = boxes, count_ = count, present_ = 0;
  std::fill_n(starts_, size_t{buckets_} + 1, 0u);
  for (uint32_t i = 0; i < count; ++i) {
    const double size = extent(boxes[i]);
    const bool good = countable(boxes[i]);
    const int level = good ? std::max(size > 0 ? std::ilogb(size) + 1 - kSmallest : 0, 0) : kNone;
    levels_[i] = static_cast<uint8_t>(level);
    if (!good) continue;
    present_ |= uint64_t{1} << level;
    for_cells(i, level, [&](const Cell& cell) { ++starts_[bucket(cell, level) + 1]; });
  }
  for (uint32_t b = 0; b < buckets_; ++b) starts_[b + 1] += starts_[b];
  const uint32_t all = starts_[buckets_];
  // A bucket's end, in the next place, moves to its start while it is filled from behind.
  for (uint32_t i = count; i-- > 0;) {
    if (levels_[i] == kNone) continue;
    for_cells(i, levels_[i], [&](const Cell& cell) {
      entries_[--starts_[bucket(cell, levels_[i]) + 1]] = {i, levels_[i], cell};
    });
  }
  for (uint32_t b = 0; b < buckets_; ++b) starts_[b] = starts_[b + 1];
  starts_[buckets_] = all;
}

}  // namespace sinew::rods

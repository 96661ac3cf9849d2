// asset.cpp  A loaded character: checked views of its pack.
#include "character/asset/asset.hpp"

namespace sinew::world {

void make_modal_front(std::span<const frame::Level> points, float publish_us, TierCosts* out) noexcept {
  frame::Level modal[frame::kMostLevels];
  uint32_t count = 0;
  for (const frame::Level& point : points)
    if (point.tier == Tier::kModal) modal[count++] = point;
  frame::make_front({modal, count}, publish_us, &out->modal_front);
}

float error_of(const Asset& asset, Tier tier, uint32_t level) noexcept {
  for (uint32_t i = 0; i < asset.point_count; ++i) {
    const frame::Level& point = asset.points[i];
    if (point.tier == tier && point.graph == level) return point.error;
  }
  return 1;
}

}  // namespace sinew::world

// parts.cpp  see parts.hpp.
#include "baker/preview/parts.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace sinew::baker {
namespace {

Part soft_part(const pack::PackView& view, size_t index) {
  const pack::RegionRecord& region = view.regions[index];
  const double first_rad_per_s = static_cast<double>(view.region_modes[index].first_rad_per_s);
  Part part{pack::string_at(view, region.name), false, first_rad_per_s / (2 * std::numbers::pi), {}, {}, {}};
  const auto vertices = view.region_vertices.subspan(region.first_vertex, region.vertex_count);
  part.vertices.assign(vertices.begin(), vertices.end());
  part.share.assign(vertices.size(), 0);
  for (uint32_t node = 0; node < region.node_count; ++node) {
    const float* weights = &view.carry[region.carry + size_t{node} * region.padded_vertices];
    for (size_t v = 0; v < vertices.size(); ++v) part.share[v] += weights[v];
  }
  for (float& share : part.share) share = std::clamp(share, 0.0f, 1.0f);
  return part;
}

Part rod_part(const pack::PackView& view, const pack::RodRecord& rod) {
  Part part{pack::string_at(view, rod.name), true, static_cast<double>(rod.frequency_hz), {}, {}, {}};
  const auto at = [](const float(&p)[3]) { return Eigen::Vector3f(p[0], p[1], p[2]); };
  for (const pack::RodSegmentRecord& s : view.rod_segments.subspan(rod.first_segment, rod.segment_count))
    part.bones.emplace_back(at(s.begin_m), at(s.end_m));
  for (uint32_t v = 0; v < view.character->vertex_count; ++v) {
    float share = 0;
    for (size_t i = 0; i < pack::kInfluences; ++i) {
      const uint32_t segment = view.joint_rods[view.skin[v].joint[i]];
      const bool is_on = segment != pack::kNoIndex && segment - rod.first_segment < rod.segment_count;
      if (is_on) share += view.skin[v].weight[i];
    }
    if (share <= 0) continue;
    part.vertices.push_back(v);
    part.share.push_back(std::min(share, 1.0f));
  }
  return part;
}

}  // namespace

std::vector<Part> parts_of(const pack::PackView& character) {
  std::vector<Part> parts;
  for (size_t r = 0; r < character.regions.size(); ++r) parts.push_back(soft_part(character, r));
  for (const pack::RodRecord& rod : character.rods) parts.push_back(rod_part(character, rod));
  return parts;
}

}  // namespace sinew::baker

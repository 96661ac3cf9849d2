// parts.cpp  A vertex is a region's that carries it, else the rod's that its first joint hangs on.
#include "baker/audit/parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace sinew::baker {
namespace {

double length_of(const pack::PackView& character, const pack::RodRecord& rod) {
  const auto segments = character.rod_segments.subspan(rod.first_segment, rod.segment_count);
  std::vector<double> to_end(segments.size());
  for (size_t s = 0; s < segments.size(); ++s) {
    const pack::RodSegmentRecord& segment = segments[s];
    double square = 0;
    for (int axis = 0; axis < 3; ++axis)
      square += std::pow(double{segment.end_m[axis]} - double{segment.begin_m[axis]}, 2);
    to_end[s] = std::sqrt(square) + (segment.parent == pack::kNoIndex ? 0 : to_end[segment.parent]);
  }
  return *std::ranges::max_element(to_end);
}

size_t rod_of(const pack::PackView& character, uint32_t segment) {
  const auto holds = [&](const pack::RodRecord& rod) {
    return segment - rod.first_segment < rod.segment_count;
  };
  return static_cast<size_t>(std::ranges::find_if(character.rods, holds) - character.rods.begin());
}

void name_parts(const pack::PackView& character, AuditedParts& parts) {
  for (size_t r = 0; r < character.regions.size(); ++r) {
    const pack::RegionRecord& region = character.regions[r];
    parts.all.push_back({pack::string_at(character, region.name), false, region.radius_m,
                         static_cast<double>(character.region_modes[r].first_rad_per_s) / (2 * M_PI)});
  }
  parts.regions = parts.all.size();
  for (const pack::RodRecord& rod : character.rods)
    parts.all.push_back({pack::string_at(character, rod.name), true, length_of(character, rod),
                         rod.frequency_hz > 0 ? static_cast<double>(rod.frequency_hz)
                                              : std::numeric_limits<double>::quiet_NaN()});
}

}  // namespace

AuditedParts find_parts(const pack::PackView& character) {
  AuditedParts parts;
  name_parts(character, parts);
  parts.of_vertex.assign(character.character->vertex_count, AuditedParts::kNone);
  for (size_t v = 0; v < parts.of_vertex.size() && !character.joint_rods.empty(); ++v)
    if (const uint32_t segment = character.joint_rods[character.skin[v].joint[0]]; segment != pack::kNoIndex)
      parts.of_vertex[v] = static_cast<int>(parts.regions + rod_of(character, segment));
  for (size_t r = 0; r < character.regions.size(); ++r) {
    const pack::RegionRecord& region = character.regions[r];
    for (const uint32_t v : character.region_vertices.subspan(region.first_vertex, region.vertex_count))
      parts.of_vertex[v] = static_cast<int>(r);
  }
  std::set<std::array<uint32_t, 2>> seen;
  const auto length = [&](uint32_t a, uint32_t b) {
    const float* positions = character.positions.data();
    return std::hypot(double{positions[3 * a]} - positions[3 * b],
                      double{positions[3 * a + 1]} - positions[3 * b + 1],
                      double{positions[3 * a + 2]} - positions[3 * b + 2]);
  };
  for (size_t t = 0; t + 2 < character.triangles.size(); t += 3) {
    const std::array corners = {character.triangles[t], character.triangles[t + 1],
                                character.triangles[t + 2]};
    const int part =
        std::max({parts.of_vertex[corners[0]], parts.of_vertex[corners[1]], parts.of_vertex[corners[2]]});
    if (part == AuditedParts::kNone) continue;
    parts.triangles.push_back(corners);
    parts.of_triangle.push_back(part);
    ++parts.all[static_cast<size_t>(part)].triangles;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = std::min(corners[k], corners[(k + 1) % 3]),
                     b = std::max(corners[k], corners[(k + 1) % 3]);
      const int of_edge = std::max(parts.of_vertex[a], parts.of_vertex[b]);
      if (of_edge != AuditedParts::kNone && seen.insert({a, b}).second)
        parts.edges.push_back({a, b, of_edge, length(a, b)});
    }
  }
  return parts;
}

}  // namespace sinew::baker

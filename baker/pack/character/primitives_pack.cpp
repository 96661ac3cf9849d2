// primitives_pack.cpp  see primitives_pack.hpp.
#include "baker/pack/character/primitives_pack.hpp"

namespace sinew::baker {
namespace {

uint32_t to_u32(size_t value) { return static_cast<uint32_t>(value); }

std::vector<PrimitiveSpan> primitives_of(const Character& character) {
  if (!character.primitives.empty()) return character.primitives;
  return {{.vertex_count = character.positions.size(), .triangle_count = character.triangles.size()}};
}

}  // namespace

void add_primitives(const Character& character, PackWriter& pack) {
  std::vector<pack::PrimitiveRecord> records;
  for (const PrimitiveSpan& span : primitives_of(character))
    records.push_back({.mesh = to_u32(span.mesh),
                       .material = span.material.empty() ? pack::kNoIndex : pack.string(span.material),
                       .first_vertex = to_u32(span.first_vertex),
                       .vertex_count = to_u32(span.vertex_count),
                       .first_triangle = to_u32(span.first_triangle),
                       .triangle_count = to_u32(span.triangle_count),
                       .index = to_u32(span.index),
                       .sharer = static_cast<uint32_t>(span.sharer + 1)});
  pack.section(pack::SectionKind::kPrimitives, records);
}

void add_tangents(const Character& character, PackWriter& pack) {
  std::vector<float> numbers;
  for (const Tangent& tangent : character.tangents) {
    for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<float>(tangent.along[axis]));
    numbers.push_back(static_cast<float>(tangent.sign));
  }
  pack.section(pack::SectionKind::kTangents, numbers, 4);
}

}  // namespace sinew::baker

// rods_pack.cpp  Rods of a character to the sections that the runtime simulates them from.
#include "baker/pack/character/rods_pack.hpp"

namespace sinew::baker {
namespace {

using pack::SectionKind;

uint32_t index_or_none(int index) { return index < 0 ? pack::kNoIndex : static_cast<uint32_t>(index); }

pack::RodSegmentRecord segment_record(const RodBone& bone) {
  pack::RodSegmentRecord record{};
  record.joint = index_or_none(bone.joint);
  record.parent = index_or_none(bone.parent);
  for (int axis = 0; axis < 3; ++axis) {
    record.begin_m[axis] = static_cast<float>(bone.begin[axis]);
    record.end_m[axis] = static_cast<float>(bone.end[axis]);
  }
  record.radius_m = static_cast<float>(bone.radius_m);
  record.density_kg_m3 = static_cast<float>(bone.density_kg_m3);
  record.young_modulus_pa = static_cast<float>(bone.young_modulus_pa);
  record.torsion_modulus_pa = static_cast<float>(bone.torsion_modulus_pa);
  record.damping_s = static_cast<float>(bone.damping_s);
  record.drag_per_s = static_cast<float>(bone.drag_per_s);
  return record;
}

// Parents come before children: what hangs on a bone of a rod is moved by the bone.
std::vector<uint32_t> carried_joints(const Character& character,
                                     const std::vector<pack::RodSegmentRecord>& segments) {
  std::vector<uint32_t> carried(character.joint_node.size(), pack::kNoIndex);
  for (uint32_t s = 0; s < segments.size(); ++s)
    if (segments[s].joint != pack::kNoIndex) carried[segments[s].joint] = s;
  for (size_t j = 0; j < carried.size(); ++j) {
    const int up = character.joint_parent[j];
    if (carried[j] == pack::kNoIndex && up >= 0) carried[j] = carried[static_cast<size_t>(up)];
  }
  return carried;
}

}  // namespace

void add_rods(const Character& character, const std::vector<Rod>& rods, bool has_network, PackWriter& pack) {
  if (rods.empty()) return;
  std::vector<pack::RodRecord> records;
  std::vector<pack::RodSegmentRecord> segments;
  for (const Rod& rod : rods) {
    pack::RodRecord record{};
    record.name = pack.string(rod.name);
    record.attach = static_cast<uint32_t>(rod.attach);
    record.end_holder = static_cast<uint32_t>(rod.end_joint + 1);
    record.first_segment = static_cast<uint32_t>(segments.size());
    record.segment_count = static_cast<uint32_t>(rod.bones.size());
    record.gravity = static_cast<float>(rod.gravity);
    record.sag = static_cast<float>(rod.sag);
    record.frequency_hz = static_cast<float>(rod.frequency_hz);
    record.turn_limit_rad = static_cast<float>(rod.max_displacement);
    for (int axis = 0; axis < 3; ++axis)
      record.gravity_direction[axis] = static_cast<float>(rod.gravity_direction[axis]);
    record.passed_proxies = rod.passed_proxies;
    record.start = rod.learned_start && has_network;
    records.push_back(record);
    for (const RodBone& bone : rod.bones) segments.push_back(segment_record(bone));
  }
  pack.section(SectionKind::kRods, records);
  pack.section(SectionKind::kRodSegments, segments);
  pack.section(SectionKind::kJointRods, carried_joints(character, segments));
}

void add_proxies(const std::vector<Proxy>& proxies, PackWriter& pack) {
  if (proxies.empty()) return;
  std::vector<pack::ProxyRecord> records;
  for (const Proxy& proxy : proxies) {
    pack::ProxyRecord record{};
    record.joint = static_cast<uint32_t>(proxy.joint);
    for (int axis = 0; axis < 3; ++axis) {
      record.from_m[axis] = static_cast<float>(proxy.from[axis]);
      record.to_m[axis] = static_cast<float>(proxy.to[axis]);
    }
    record.radius_m = static_cast<float>(proxy.radius_m);
    records.push_back(record);
  }
  pack.section(SectionKind::kProxies, records);
}

}  // namespace sinew::baker

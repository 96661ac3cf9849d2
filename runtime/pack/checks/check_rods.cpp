// check_rods.cpp  Rods agree with the skeleton that they move, and are made of something.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/status.hpp"
#include "pack/checks/checks.hpp"

namespace sinew::pack {
namespace {

constexpr float kMostGravity = 100, kMostFrequency_hz = 1e6f;
constexpr float kLeastRate_hz = 1;  // a longer tick is none that rods are stepped by: rods/rod_batch.hpp
constexpr uint32_t kMostSegments = 65535;  // of a rod: rods/strand.hpp, less the one that is held

constexpr uint32_t kLearnedStart = 1;
// The two norms behind a COPINGNet's layers, padded (format.hpp). Trained answers are at most 20 times the
// last step's miss.
constexpr size_t kNormFloats = 32;
constexpr float kMostNorm = 1000;

bool is_not_negative(float value) noexcept { return std::isfinite(value) && value >= 0; }

Status check_counts(const PackView& pack) noexcept {
  if (pack.rods.size() != pack.character->rod_count)
    return corrupt("rods: %zu there, the character states %u", pack.rods.size(), pack.character->rod_count);
  const size_t carried = pack.rods.empty() ? 0 : pack.joints.size();
  if (pack.joint_rods.size() != carried)
    return corrupt("joint rods: %zu numbers there, %zu wanted", pack.joint_rods.size(), carried);
  const float rate_hz = pack.network->rate_hz;
  if (!pack.rods.empty() && !(rate_hz >= kLeastRate_hz))
    return corrupt("rods: %g ticks a second, below 1", double{rate_hz});
  return {};
}

// A strand is a lane of its kernels, which take eight outputs at a time (rods/start/learned_start.hpp).
Status check_rod_network(const PackView& pack) noexcept {
  const ChainsView& chains = pack.rod_network;
  if (!chains.record) {
    const bool empty = chains.layers.empty() && chains.weights.empty();
    return empty ? Status{} : corrupt("rod network: layers or weights of a network that is not there");
  }
  if (pack.rods.empty()) return corrupt("rod network: a network for rods that are not there");
  if (chains.record->model != ModelKind::kCopingNet)
    return core::make_status(
        StatusCode::kUnsupported,
        "pack: rods' network of model %u, which no rod starts from; bake it with weights "
        "of coping_net",
        static_cast<uint32_t>(chains.record->model));
  const uint32_t latent = chains.record->max_channels;
  if (latent % 8 != 0 || latent > kPanel)
    return core::make_status(
        StatusCode::kUnsupported,
        "pack: rods' network of latent width %u; rods start from a multiple of 8, at most "
        "%u: bake it with other weights",
        latent, kPanel);
  if (Status status = check_chains(chains); !status.ok()) return status;
  const auto norms = chains.weights.last(kNormFloats);
  return *std::ranges::max_element(norms) <= kMostNorm ? Status{} : corrupt("rod network: a norm above 1000");
}

Status check_record(const PackView& pack, const RodRecord& rod, size_t index, uint64_t first) noexcept {
  if (Status status = check_name(pack, rod.name, "rod", index); !status.ok()) return status;
  if (rod.attach >= pack.joints.size())
    return corrupt("rod %zu: hangs on joint %u of %zu", index, rod.attach, pack.joints.size());
  if (rod.segment_count < 1 || rod.segment_count > kMostSegments)
    return corrupt("rod %zu: %u segments, outside 1..65535", index, rod.segment_count);
  if (rod.end_holder != 0 && rod.segment_count == kMostSegments)
    return corrupt("rod %zu: 65535 segments and a held end, at most 65534", index);
  if (rod.first_segment != first || rod.segment_count > pack.rod_segments.size() - first)
    return corrupt("rod %zu: segments do not follow the rod before it", index);
  if (!is_not_negative(rod.gravity) || rod.gravity > kMostGravity)
    return corrupt("rod %zu: gravity %g, outside 0..100", index, double{rod.gravity});
  if (!(rod.sag >= 0 && rod.sag <= 1))
    return corrupt("rod %zu: sag %g, outside 0..1", index, double{rod.sag});
  if (!(rod.turn_limit_rad >= 0 && rod.turn_limit_rad <= std::numbers::pi_v<float>))
    return corrupt("rod %zu: rotation limit %g, outside 0..pi", index, double{rod.turn_limit_rad});
  if (!is_within(rod.frequency_hz, 0, kMostFrequency_hz))
    return corrupt("rod %zu: frequency %g Hz, outside 0..1e6", index, double{rod.frequency_hz});
  if (!is_unit(rod.gravity_direction))
    return corrupt("rod %zu: the direction of its gravity is not a unit vector", index);
  if (rod.end_holder > pack.joints.size())
    return corrupt("rod %zu: its end is held by joint %u of %zu", index, rod.end_holder - 1,
                   pack.joints.size());
  if (rod.start > kLearnedStart) return corrupt("rod %zu: start %u is not known", index, rod.start);
  if (rod.start == kLearnedStart && !pack.rod_network.record)
    return corrupt("rod %zu: a learned start, and no network for it", index);
  return check_zero(std::span(&rod.reserved, 1), "rod", index);
}

Status check_material(const RodSegmentRecord& segment, size_t index) noexcept {
  struct Number {
    const char* name;
    float value;
  };
  for (const Number& number : {Number{"radius", segment.radius_m}, Number{"density", segment.density_kg_m3},
                               Number{"Young's modulus", segment.young_modulus_pa},
                               Number{"torsion modulus", segment.torsion_modulus_pa}})
    if (!is_positive(number.value))
      return corrupt("rod segment %zu: %s %g", index, number.name, double{number.value});
  if (!is_not_negative(segment.damping_s) || !is_not_negative(segment.drag_per_s))
    return corrupt("rod segment %zu: damping %g s, drag %g 1/s", index, double{segment.damping_s},
                   double{segment.drag_per_s});
  return check_zero(segment.reserved, "rod segment", index);
}

Status check_place(const RodSegmentRecord& segment, size_t index) noexcept {
  if (!are_within(segment.begin_m, kFarthest_m) || !are_within(segment.end_m, kFarthest_m))
    return corrupt("rod segment %zu: its ends are not within +-1e5 m", index);
  const float length =
      std::hypot(segment.end_m[0] - segment.begin_m[0], segment.end_m[1] - segment.begin_m[1],
                 segment.end_m[2] - segment.begin_m[2]);
  return is_positive(length) ? Status{} : corrupt("rod segment %zu: length %g m", index, double{length});
}

// The joint of the bone that a segment hangs on, links passed over.
uint32_t joint_above(const PackView& pack, const RodRecord& rod, const RodSegmentRecord& segment) noexcept {
  uint32_t at = segment.parent;
  while (at != kNoIndex) {
    const RodSegmentRecord& above = pack.rod_segments[rod.first_segment + at];
    if (above.joint != kNoIndex) return above.joint;
    at = above.parent;
  }
  return rod.attach;
}

// The segments before it have been checked.
Status check_segment(const PackView& pack, const RodRecord& rod, uint32_t own) noexcept {
  const size_t index = size_t{rod.first_segment} + own;
  const RodSegmentRecord& segment = pack.rod_segments[index];
  if ((segment.parent == kNoIndex) != (own == 0) || (own > 0 && segment.parent >= own))
    return corrupt("rod segment %zu: its parent does not come before it", index);
  if (rod.end_holder != 0 && own > 0 && segment.parent != own - 1)
    return corrupt("rod segment %zu: a branch of a rod whose end is held", index);
  if (Status status = check_place(segment, index); !status.ok()) return status;
  if (Status status = check_material(segment, index); !status.ok()) return status;
  if (own > 0) {
    const RodSegmentRecord& above = pack.rod_segments[rod.first_segment + segment.parent];
    for (int k = 0; k < 3; ++k)
      if (segment.begin_m[k] != above.end_m[k])
        return corrupt("rod segment %zu: does not begin where its parent ends", index);
  }
  if (segment.joint == kNoIndex) {
    // A link in a row with another one would make the way to the bone above long.
    const bool bone_above =
        own > 0 && pack.rod_segments[rod.first_segment + segment.parent].joint != kNoIndex;
    return bone_above ? Status{} : corrupt("rod segment %zu: a link that hangs on no bone", index);
  }
  if (segment.joint >= pack.joints.size())
    return corrupt("rod segment %zu: joint %u of %zu", index, segment.joint, pack.joints.size());
  if (pack.joints[segment.joint].parent != joint_above(pack, rod, segment))
    return corrupt("rod segment %zu: hangs on another bone than its joint does", index);
  if (pack.joint_rods[segment.joint] != index)
    return corrupt("rod segment %zu: its joint is moved by another segment", index);
  return {};
}

Status check_rods_and_segments(const PackView& pack) noexcept {
  uint64_t first = 0;
  for (size_t index = 0; index < pack.rods.size(); ++index) {
    const RodRecord& rod = pack.rods[index];
    if (Status status = check_record(pack, rod, index, first); !status.ok()) return status;
    for (uint32_t own = 0; own < rod.segment_count; ++own)
      if (Status status = check_segment(pack, rod, own); !status.ok()) return status;
    first += rod.segment_count;
  }
  return first == pack.rod_segments.size() ? Status{} : corrupt("rods: segments that no rod owns");
}

// A joint is moved by its own segment, else as its parent is.
Status check_carried(const PackView& pack) noexcept {
  for (size_t j = 0; j < pack.joint_rods.size(); ++j) {
    const uint32_t carrier = pack.joint_rods[j], parent = pack.joints[j].parent;
    const bool own = carrier < pack.rod_segments.size() && pack.rod_segments[carrier].joint == j;
    const uint32_t inherited = parent == kNoIndex ? kNoIndex : pack.joint_rods[parent];
    if (!own && carrier != inherited)
      return corrupt("joint rods %zu: neither the joint's own segment nor its parent's", j);
  }
  for (size_t index = 0; index < pack.rods.size(); ++index) {
    const RodRecord& rod = pack.rods[index];
    if (pack.joint_rods[rod.attach] != kNoIndex)
      return corrupt("rod %zu: hangs on a bone that a rod moves", index);
    if (rod.end_holder != 0 && pack.joint_rods[rod.end_holder - 1] != kNoIndex)
      return corrupt("rod %zu: its end is held by a bone that a rod moves", index);
  }
  return {};
}

}  // namespace

Status check_rods(const PackView& pack) noexcept {
  constexpr Check kChecks[] = {check_counts, check_rod_network, check_rods_and_segments, check_carried};
  return run_checks(kChecks, pack);
}

}  // namespace sinew::pack

// test_rod_rig.cpp  Rods on a skeleton: axes of neighbouring segments, whichever way a chain points.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <numbers>
#include <vector>

#include "character/asset/rod_rig.hpp"

using namespace sinew;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr uint32_t kBones = 8;
constexpr double kBend_rad = 0.2;

// A coil about `along`: each bone turned by kBend_rad against the one before, in a plane that goes round.
struct Coil {
  explicit Coil(const Vector3d& along) {
    joints.resize(kBones + 1);
    for (pack::JointRecord& joint : joints)
      joint.inverse_bind[0] = joint.inverse_bind[5] = joint.inverse_bind[10] = 1;
    segments.resize(kBones);
    Vector3d at = Vector3d::Zero(), way = along.normalized();
    for (uint32_t s = 0; s < kBones; ++s) {
      const Vector3d side =
          way.cross(s % 2 == 0 ? Vector3d(0.3, 1, 0.1) : Vector3d(1, -0.2, 0.4)).normalized();
      if (s > 0) way = Eigen::AngleAxisd(kBend_rad, side) * way;
      const Vector3d end = at + 0.1 * way;
      segments[s].joint = s + 1;
      segments[s].parent = s == 0 ? pack::kNoIndex : s - 1;
      Eigen::Map<Eigen::Vector3f>(segments[s].begin_m) = at.cast<float>();
      Eigen::Map<Eigen::Vector3f>(segments[s].end_m) = end.cast<float>();
      segments[s].radius_m = 0.01f, segments[s].density_kg_m3 = 1000;
      at = end;
    }
    rod.segment_count = kBones;
  }
  pack::PackView view() const {
    pack::PackView out{};
    out.joints = joints, out.rods = {&rod, 1}, out.rod_segments = segments;
    return out;
  }
  std::vector<pack::JointRecord> joints;
  std::vector<pack::RodSegmentRecord> segments;
  pack::RodRecord rod{};
};

Quaterniond axes(const world::RodSlot& slot) { return Quaterniond(slot.bind_xyzw); }

}  // namespace

TEST_CASE("neighbouring_segments_are_turned_by_their_bend_alone_whichever_way_a_chain_points") {
  // Directions are floats of half a metre in tenths of one.
  constexpr double kRounding_rad = 2e-6;
  for (const Vector3d& along : {Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(0.02, -0.03, -1),
                                Vector3d(0, -1, 0), Vector3d(1, 1, -1)}) {
    const Coil coil(along);
    world::RodRig rig;
    REQUIRE(world::make_rod_rig(coil.view(), &rig).ok());
    REQUIRE(rig.slot_count == kBones + 1);
    CHECK(axes(rig.slots()[0]).angularDistance(axes(rig.slots()[1])) < kRounding_rad);
    for (uint32_t s = 2; s <= kBones; ++s) {
      const double turned_rad = axes(rig.slots()[s]).angularDistance(axes(rig.slots()[s - 1]));
      CHECK(turned_rad == Approx(kBend_rad).margin(kRounding_rad));
    }
  }
}

TEST_CASE("a_strand_is_defined_with_the_axes_of_its_slots") {
  const Coil coil({0.02, -0.03, -1});
  world::RodRig rig;
  REQUIRE(world::make_rod_rig(coil.view(), &rig).ok());
  std::vector<rods::SegmentDef> defs(kBones + 1);
  world::define_strand(coil.view(), rig, 0, defs);
  for (uint32_t s = 0; s <= kBones; ++s) {
    const Quaterniond defined = Eigen::Map<const Eigen::Quaternionf>(defs[s].orientation).cast<double>();
    CHECK(defined.angularDistance(axes(rig.slots()[s])) < 1e-6);  // quaternions in floats
  }
  CHECK(defs[0].fixed);
}

// bullet.hpp  Contacts with the bodies of a Bullet world that the engine owns.
//
// Each tick a capsule on its way is swept against every body near it: candidates by Bullet's broadphase, then
// spheres, boxes, capsules, cylinders, planes and triangles in closed form and other convex shapes by
// Bullet's GJK and EPA, in double precision where it is Sinew's and about the body's own place. Surfaces are
// where Bullet has them, collision margins included; boxes and cylinders have sharp edges. Triangle meshes
// are sheets with two sides; what is below a heightfield is solid.
//
// stepSimulation comes before Sinew's step: transforms are those at the tick's end, and velocities say where
// bodies were when it began. Sleeping bodies stand still.
//
// Nothing of the world is remembered from one call to the next but where a body is that was added nowhere
// (BulletProblem::kNotFinite): between two steps of Sinew the engine may add, move, change and remove bodies
// as it likes, and must not while find, push or apply_impulses run. find reads broadphase boxes; whoever
// moves a body outside stepSimulation calls updateSingleAabb.
//
// Threads: find and push from several at a time, push and find not at once with apply_impulses. The answers
// do not depend on how many there are, but while a body that was added nowhere is not found yet. Nothing in
// find, push and apply_impulses allocates.
// Cost: some microseconds a probe that touches, a fraction of one for a probe that does not; for 16 probes at
// a time nanoseconds more for each child, of the first 1,024, of a compound near them, and for each body of
// the world while one is nowhere.
#pragma once
#include <cstdint>

#include "sinew/contact_source.hpp"
#include "sinew/export.h"
#include "sinew/status.hpp"

class btCollisionWorld;
class btCollisionObject;

namespace sinew {

struct BulletDef {
  btCollisionWorld* world = nullptr;  // outlives what is made of it; null: refused
  double origin_m[3] = {0, 0, 0};     // where Bullet's origin is in Sinew's world; finite
  // As of a body's broadphase proxy; both sides have to agree.
  int32_t group = 1;
  int32_t mask = -1;
  // Asked for each probe and body that may touch; null: all of them. Must not throw, allocate or change
  // anything.
  bool (*accepts)(void* context, uint32_t owner, const btCollisionObject& body) = nullptr;
  void* context = nullptr;
  // Of the probes; a pair's is the product with the body's own, as Bullet has it.
  float friction = 1;     // 0 or more, finite
  float restitution = 0;  // 0 to 1
  // Bodies are looked for this far around. A faster one may be missed: counted where it is seen. Finite, 0 or
  // more.
  float fastest_body_m_s = 60;
  // Dynamic bodies that can be pushed in a tick, at most 65536; what is pushed beyond is dropped and counted.
  // 0: nothing pushes them.
  uint32_t push_capacity = 0;
};

// Why a body or a triangle was left out.
enum class BulletProblem : uint32_t {
  kZeroVolume = 0,
  // A transform or velocity. That of a compound's child, of the first 1,024 with those of children: that
  // child alone is left out. Friction or restitution: the body stays, with 0. What was added with a place
  // that is not finite, whatever its filter, may hide others in Bullet's broadphase until it is found: each
  // call looks at 16 bodies, in turn; from then on bodies are asked one by one, until it is mended or taken
  // out.
  kNotFinite,
  kDegenerateTriangle,  // without area, or not finite
  kUnsupportedShape,    // soft bodies, signed distance fields, GImpact and custom concave shapes
  kTooFast,             // faster than fastest_body_m_s; not left out
  kTooMany,             // more than 64 bodies near 16 probes: the last ones
  kCount
};

// Since creation.
struct BulletReport {
  uint64_t counts[static_cast<uint32_t>(BulletProblem::kCount)] = {};  // each time one was met
  uint32_t named = 0;  // kinds of problem by body, the first 32: see BulletContacts::problem
  uint64_t pushes_dropped =
      0;  // no room, no number, larger than 1e6 N s, or a body that is not there any more
};

class SINEW_API BulletContacts final : public ContactSource {
 public:
  BulletContacts() noexcept = default;  // finds nothing until create
  ~BulletContacts() override;
  BulletContacts(BulletContacts&& other) noexcept;
  BulletContacts& operator=(BulletContacts&& other) noexcept;

  // One allocation. Refused: no world, a number outside its range, no memory; `out` is then untouched.
  static Status create(const BulletDef& def, BulletContacts* out) noexcept;

  // Where Bullet's origin is from now on, for engines that move it. Refused: not finite; the last one holds.
  // One thread, no find or push meanwhile.
  Status set_origin(const double (&origin_m)[3]) noexcept;

  // A probe with a number that is not finite or a negative radius finds nothing. A segment that lies flat has
  // a contact at both ends of where it does. Where a probe begins at the end of the one before (same owner,
  // not thicker), what that one was told there of a body, as deep, is not told again. hits are in no order.
  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override;

  // Adds up; a body that is not dynamic ignores it.
  void push(const ContactHit& hit, const double (&point_m)[3],
            const float (&impulse_n_s)[3]) noexcept override;
  // Gives bodies what was pushed since the last call, and wakes them; returns how many. Sums do not depend on
  // the order of pushes. One thread.
  uint32_t apply_impulses() noexcept;

  BulletReport report() const noexcept;
  // One line on the index-th named problem: which body, what, how to mend; ok for an index that is not there.
  Status problem(uint32_t index) const noexcept;

 private:
  struct State;
  State* state_ = nullptr;
};

}  // namespace sinew

// contact_source.hpp  The door for an engine's own collision detection: who it is asked, what it answers.
//
// Rods and tissue ask several times a tick, with capsules on their way through it; an implementation answers
// with contacts as half-spaces, and is told afterwards what rods pushed against it; soft parts may ask again
// after that. They push nothing, and feel neither friction nor restitution. sinew::bullet and sinew::embree
// are such implementations; a scene of a few planes, spheres and capsules needs none
// (rods/contacts/collider.hpp).
//
// An obstacle's pose is that at the tick's end, and its velocity is what brought it there (as in
// rods/contacts/obstacle.hpp): a tick earlier it was where its velocity came from.
// All ticks of a step see the pose that the engine has then: where obstacles are fast, step at the tick rate.
//
// Thread rule: a world steps instances on its workers, so find and push come from several threads at a time,
// each with probes of its own. Nothing may throw, allocate or block in them.
#pragma once
#include <cstdint>
#include <span>

#include "sinew/export.h"

namespace sinew {

// A capsule on its way through a tick, its axis' ends going straight. In the world, metres.
struct ContactProbe {
  double start_m[2][3] = {};  // the axis' ends where the tick begins; twice the same point: a sphere
  double end_m[2][3] = {};    // where they would go if nothing were in the way
  float radius_m = 0;         // 0 or more
  uint32_t owner = 0;         // whose it is, as the caller set it up: for filters
};

// One contact of a probe: its capsule against the half-space {x : normal . (x - surface point) <= 0}, which
// moves with the obstacle. What a probe passes through within the tick is a contact too: normal is then that
// of the first touch, and gap_m still counts from the tick's start.
struct ContactHit {
  uint32_t probe = 0;                 // index among those asked; an index that is not there: ignored
  float along = 0;                    // -1 at the axis' first end, 1 at its second
  double gap_m = 0;                   // between the surfaces at the tick's start; negative: penetration
  float normal[3] = {0, 1, 0};        // unit vector, from the obstacle to the probe
  float velocity_m_s[3] = {0, 0, 0};  // of the obstacle's surface there
  float friction = 0.5f;              // Coulomb's coefficient of the pair, 0 or more
  float restitution = 0;              // of the pair, 0 to 1
  uint32_t name = 0;                  // of the probe's contacts; the same in the next tick: the same contact
  uint64_t body = 0;                  // the source's own; handed back to push
};
// A hit with a NaN, an infinity, a normal that is not a unit vector or a number out of its range is left out
// and counted by the asker.

class SINEW_API ContactSource {
 public:
  virtual ~ContactSource() = default;
  // Contacts of the probes, at least all whose gap may close within dt_s. Returns how many there are; only
  // the first hits.size() are written, so a larger number says how many were dropped: deepest first.
  virtual uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                        std::span<ContactHit> hits) noexcept = 0;
  // After the tick: what the contact did to the obstacle, at a point in the world. Not called where it is
  // zero.
  virtual void push(const ContactHit& hit, const double (&point_m)[3],
                    const float (&impulse_n_s)[3]) noexcept {
    (void)hit, (void)point_m, (void)impulse_n_s;
  }
};

}  // namespace sinew

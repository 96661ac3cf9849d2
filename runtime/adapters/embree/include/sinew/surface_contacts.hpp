// surface_contacts.hpp  Contacts with deforming triangle meshes: a character's own skin, other characters.
// Of the optional target sinew::embree.
//
//   sinew::SurfaceContacts surfaces;
//   sinew::Status status = sinew::SurfaceContacts::create({}, &surfaces);
//   sinew::SurfaceId skin;
//   status = surfaces.add_surface({.triangles = indices, .rest_m = bind_positions}, &skin);
//   for (;;) {
//     status = surfaces.move_surface(skin, {.places_m = posed_positions, .dt_s = 1.0f / 60});
//     // ... whoever has probes asks find()
//   }
//
// A probe touches the surface at its ends, where its axis comes nearest and, where the surface bulges between
// these, in its middle; each of them in a valley on both sides, but for a ball or a line. A chain of probes
// is touched along all of its length. What begins outside is swept against triangles on their way through the
// tick. Within reach_m of the surface, inside is told by the angle-weighted pseudonormal of the nearest face,
// edge or vertex (Baerentzen, Aanaes 2005), and the way out is the shortest; along a chain that has begun
// outside a closed surface it is asked again where the chain goes through. Deeper, nothing is found. At a
// border and where more than two triangles share an edge everything counts as outside.
//
// Thread rule: find from any number of threads at a time while no function that is not const runs; the others
// one thread at a time. find and move_surface do not throw and allocate nothing.
#pragma once
#include <array>

#include "sinew/contact_source.hpp"
#include "sinew/export.h"
#include "sinew/status.hpp"

namespace sinew {

struct SurfaceId {
  uint32_t index1 = 0;      // slot + 1; 0: null
  uint32_t generation = 0;  // counts re-uses of the slot
  friend bool operator==(SurfaceId, SurfaceId) = default;
};

struct SurfaceContactsDef {
  uint32_t max_surfaces = 16;   // 1..65535; one more is refused
  uint32_t max_owners = 65536;  // filters, 0..2^24; owners from there on have none
  float reach_m = 0.05f;        // above 0, finite: how deep inside still counts as inside
};

struct SurfaceDef {
  // Three vertices each, counter-clockwise as seen from outside. At most 2^26. Those without area at rest are
  // skipped and counted; none with area: refused. An index that is not there: refused.
  std::span<const uint32_t> triangles = {};
  // x y z of each vertex at rest, finite: where the surface stands until it is moved. Vertices at the same
  // place are one. A closed surface whose triangles are turned inside out is refused.
  std::span<const float> rest_m = {};
  // A set of bits for each triangle, for filters; empty: all bits.
  std::span<const uint32_t> groups = {};
  float friction = 0.5f;   // 0 or more, finite
  float restitution = 0;   // 0..1
  bool two_sided = false;  // cloth, leaves: nothing is inside
};

enum class SurfaceTime : uint32_t {
  kTickEnd = 0,    // where it will be when the coming tick ends; it begins where the last call left it
  kTickStart = 1,  // where it is when the coming tick begins; it goes on as it came from the last call's
};

struct SurfacePose {
  // x y z of each vertex, relative to origin_m; finite, within +-1e6, else refused, and the surface is where
  // it was and moves as it did.
  std::span<const float> places_m = {};
  double origin_m[3] = {0, 0, 0};  // in the world; finite. The nearer to the surface the better
  // 0 to 1 s between the last call's places and these; 0: the surface is put there and does not move.
  float dt_s = 0;
  SurfaceTime time = SurfaceTime::kTickEnd;
};

// Where an owner's hair or tail grows out of a surface: nothing pushes it from within radius_m of there.
struct SurfaceRoot {
  SurfaceId surface = {};        // null: no such place; stale: refused
  float place_m[3] = {0, 0, 0};  // of the surface at rest; finite
  float radius_m = 0;            // 0 or more, finite
};

// Of an owner's probes.
struct SurfaceFilter {
  static constexpr uint32_t kMostRoots = 8;
  uint32_t groups = ~0u;  // triangles with none of these bits are as if they were not there
  std::array<SurfaceRoot, kMostRoots> roots = {};  // those of a null surface are none
};

struct SurfaceReport {
  uint32_t triangles = 0;          // that collide
  uint32_t triangles_skipped = 0;  // without area at rest
  uint32_t border_edges = 0;       // of one triangle, or of more than two, or of two that disagree
  uint32_t poses_refused = 0;
  uint64_t bytes = 0;
};

class SINEW_API SurfaceContacts final : public ContactSource {
 public:
  SurfaceContacts() noexcept = default;  // empty: finds nothing, refuses the rest
  ~SurfaceContacts() override;
  SurfaceContacts(SurfaceContacts&& other) noexcept;
  SurfaceContacts& operator=(SurfaceContacts&& other) noexcept;

  // Refused: fields outside their range; no memory: kOutOfCapacity; `out` is then untouched.
  static Status create(const SurfaceContactsDef& def, SurfaceContacts* out) noexcept;

  // Allocates, and builds the tree. Refused as the fields say; max_surfaces are there, or no memory:
  // kOutOfCapacity.
  Status add_surface(const SurfaceDef& def, SurfaceId* out) noexcept;
  Status remove_surface(SurfaceId surface) noexcept;
  // O(vertices + triangles); where nothing moves, before and now, O(vertices).
  Status move_surface(SurfaceId surface, const SurfacePose& pose) noexcept;
  // Refused: an owner from max_owners on, numbers out of range, a root's surface that is not there. A root
  // whose surface was removed does nothing.
  Status set_filter(uint32_t owner, const SurfaceFilter& filter) noexcept;
  Status report(SurfaceId surface, SurfaceReport* out) const noexcept;

  // A probe with a NaN, an infinity, a negative radius, or more than 1e15 m from the origin or long, is
  // skipped and counted. body is the surface's index1
  // in the upper half and the triangle's index in the lower. A dt_s beyond the last pose's counts as that; a
  // shorter one sees the first part of the surface's way. Where a probe begins at the end of the one before
  // it and has the same owner, a chain's joint, its beginning is not told again. A probe touches at most
  // eight surfaces.
  uint32_t find(std::span<const ContactProbe> probes, float dt_s,
                std::span<ContactHit> hits) noexcept override;
  uint64_t probes_skipped() const noexcept;

 private:
  struct Impl;
  Impl* impl_ = nullptr;
};

}  // namespace sinew

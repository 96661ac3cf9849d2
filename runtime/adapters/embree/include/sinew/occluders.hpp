// occluders.hpp  What hides characters: walls, houses, hills, as coarse meshes. Of the optional target
// sinew::embree.
//
//   sinew::Occluders occluders;
//   sinew::Status status = sinew::Occluders::create({}, &occluders);
//   sinew::OccluderId wall;
//   status = occluders.add({.triangles = indices, .places_m = places}, &wall);
//   occluders.update();
//   status = sinew::World::create({.occlusion = &occluders}, &world);
//
// A mesh that is larger than what it stands for hides what could be seen: give one that lies inside.
//
// Thread rule: is_blocked from any number of threads at a time while no other function runs; it allocates
// nothing and costs some microseconds at most. The others one thread at a time, and may allocate.
#pragma once
#include <span>

#include "sinew/export.h"
#include "sinew/types.hpp"
#include "sinew/view.hpp"

namespace sinew {

struct OccluderId {
  uint32_t index1 = 0;      // slot + 1; 0: null
  uint32_t generation = 0;  // counts re-uses of the slot
  friend bool operator==(OccluderId, OccluderId) = default;
};

struct OccludersDef {
  uint32_t max_occluders = 1024;  // 1..65535; one more is refused
  double origin_m[3] = {0, 0,
                        0};  // finite; rays are in float from here, so the nearer to the scene the better
};

struct OccluderDef {
  std::span<const uint32_t> triangles =
      {};  // three vertices each, 1 to 2^26; an index that is not there: refused
  std::span<const float> places_m = {};  // x y z of each vertex; finite, within +-1e6, else refused
  RootTransform root = {};               // world from these places; refused as in a pose
};

class SINEW_API Occluders final : public OcclusionSource {
 public:
  Occluders() noexcept = default;  // empty: hides nothing, refuses the rest
  ~Occluders() override;
  Occluders(Occluders&& other) noexcept;
  Occluders& operator=(Occluders&& other) noexcept;

  // Refused: fields outside their range; no memory: kOutOfCapacity; no Embree: kUnsupported; `out` is then
  // untouched.
  static Status create(const OccludersDef& def, Occluders* out) noexcept;

  // Builds the mesh's tree. Refused as the fields say; max_occluders are there, or no memory: kOutOfCapacity.
  Status add(const OccluderDef& def, OccluderId* out) noexcept;
  Status move(OccluderId occluder, const RootTransform& root) noexcept;
  Status remove(OccluderId occluder) noexcept;
  // To be called after add, move and remove, before the next step: until then nothing is hidden,
  // and where there was no memory, until it is called again. O(occluders).
  void update() noexcept;

  // False for places that are not finite.
  bool is_blocked(const double (&from_m)[3], const double (&to_m)[3]) noexcept override;

 private:
  struct Impl;
  Impl* impl_ = nullptr;
};

}  // namespace sinew

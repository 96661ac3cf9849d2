// surface_contacts.cpp  The public class: surfaces by id, filters by owner, hits by probe.
#include "sinew/surface_contacts.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <new>
#include <utility>

#include "adapters/embree/probe_on_surface.hpp"
#include "adapters/embree/with_memory.hpp"
#include "core/slot_table.hpp"
#include "core/status.hpp"

namespace sinew {

using core::make_status;
using embree::ProbeOnSurface;
using embree::Surface;
using embree::with_memory;

struct SurfaceContacts::Impl {
  SurfaceContactsDef def;
  core::SlotTable<std::unique_ptr<Surface>, SurfaceId> surfaces;
  std::vector<SurfaceFilter> filters;  // [max_owners]
  SurfaceFilter all;
  std::atomic<uint64_t> skipped{0};

  Surface* find(SurfaceId id) const {
    std::unique_ptr<Surface>* found = surfaces.find(id);
    return found ? found->get() : nullptr;
  }
  // Of one probe; one near more than eight surfaces at a time touches the first eight.
  static constexpr uint32_t kMostHits = 8 * ProbeOnSurface::kMostContacts;
  // What is kept from one probe to the next.
  struct Room {
    ContactHit hits[kMostHits], found[ProbeOnSurface::kMostContacts];
    // Of the surfaces asked last, by their slots' last digits.
    struct Known {
      uint32_t surface = 0, probe = ~0u;  // of whom it is known
      uint32_t nearest = 0;               // a triangle: of a chain's next probe another is not far
      bool outside = false;
    };
    static constexpr uint32_t kKnown = 8;
    Known known[kKnown];
  };
  uint32_t find(std::span<const ContactProbe> probes, uint32_t p, double dt_s, Room* room) const noexcept;
  const SurfaceFilter& filter_of(uint32_t owner) const {
    return owner < filters.size() ? filters[owner] : all;
  }
  Status check(const SurfaceRoot& root, uint32_t owner) const;
  // A bit for each root.
  uint32_t roots_on(SurfaceId surface, const SurfaceFilter& filter) const;
};

namespace {

constexpr uint32_t kMostSurfaces = 65535, kMostOwners = 1u << 24;

Status stale() {
  return make_status(StatusCode::kStaleId, "no such surface; give the id that add_surface gave");
}
Status empty() {
  return make_status(StatusCode::kInvalidArgument, "these surface contacts are empty; call create first");
}

Status check(const SurfaceContactsDef& def) {
  if (def.max_surfaces < 1 || def.max_surfaces > kMostSurfaces) {
    return make_status(StatusCode::kInvalidArgument, "max_surfaces is %u; give 1 to %u", def.max_surfaces,
                       kMostSurfaces);
  }
  if (def.max_owners > kMostOwners) {
    return make_status(StatusCode::kInvalidArgument, "max_owners is %u; give at most %u", def.max_owners,
                       kMostOwners);
  }
  if (def.reach_m > 0 && std::isfinite(def.reach_m)) return {};
  return make_status(StatusCode::kInvalidArgument, "reach_m is %g; give a finite number above 0",
                     static_cast<double>(def.reach_m));
}

double square_between(const double (&a)[3], const double (&b)[3]) {
  double square = 0;
  for (size_t k = 0; k < 3; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return square;
}

// Whether a probe goes on where the one before it ends, as segments of a chain do: at a joint one contact is
// enough, two would share its force. A point goes nowhere: twins at a seam are each their own.
bool goes_on(const ContactProbe& before, const ContactProbe& probe) {
  constexpr double kAtOnePlace = 0.1;  // of the radius
  const double near_m = kAtOnePlace * static_cast<double>(probe.radius_m);
  return before.owner == probe.owner &&
         square_between(probe.start_m[0], before.start_m[1]) <= near_m * near_m &&
         square_between(probe.start_m[0], probe.start_m[1]) > near_m * near_m;
}

// Beyond it, squares of distances are no floats.
constexpr double kFarthestProbe_m = 1e15;

bool usable(const ContactProbe& probe) {
  double sum = static_cast<double>(probe.radius_m);
  for (size_t end = 0; end < 2; ++end) {
    for (size_t k = 0; k < 3; ++k) sum += std::fabs(probe.start_m[end][k]) + std::fabs(probe.end_m[end][k]);
  }
  return probe.radius_m >= 0 && sum <= kFarthestProbe_m;
}

// Keeps the deepest of more than there is room for; the shallowest of those kept is first then.
class Collected {
 public:
  explicit Collected(std::span<ContactHit> room) : room_(room) {}
  void add(const ContactHit& hit) {
    if (count_ < room_.size()) {
      room_[count_++] = hit;
      return;
    }
    if (count_++ == room_.size()) std::make_heap(room_.begin(), room_.end(), deeper);
    if (room_.empty() || !deeper(hit, room_.front())) return;
    std::pop_heap(room_.begin(), room_.end(), deeper);
    room_.back() = hit;
    std::push_heap(room_.begin(), room_.end(), deeper);
  }
  uint32_t count() const { return count_; }

 private:
  static bool deeper(const ContactHit& a, const ContactHit& b) { return a.gap_m < b.gap_m; }
  std::span<ContactHit> room_;
  uint32_t count_ = 0;
};

}  // namespace

SurfaceContacts::~SurfaceContacts() { delete impl_; }
SurfaceContacts::SurfaceContacts(SurfaceContacts&& other) noexcept
    : impl_(std::exchange(other.impl_, nullptr)) {}
SurfaceContacts& SurfaceContacts::operator=(SurfaceContacts&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

Status SurfaceContacts::create(const SurfaceContactsDef& def, SurfaceContacts* out) noexcept {
  if (!out) return make_status(StatusCode::kInvalidArgument, "out is null; give where the contacts go");
  Status status = check(def);
  if (!status.ok()) return status;
  SurfaceContacts made;
  made.impl_ = new (std::nothrow) Impl;
  if (!made.impl_ || !made.impl_->surfaces.reserve(def.max_surfaces)) {
    return make_status(StatusCode::kOutOfCapacity, "no memory for %u surfaces", def.max_surfaces);
  }
  made.impl_->def = def;
  status = with_memory("the owners' filters; give a smaller max_owners", [&]() -> Status {
    made.impl_->filters.resize(def.max_owners);
    return {};
  });
  if (status.ok()) *out = std::move(made);
  return status;
}

Status SurfaceContacts::add_surface(const SurfaceDef& def, SurfaceId* out) noexcept {
  if (!impl_) return empty();
  if (!out) return make_status(StatusCode::kInvalidArgument, "out is null; give where the id goes");
  if (impl_->surfaces.count() == impl_->surfaces.capacity()) {
    return make_status(StatusCode::kOutOfCapacity, "%u surfaces are there; raise max_surfaces",
                       impl_->surfaces.count());
  }
  std::unique_ptr<Surface> made;
  const Status status = with_memory("a surface and its tree", [&] { return Surface::create(def, &made); });
  if (status.ok()) *out = impl_->surfaces.create(std::move(made));
  return status;
}

Status SurfaceContacts::remove_surface(SurfaceId surface) noexcept {
  if (!impl_) return empty();
  if (!impl_->find(surface)) return stale();
  impl_->surfaces.destroy(surface);
  return {};
}

Status SurfaceContacts::move_surface(SurfaceId surface, const SurfacePose& pose) noexcept {
  if (!impl_) return empty();
  Surface* found = impl_->find(surface);
  return found ? found->move(pose) : stale();
}

Status SurfaceContacts::set_filter(uint32_t owner, const SurfaceFilter& filter) noexcept {
  if (!impl_) return empty();
  if (owner >= impl_->filters.size()) {
    return make_status(StatusCode::kInvalidArgument, "owner %u of %zu; raise max_owners", owner,
                       impl_->filters.size());
  }
  for (const SurfaceRoot& root : filter.roots)
    if (Status status = impl_->check(root, owner); !status.ok()) return status;
  impl_->filters[owner] = filter;
  return {};
}

Status SurfaceContacts::report(SurfaceId surface, SurfaceReport* out) const noexcept {
  if (!impl_) return empty();
  if (!out) return make_status(StatusCode::kInvalidArgument, "out is null; give where the report goes");
  const Surface* found = impl_->find(surface);
  if (!found) return stale();
  *out = found->report();
  return {};
}

uint64_t SurfaceContacts::probes_skipped() const noexcept { return impl_ ? impl_->skipped.load() : 0; }

Status SurfaceContacts::Impl::check(const SurfaceRoot& root, uint32_t owner) const {
  if (root.surface.index1 != 0 && !find(root.surface)) return stale();
  const float sum = root.place_m[0] + root.place_m[1] + root.place_m[2] + root.radius_m;
  if (root.radius_m >= 0 && std::isfinite(sum)) return {};
  return make_status(
      StatusCode::kInvalidArgument,
      "a root of owner %u is not finite, or its radius %g; give finite numbers and a radius of 0 "
      "or more",
      owner, static_cast<double>(root.radius_m));
}

uint32_t SurfaceContacts::Impl::roots_on(SurfaceId surface, const SurfaceFilter& filter) const {
  uint32_t bits = 0;
  for (uint32_t r = 0; r < SurfaceFilter::kMostRoots; ++r)
    bits |= uint32_t{filter.roots[r].surface == surface} << r;
  return bits;
}

uint32_t SurfaceContacts::Impl::find(std::span<const ContactProbe> probes, uint32_t p, double dt_s,
                                     Room* room) const noexcept {
  const SurfaceFilter& filter = filter_of(probes[p].owner);
  const bool goes_on_here = p > 0 && goes_on(probes[p - 1], probes[p]);
  uint32_t count = 0;
  for (uint32_t s = 0; s < surfaces.end() && count + ProbeOnSurface::kMostContacts <= kMostHits; ++s) {
    const std::unique_ptr<Surface>* surface = surfaces.at(s);
    if (!surface) continue;
    const uint32_t roots = roots_on(surfaces.id_at(s), filter);
    Room::Known& known = room->known[s % Room::kKnown];
    const bool from_outside = goes_on_here && known.surface == s && known.probe + 1 == p && known.outside;
    ProbeOnSurface look(**surface, probes[p], filter, roots, static_cast<double>(def.reach_m), dt_s,
                        known.nearest, from_outside);
    const uint32_t told = look.find(room->found);
    known = {s, p, look.nearest(), look.is_outside()};
    for (const ContactHit& hit : std::span(room->found).first(told)) {
      if (goes_on_here && hit.along == -1) continue;  // told where the probe before ends
      ContactHit& to = room->hits[count++] = hit;
      to.probe = p, to.name += ProbeOnSurface::kMostContacts * s, to.body |= uint64_t{s + 1} << 32;
    }
  }
  return count;
}

uint32_t SurfaceContacts::find(std::span<const ContactProbe> probes, float dt_s,
                               std::span<ContactHit> hits) noexcept {
  if (!impl_ || !(dt_s >= 0)) return 0;
  Collected collected(hits);
  Impl::Room room;
  for (uint32_t p = 0; p < probes.size(); ++p) {
    if (!usable(probes[p])) {
      ++impl_->skipped;
      continue;
    }
    const uint32_t count = impl_->find(probes, p, static_cast<double>(dt_s), &room);
    for (uint32_t i = 0; i < count; ++i) collected.add(room.hits[i]);
  }
  return collected.count();
}

}  // namespace sinew

// collider.cpp  Makes a collider's memory, takes obstacles in, and carries forces from step to step.
#include "rods/contacts/collider.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/arena.hpp"
#include "core/status.hpp"
#include "rods/contacts/find/find_contacts.hpp"
#include "rods/contacts/solve/contact_forces.hpp"
#include "rods/rod_batch.hpp"

namespace sinew::rods {
namespace {

constexpr uint32_t kMostContacts = 1u << 24, kMostObstacles = 65536, kLeastContacts = 64;
// A strand that is held bends a little on the way there: it is looked at again.
constexpr int kMostHolds = 4;
// Stepped together where rods do not collide, for strands that go on to be packed: more save few iterations
// and leave the processor's nearer cache.
constexpr uint32_t kGroupsAtOnce = 8;

Status bad_setting(const char* name, double value, const char* range) {
  return core::make_status(StatusCode::kInvalidArgument, "ColliderSettings::%s is %g; give %s", name, value,
                           range);
}

Status check_settings(const ColliderSettings& s) {
  if (!(s.rod_friction >= 0 && std::isfinite(s.rod_friction))) {
    return bad_setting("rod_friction", static_cast<double>(s.rod_friction), "a finite number, 0 or more");
  }
  if (!(s.tolerance >= 1e-4f && s.tolerance <= 1)) {
    return bad_setting("tolerance", static_cast<double>(s.tolerance), "1e-4 to 1");
  }
  if (!(s.largest_push_out_m_s > 0 && std::isfinite(s.largest_push_out_m_s))) {
    return bad_setting("largest_push_out_m_s", static_cast<double>(s.largest_push_out_m_s),
                       "a finite number above 0");
  }
  if (s.contact_capacity > kMostContacts) {
    return bad_setting("contact_capacity", s.contact_capacity, "at most 2^24");
  }
  if (s.obstacle_capacity > kMostObstacles) {
    return bad_setting("obstacle_capacity", s.obstacle_capacity, "at most 65536");
  }
  if (s.point_capacity > kMostContacts) {
    return bad_setting("point_capacity", s.point_capacity, "at most 2^24");
  }
  if (s.source_capacity > kMostContacts) {
    return bad_setting("source_capacity", s.source_capacity, "at most 2^24");
  }
  return {};
}

}  // namespace

// Lays one collider out; a friend, so that the class shows only what a user calls.
struct ColliderBuilder {
  RodCollider& to;
  const RodBatch& batch;

  uint32_t groups() const { return (batch.strand_count_ + batch.width_ - 1) / batch.width_; }

  void set_sizes() {
    to.strand_count_ = batch.strand_count_;
    to.segment_count_ = batch.segment_count_;
    to.width_ = batch.width_;
    const uint64_t four_each = uint64_t{4} * batch.strand_count_ * batch.segment_count_;
    const auto by_default =
        static_cast<uint32_t>(std::clamp<uint64_t>(four_each, kLeastContacts, kMostContacts));
    to.capacity_ = to.settings_.contact_capacity ? to.settings_.contact_capacity : by_default;
    const bool all = to.settings_.rods_collide, packs = !batch.settings_.solver.iterate;
    to.places_.home_groups = all ? groups() : std::min(groups(), kGroupsAtOnce);
    to.places_.packed_groups = all || !packs || to.width_ != 16 ? 0 : to.places_.home_groups / 2;
  }

  void lay_out(std::byte* base, size_t* bytes) {
    core::Arena arena(base);
    const uint32_t home = to.places_.home_groups, places = home + to.places_.packed_groups;
    const size_t segments = size_t{home} * to.width_ * to.segment_count_;
    const size_t placed = size_t{places} * to.width_ * to.segment_count_;
    to.obstacles_.planes = arena.take<Plane>(to.settings_.obstacle_capacity);
    to.obstacles_.spheres = arena.take<Sphere>(to.settings_.obstacle_capacity);
    to.obstacles_.capsules = arena.take<Capsule>(to.settings_.obstacle_capacity);
    to.obstacles_.passed = arena.take<uint64_t>(size_t{to.strand_count_} * to.segment_count_);
    to.obstacles_.points = arena.take<ContactPoint>(to.settings_.point_capacity);
    to.found_.contacts = arena.take<Contact>(to.capacity_);
    to.kept_forces_.kept = arena.take<KeptForce>(to.capacity_);
    to.kept_forces_.new_kept = arena.take<KeptForce>(to.capacity_);
    to.kept_forces_.kept_places = arena.take<uint32_t>(std::bit_ceil(2 * to.capacity_));
    to.near_by_.sweeps = arena.take<Sweep>(segments);
    to.near_by_.boxes = arena.take<SweptBox>(segments);
    to.near_by_.swept = arena.take<uint8_t>(segments);
    to.near_by_.reaches = arena.take<float>(segments * simd::kReachRows);
    to.near_by_.reach_boxes = arena.take<float>(size_t{home} * simd::kBoxRows * to.width_);
    to.near_by_.lengths_m = arena.take<float>(size_t{home} * to.width_);
    to.near_by_.origins_m = arena.take<double>(size_t{home} * 3 * to.width_);
    to.near_by_.near_lanes = arena.take<uint16_t>(to.segment_count_);
    to.forces_on_.rows = arena.take<float>(placed * simd::kRodContactRows);
    to.forces_on_.touched = arena.take<uint8_t>(size_t{places} * to.segment_count_);
    to.forces_on_.touched_list = arena.take<uint32_t>(size_t{places} * to.segment_count_);
    to.progress_.turning = arena.take<uint8_t>(to.strand_count_);
    to.progress_.pending = arena.take<uint8_t>(to.strand_count_);
    to.progress_.misses = arena.take<double>(to.strand_count_);
    to.progress_.presses = arena.take<double>(to.strand_count_);
    to.progress_.moves_m = arena.take<double>(to.strand_count_);
    to.progress_.passed_m = arena.take<double>(to.strand_count_);
    to.progress_.clear_m = arena.take<double>(to.strand_count_);
    to.progress_.ways = arena.take<double>(to.strand_count_);
    to.progress_.carries = arena.take<Vector>(to.strand_count_);
    to.progress_.near = arena.take<uint8_t>(to.strand_count_);
    to.progress_.iterated = arena.take<uint8_t>(to.strand_count_);
    to.progress_.moved = arena.take<uint8_t>(to.strand_count_);
    to.places_.scratch = arena.take<float>(placed * simd::kRodScratchRows);
    to.places_.ranges = arena.take<GroupRange>(home);
    to.places_.homes = arena.take<uint32_t>(home);
    to.places_.seats = arena.take<uint32_t>(to.strand_count_);
    to.going_.strands = arena.take<uint32_t>(size_t{home} * to.width_);
    to.going_.contacts = arena.take<uint32_t>(to.capacity_);
    to.places_.packed_records = arena.take<float>((placed - segments) * simd::kRodKeptFields);
    to.places_.packed_lanes =
        arena.take<float>(size_t{to.places_.packed_groups} * simd::kLaneFields * to.width_);
    if (to.settings_.rods_collide) to.near_by_.hash.lay_out(&arena, static_cast<uint32_t>(segments));
    if (to.settings_.source_capacity > 0) {
      to.asked_.probes = arena.take<ContactProbe>(segments);
      to.asked_.probe_segments = arena.take<uint32_t>(segments);
      to.asked_.hits = arena.take<ContactHit>(size_t{2} * to.settings_.source_capacity);
      to.asked_.taken = arena.take<TakenHit>(to.settings_.source_capacity);
      to.asked_.pushes = arena.take<double>(to.strand_count_);
      to.asked_.hit_ways = arena.take<double>(to.strand_count_);
      to.asked_.cores_m = arena.take<double>(segments);
    }
    *bytes = arena.used_bytes();
  }
};

Status RodCollider::create(const RodBatch& batch, const ColliderSettings& settings,
                           RodCollider* out) noexcept {
  const Status status = check_settings(settings);
  if (!status.ok()) return status;
  if (batch.strand_count() == 0) {
    return core::make_status(StatusCode::kInvalidArgument, "the batch has no strand; create it first");
  }
  RodCollider made;
  made.settings_ = settings;
  ColliderBuilder builder{made, batch};
  builder.set_sizes();
  size_t bytes = 0;
  builder.lay_out(nullptr, &bytes);
  made.memory_ = core::AlignedBlock(bytes);
  if (!made.memory_.data()) {
    return core::make_status(StatusCode::kOutOfCapacity,
                             "no memory for %zu bytes of contacts; give a smaller contact_capacity", bytes);
  }
  builder.lay_out(made.memory_.data(), &bytes);
  *out = static_cast<RodCollider&&>(made);
  return {};
}

template <class Obstacle>
Status RodCollider::set(std::span<const Obstacle> given, uint32_t capacity, const char* what, Obstacle* to,
                        uint32_t* count) noexcept {
  if (given.size() > capacity) {
    return core::make_status(StatusCode::kOutOfCapacity,
                             "%zu %s where the collider has room for %u; create it for more", given.size(),
                             what, capacity);
  }
  for (uint32_t i = 0; i < given.size(); ++i) {
    const Status status = check_obstacle(given[i], i);
    if (!status.ok()) return status;
  }
  std::copy(given.begin(), given.end(), to);
  *count = static_cast<uint32_t>(given.size());
  return {};
}

Status RodCollider::set_planes(std::span<const Plane> planes) noexcept {
  return set(planes, settings_.obstacle_capacity, "planes", obstacles_.planes, &obstacles_.plane_count);
}
Status RodCollider::set_spheres(std::span<const Sphere> spheres) noexcept {
  return set(spheres, settings_.obstacle_capacity, "spheres", obstacles_.spheres, &obstacles_.sphere_count);
}
Status RodCollider::set_capsules(std::span<const Capsule> capsules) noexcept {
  return set(capsules, settings_.obstacle_capacity, "capsules", obstacles_.capsules,
             &obstacles_.capsule_count);
}

Status RodCollider::set_passed(uint32_t strand, uint32_t segment, uint64_t capsules) noexcept {
  if (strand >= strand_count_ || segment >= segment_count_) {
    return core::make_status(StatusCode::kInvalidArgument,
                             "strand %u, segment %u where the batch has %u strands of %u segments", strand,
                             segment, strand_count_, segment_count_);
  }
  obstacles_.passed[size_t{strand} * segment_count_ + segment] = capsules;
  obstacles_.passed_any |= capsules != 0;
  return {};
}

Status RodCollider::check_points(std::span<const ContactPoint> points) const noexcept {
  for (uint32_t i = 0; i < points.size(); ++i) {
    if (points[i].strand < strand_count_ && points[i].segment < segment_count_) continue;
    return core::make_status(StatusCode::kInvalidArgument,
                             "contact point %u: strand %u, segment %u where the batch has %u strands of %u "
                             "segments",
                             i, points[i].strand, points[i].segment, strand_count_, segment_count_);
  }
  return {};
}

Status RodCollider::set_points(std::span<const ContactPoint> points) noexcept {
  const Status status = check_points(points);
  return status.ok() ? set(points, settings_.point_capacity, "contact points", obstacles_.points,
                           &obstacles_.point_count)
                     : status;
}

Status RodCollider::set_source(ContactSource* source, uint32_t owner) noexcept {
  if (source && settings_.source_capacity == 0) {
    return core::make_status(StatusCode::kOutOfCapacity,
                             "a contact source where the collider has no room for hits; create it with a "
                             "ColliderSettings::source_capacity");
  }
  asked_.source = source, asked_.owner = owner;
  return {};
}

bool RodCollider::fits(const RodBatch& batch) const noexcept {
  return strand_count_ == batch.strand_count_ && segment_count_ == batch.segment_count_ &&
         width_ == batch.width_;
}

void RodCollider::give(simd::RodJob* job, uint32_t place) const noexcept {
  const size_t first = size_t{place} * segment_count_;
  const uint8_t* touched = forces_on_.touched + first;
  if (forces_on_.touched_count == 0 ||
      std::none_of(touched, touched + segment_count_, [](uint8_t t) { return t; })) {
    return;
  }
  job->contacts = forces_on_.rows + first * simd::kRodContactRows * width_;
  job->touched = touched;
}

void RodCollider::begin_step() noexcept {
  found_.contacts_before = kept_forces_.new_kept_count = found_.dropped = asked_.hit_count = asked_.bad_hits =
      0;
}

void RodCollider::begin_groups() noexcept {
  places_.place_count = places_.range_count = 0;
  found_.contact_count = places_.packed_count = going_.strand_count = going_.contact_count = 0;
}

void RodCollider::open_range(uint32_t first_group) noexcept {
  places_.range = {first_group,          groups_of_range(), places_.place_count, found_.contact_count,
                   found_.contact_count, asked_.hit_count,  asked_.hit_count};
  for (uint32_t k = 0; k < places_.range.groups; ++k) places_.homes[places_.place_count++] = first_group + k;
  const uint32_t first = first_group * width_, seat = places_.range.first_place * width_;
  std::iota(places_.seats + first,
            places_.seats + std::min(first + places_.range.groups * width_, strand_count_), seat);
}

void RodCollider::begin_range(const RodBatch& batch, float dt_s) noexcept {
  // Rows are of the range before.
  ContactForces{*this, batch}.clear();
  ContactFinder{*this, batch, static_cast<double>(dt_s)}.find();
  places_.range.end_contact = found_.contact_count, places_.range.end_hit = asked_.hit_count;
  places_.ranges[places_.range_count++] = places_.range;
  ContactForces{*this, batch}.begin();
  assemble(batch);
}

// Of the range that began last, which has ended.
void RodCollider::give_back(const GroupRange& range) noexcept {
  places_.place_count = range.first_place, found_.contact_count = range.first_contact;
  for (uint32_t i = range.first_hit; i < range.end_hit; ++i) asked_.taken[i].contact = kNoContact;
  --places_.range_count;
}

void RodCollider::join_ranges() noexcept {
  places_.range = places_.ranges[0];
  places_.range.groups = places_.place_count, places_.range.end_contact = found_.contact_count,
  places_.range.end_hit = asked_.hit_count;
  going_.first_strand = going_.first_contact = 0;
}

void RodCollider::assemble(const RodBatch& batch) noexcept { ContactForces{*this, batch}.assemble(); }

uint32_t RodCollider::settle(const RodBatch& batch, uint32_t left) noexcept {
  return ContactForces{*this, batch}.settle(left);
}

void RodCollider::end_range(const RodBatch& batch, const GroupRange& range, float dt_s,
                            RodReport* report) noexcept {
  places_.range = range;
  const ContactFinder finder{*this, batch, static_cast<double>(dt_s)};
  const ContactForces forces{*this, batch};
  forces.forgive();
  const uint32_t first = places_.range.first_group * width_;
  std::fill_n(progress_.carries + first, std::min(places_.range.groups * width_, strand_count_ - first),
              Vector{});
  for (int k = 0; k < kMostHolds && finder.find_holds(k > 0); ++k) forces.hold();
  forces.place_hits();
  report->contacts_unconverged += forces.end();
  end_contacts(dt_s, report);
  if (batch.settings_.report_residual) {
    report->residual = std::max(report->residual, static_cast<float>(forces.miss()));
  }
}

const KeptForce* RodCollider::find_kept(uint64_t name) noexcept {
  if (kept_forces_.kept_next < kept_forces_.kept_count &&
      kept_forces_.kept[kept_forces_.kept_next].name == name)
    return &kept_forces_.kept[kept_forces_.kept_next++];
  const uint32_t last = kept_forces_.kept_in_use - 1;
  for (size_t at = name >> 20 & last; kept_forces_.kept_places[at] != 0; at = (at + 1) & last) {
    const KeptForce& kept = kept_forces_.kept[kept_forces_.kept_places[at] - 1];
    if (kept.name != name) continue;
    kept_forces_.kept_next = kept_forces_.kept_places[at];
    return &kept;
  }
  return nullptr;
}

// Of several of a name the last.
void RodCollider::keep(const KeptForce& kept) noexcept {
  const uint32_t last = kept_forces_.kept_in_use - 1;
  size_t at = kept.name >> 20 & last;
  while (kept_forces_.kept_places[at] != 0 &&
         kept_forces_.kept[kept_forces_.kept_places[at] - 1].name != kept.name)
    at = (at + 1) & last;
  if (kept_forces_.kept_places[at] == 0) kept_forces_.kept_places[at] = ++kept_forces_.kept_count;
  kept_forces_.kept[kept_forces_.kept_places[at] - 1] = kept;
}

void RodCollider::keep_nothing(uint32_t room_for) noexcept {
  kept_forces_.kept_count = kept_forces_.kept_next = 0;
  kept_forces_.kept_in_use = std::bit_ceil(2 * std::max(room_for, 1u));
  if (capacity_ > 0) std::fill_n(kept_forces_.kept_places, kept_forces_.kept_in_use, 0u);
}

KeptForce RodCollider::kept_of(const Contact& c, double per_square) {
  const ForceInNewtons force = {per_square * c.force, scaled(per_square, c.drag)};
  if (!(c.last.press > 0)) return {c.name, force, {}};
  return {c.name, force, {force.press - c.last.press, difference(force.drag, c.last.drag)}};
}

// Forces are what the next step's contacts of the same names start with; not those of strands that did not
// converge.
void RodCollider::keep_force(const Contact& c, double per_square) noexcept {
  const bool lost = progress_.turning[c.sides[0].strand] ||
                    (c.sides[1].segment != kNoSegment && progress_.turning[c.sides[1].strand]);
  if (c.force > 0 && !lost) kept_forces_.new_kept[kept_forces_.new_kept_count++] = kept_of(c, per_square);
}

void RodCollider::end_contacts(float dt_s, RodReport* report) noexcept {
  const double per_square = 1 / (static_cast<double>(dt_s) * static_cast<double>(dt_s));
  for (uint32_t i = places_.range.first_contact; i < places_.range.end_contact; ++i) {
    const Contact& c = found_.contacts[i];
    const double deep = -(c.open_m + c.allowed_m) / c.scale_m;
    report->deepest_penetration = std::max(report->deepest_penetration, static_cast<float>(deep));
    keep_force(c, per_square);
  }
  found_.contacts_before += places_.range.end_contact - places_.range.first_contact;
}

void RodCollider::end_step(float dt_s, RodReport* report) noexcept {
  push(dt_s);
  keep_nothing(kept_forces_.new_kept_count);
  for (uint32_t i = 0; i < kept_forces_.new_kept_count; ++i) keep(kept_forces_.new_kept[i]);
  report->contacts = found_.contacts_before;
  report->contacts_dropped = found_.dropped;
  report->bad_hits = asked_.bad_hits;
  obstacles_.point_count = 0;
}

}  // namespace sinew::rods

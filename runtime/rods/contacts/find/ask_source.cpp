// ask_source.cpp  The range's segments to a contact source, and its hits as contacts.
#include <algorithm>
#include <cmath>
#include <utility>

#include "rods/contacts/find/find_contacts.hpp"

namespace sinew::rods {
namespace {

// What of a segment's radius is looked at a second time: a whole one that touches where it begins would not
// be followed to where another part of it goes through.
constexpr double kCore = 0.5;
// What begins in it is looked at with so much of what it began at, down to the last, of the radius: an axis
// that begins nearer may leave on any side.
constexpr double kNearer = 0.8, kLost = 0.05;
constexpr int kMostLooks = 3;  // with half the radius, and with less
// How near that may come, and how far outside it is stopped so that it is the same in the next step, both of
// its own radius.
constexpr double kThere = 0.05, kOutside = 0.9;

double longest(const Axis& from, const Axis& to) {
  return std::max(length(difference(to.from, from.from)), length(difference(to.to, from.to)));
}

ContactPoint point_of(const ContactHit& hit, uint32_t strand, uint32_t segment) {
  ContactPoint p = {.strand = strand,
                    .segment = segment,
                    .along = hit.along,
                    .gap_m = hit.gap_m,
                    .friction = hit.friction,
                    .name = hit.name,
                    .restitution = hit.restitution};
  std::copy_n(hit.normal, 3, p.normal);
  std::copy_n(hit.velocity_m_s, 3, p.velocity_m_s);
  return p;
}

}  // namespace

void ContactFinder::probe(uint32_t strand, uint32_t segment, const Sweep& sweep, uint32_t* count) const {
  ContactProbe& p = to.asked_.probes[*count];
  const Vector* ends[2][2] = {{&sweep.start.from, &sweep.start.to}, {&sweep.end.from, &sweep.end.to}};
  for (size_t e = 0; e < 2; ++e) {
    for (size_t k = 0; k < 3; ++k) {
      p.start_m[e][k] = (*ends[0][e])[k] + to.asked_.origin_m[k];
      p.end_m[e][k] = (*ends[1][e])[k] + to.asked_.origin_m[k];
    }
  }
  p.radius_m = static_cast<float>(sweep.radius_m);
  p.owner = to.asked_.owner;
  to.asked_.probe_segments[(*count)++] = static_cast<uint32_t>(local(strand, segment));
}

// What a source wrote, of hits that a contact can be made of.
std::span<const ContactHit> ContactFinder::ask(uint32_t probes, ContactHit* hits, uint32_t room,
                                               uint32_t* dropped) const {
  const uint32_t found =
      to.asked_.source->find({to.asked_.probes, probes}, static_cast<float>(dt_s), std::span(hits, room));
  const uint32_t written = std::min(found, room);
  *dropped += found - written;
  const auto bad = [&](const ContactHit& hit) {
    return hit.probe >= probes || !check_obstacle(point_of(hit, 0, 0), 0).ok();
  };
  ContactHit* end = std::remove_if(hits, hits + written, bad);
  to.asked_.bad_hits += static_cast<uint32_t>(hits + written - end);
  return {hits, end};
}

void ContactFinder::add_hits() const {
  uint32_t probes = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    for (uint32_t i = 0; i < batch.segment_count_; ++i) {
      if (free(s, i)) probe(s, i, to.near_by_.sweeps[local(s, i)], &probes);
    }
  }
  std::fill(to.asked_.hit_ways + first_strand(), to.asked_.hit_ways + end_strand(), 0.0);
  const uint32_t room = to.settings_.source_capacity - to.asked_.hit_count;
  for (const ContactHit& hit : ask(probes, to.asked_.hits + to.asked_.hit_count, room, &to.found_.dropped)) {
    const uint32_t segment = to.asked_.probe_segments[hit.probe];
    const uint32_t strand = strand_of(segment);
    const double way = dt_s * length(vector_of(hit.velocity_m_s));
    to.asked_.hit_ways[strand] = std::max(to.asked_.hit_ways[strand], way);
    const Contact* made = add_point(point_of(hit, strand, segment % batch.segment_count_), kHit);
    TakenHit& taken = to.asked_.taken[to.asked_.hit_count++];
    taken = {kNoContact, {}, {}};
    if (!made) continue;
    taken.contact = static_cast<uint32_t>(made - to.found_.contacts);
    taken.felt = scaled_sum(made->force, made->normal, made->drag);
  }
}

// Of strands that moved since they were looked at last, segments that moved further than their radius, or
// near what did: those that ended further than that from where they were looked for, and all of what did not
// converge.
void ContactFinder::choose_cores() const {
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    const bool unconverged = to.progress_.turning[s] || to.progress_.pending[s];
    for (uint32_t i = 0; i < batch.segment_count_; ++i) {
      const Sweep& known = sweep(s, i);
      const Sweep own = taken_sweep(s, i);
      const double way = longest(own.start, own.end);
      const bool far = std::isfinite(way) && std::max(to.asked_.hit_ways[s], way) > own.radius_m;
      const bool elsewhere = longest(known.end, own.end) > own.radius_m;
      const bool looks = to.progress_.moved[s] && free(s, i) && far && (unconverged || elsewhere);
      to.asked_.cores_m[local(s, i)] = looks ? kCore * own.radius_m : 0;
    }
  }
}

// So much of what it began at. Returns whether that is to be looked at.
bool ContactFinder::shrink_core(const ContactHit& hit) const {
  const uint32_t segment = to.asked_.probe_segments[hit.probe];
  const double smaller = kNearer * (static_cast<double>(to.asked_.probes[hit.probe].radius_m) + hit.gap_m);
  if (!(smaller > kLost * to.near_by_.sweeps[segment].radius_m)) return false;
  double& core = to.asked_.cores_m[segment];
  core = core > 0 ? std::min(core, smaller) : smaller;
  return true;
}

// Takes them. Returns how many there are.
uint32_t ContactFinder::probe_cores() const {
  uint32_t probes = 0;
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    for (uint32_t i = 0; i < batch.segment_count_; ++i) {
      const double core = std::exchange(to.asked_.cores_m[local(s, i)], 0.0);
      if (!(core > 0)) continue;
      Sweep own = taken_sweep(s, i);
      own.radius_m = core;
      probe(s, i, own, &probes);
    }
  }
  return probes;
}

// Returns whether something began in its core, and is to be looked at with a smaller one.
bool ContactFinder::look_at_cores() const {
  const uint32_t probes = probe_cores(), room = to.settings_.source_capacity;
  if (probes == 0) return false;
  uint32_t dropped = 0;  // of what is only looked at
  bool again = false;
  for (const ContactHit& hit : ask(probes, to.asked_.hits + room, room, &dropped)) {
    if (hit.gap_m < 0)
      again |= shrink_core(hit);
    else
      stop_at_hit(hit);
  }
  return again;
}

void ContactFinder::stop_at_hits() const {
  choose_cores();
  for (int k = 0; k < kMostLooks && look_at_cores(); ++k) continue;
}

void ContactFinder::stop_at_hit(const ContactHit& hit) const {
  const uint32_t segment = to.asked_.probe_segments[hit.probe], strand = strand_of(segment);
  const double core = static_cast<double>(to.asked_.probes[hit.probe].radius_m);
  const Sweep own = taken_sweep(strand, segment % batch.segment_count_);
  const double share = 0.5 + 0.5 * static_cast<double>(hit.along);
  const Vector move =
      difference(between(own.end.from, own.end.to, share), between(own.start.from, own.start.to, share));
  const Vector obstacle_move = scaled(dt_s, vector_of(hit.velocity_m_s));
  const double gap = hit.gap_m, end = gap + dot(vector_of(hit.normal), difference(move, obstacle_move));
  if (!(end < std::min(gap, kThere * core))) return;
  const double way = std::max(0.0, gap - kOutside * core) / (gap - end);
  if (way >= to.progress_.ways[strand]) return;
  to.progress_.ways[strand] = way;
  to.progress_.carries[strand] = obstacle_move;
}

}  // namespace sinew::rods

// find_contacts.cpp  Sweeps of segments and obstacles, and the contacts between them.
#include "rods/contacts/find/find_contacts.hpp"

#include <algorithm>
#include <bit>

namespace sinew::rods {
namespace {

constexpr double kNearRadii = simd::kRodNearRadii, kNearWay = simd::kRodNearWay;
// Capsules that are side by side overlap by more than this share of their radii; between its ends such an
// overlap is touched too, unless the axes' angle bends it away by less than the last.
constexpr double kOverlap = 0.5, kFlat = 0.3;
// Segments of a strand that at rest are nearer than this, over the sum of their radii, never touch.
constexpr double kRestDistance = 1.2;

// The core of what is round, over the sum of radii; how near an axis that begins in it may come, over how
// near it was; what of a core's radius counts as there.
constexpr double kCore = 0.5, kNearer = 0.8, kThere = 0.05;
// An axis that begins nearer than this, over the sum of radii, may leave on any side.
constexpr double kLost = 0.2;
// Small gaps are advanced through slowly.
constexpr int kCoreMoments = 256;
// A gap that does not count as torn yet, of the strand's mean segment.
constexpr double kHardlyTorn = 0.4;

Vector at(const Axis& axis, double share) { return between(axis.from, axis.to, share); }

Vector axis_of(const Turn& q) {
  return {2 * (q[0] * q[2] + q[1] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
          1 - 2 * (q[0] * q[0] + q[1] * q[1])};
}

// Turned by a rotation vector (Rodrigues).
Vector turned_by(const Vector& turn, const Vector& v) {
  const double angle = length(turn);
  if (!(angle > 1e-12)) return sum(v, cross(turn, v));
  const Vector unit = scaled(1 / angle, turn);
  return sum(sum(scaled(std::cos(angle), v), scaled(std::sin(angle), cross(unit, v))),
             scaled(dot(unit, v) * (1 - std::cos(angle)), unit));
}

void widen(const Vector& by, SweptBox* box) {
  for (size_t k = 0; k < 3; ++k) {
    box->low[k] = std::min(box->low[k], by[k]);
    box->high[k] = std::max(box->high[k], by[k]);
  }
}

SweptBox box_of(const Sweep& s, double margin_m) {
  SweptBox box = {s.start.from, s.start.from};
  for (const Vector& point : {s.start.to, s.end.from, s.end.to}) widen(point, &box);
  for (size_t k = 0; k < 3; ++k) box.low[k] -= margin_m, box.high[k] += margin_m;
  return box;
}

double longest_way(const Sweep& s) {
  return std::max(length(difference(s.end.from, s.start.from)), length(difference(s.end.to, s.start.to)));
}

Capsule capsule_of(const Sphere& s) {
  Capsule point = {
      .radius_m = s.radius_m, .friction = s.friction, .motion = s.motion, .restitution = s.restitution};
  for (auto& end : point.ends_m) std::copy_n(s.middle_m, 3, end);
  return point;
}

void put(const Vector& from, double (&out)[3]) { std::copy_n(from.begin(), 3, out); }

// How far an obstacle's surface moves in the step at a point of it.
Vector surface_move(const ObstacleMotion& motion, const Vector& arm, double dt_s) {
  return scaled(dt_s, sum(vector_of(motion.linear_m_s), cross(vector_of(motion.angular_rad_s), arm)));
}

}  // namespace

uint32_t ContactFinder::end_strand() const {
  return std::min(batch.strand_count_, first_strand() + to.places_.range.groups * batch.width_);
}

bool ContactFinder::free(uint32_t strand, uint32_t segment) const {
  return batch.at(strand, segment, simd::kRodFree) != 0;
}

template <class Found>
void ContactFinder::for_near(uint32_t group, const Found& found) const {
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    for (uint32_t left = to.near_by_.near_lanes[batch.slots_[i]]; left != 0; left &= left - 1) {
      found(group * batch.width_ + static_cast<uint32_t>(std::countr_zero(left)), i);
    }
  }
}

double ContactFinder::mass_kg(uint32_t strand, uint32_t segment) const {
  return static_cast<double>(batch.at(strand, segment, simd::kRodMass)) *
         static_cast<double>(batch.units_[strand].mass_kg);
}

Vector ContactFinder::iterate3(uint32_t strand, uint32_t segment, uint32_t field) const {
  const float* row = to.scratch_row(batch, strand, segment, field);
  return {row[0], row[batch.width_], row[2 * batch.width_]};
}

// Of a segment that moved from its place, in metres, with its z along a unit vector.
Axis ContactFinder::axis(uint32_t strand, uint32_t segment, const Vector& move, const Vector& along) const {
  const RodBatch::Units& units = batch.units_[strand];
  const double l = static_cast<double>(units.length_m);
  Vector middle;
  for (uint32_t k = 0; k < 3; ++k) {
    const double place = static_cast<double>(batch.at(strand, segment, simd::kRodPlace + k)) +
                         static_cast<double>(batch.at(strand, segment, simd::kRodPlaceLow + k));
    middle[k] = units.origin_m[k] + place * l + move[k];
  }
  const double half = static_cast<double>(batch.at(strand, segment, simd::kRodHalfLength)) * l;
  return {scaled_sum(-half, along, middle), scaled_sum(half, along, middle)};
}

void ContactFinder::add_sweep(uint32_t strand, uint32_t segment) const {
  const double l = static_cast<double>(batch.units_[strand].length_m);
  const double radius = static_cast<double>(batch.radius_m(strand, segment));
  Turn before, after;
  for (uint32_t k = 0; k < 4; ++k) {
    before[k] = static_cast<double>(batch.at(strand, segment, simd::kRodTurn + k));
    after[k] = static_cast<double>(*to.scratch_row(batch, strand, segment, simd::kRodFreeTurn + k));
  }
  const Vector move = scaled(l, iterate3(strand, segment, simd::kRodFreeMove));
  const Sweep s = {axis(strand, segment, {}, axis_of(before)), axis(strand, segment, move, axis_of(after)),
                   radius};
  to.near_by_.swept[local(strand, segment)] = 1;
  to.near_by_.sweeps[local(strand, segment)] = s;
  if (!to.settings_.rods_collide) return;
  const double margin = (1 + kNearRadii) * radius + kNearWay * longest_way(s);
  SweptBox box = box_of(s, margin);
  // The first iterate, by its middle: where forces of the last step would bring it.
  const Vector first = scaled(l, iterate3(strand, segment, simd::kRodMove));
  const Axis there = axis(strand, segment, first, axis_of(before));
  for (const Vector& end : {there.from, there.to}) {
    const Vector by = {radius, radius, radius};
    widen(difference(end, by), &box), widen(sum(end, by), &box);
  }
  to.near_by_.boxes[local(strand, segment)] = box;
}

uint64_t ContactFinder::name_of(const Other& other, uint32_t strand, uint32_t segment, uint64_t feature) {
  return mixed(mixed(mixed(other.name, strand), segment), feature) | 1;
}

// `along` from the segment's middle, metres; normal, gap and obstacle's move are left to the caller.
Contact ContactFinder::made(uint32_t strand, uint32_t segment, double along, const Other& other,
                            uint64_t feature) const {
  const Sweep& s = sweep(strand, segment);
  const Vector way = difference(s.start.to, s.start.from);
  Contact c = {};
  c.name = name_of(other, strand, segment, feature);
  c.sides[0] = {strand, segment, along, -s.radius_m, 0, scaled(1 / length(way), way)};
  c.sides[1] = {other.strand, other.segment, 0, other.sweep.radius_m, 0, {}};
  c.friction = other.friction;
  c.scale_m = s.radius_m;
  return c;
}

// Gains of obstacles are stiff, of rods such that what each adds to its own matrix covers the pair's:
//   (u - v)^2 <= (1 + t) u^2 + (1 + 1 / t) v^2,  t the ratio of masses.
// Then iterations that know the other only as it was do not overshoot.
void ContactFinder::set_gain(Contact* c) const {
  const Contact::Side &a = c->sides[0], &b = c->sides[1];
  c->slowness = 1;
  const bool moves_b = b.segment != kNoSegment && free(b.strand, b.segment);
  const double mass_a = mass_kg(a.strand, a.segment), mass_b = moves_b ? mass_kg(b.strand, b.segment) : 0;
  if (!moves_b) {
    c->gain_kg = c->sides[0].stiffness_kg = kObstacleGain * mass_a;
  } else if (!free(a.strand, a.segment)) {
    c->gain_kg = c->sides[1].stiffness_kg = kObstacleGain * mass_b;
  } else {
    c->gain_kg = kRodGain * mass_a * mass_b / (mass_a + mass_b);
    c->slowness = 1 + kRodGain;
    c->sides[0].stiffness_kg = kRodGain * mass_a;
    c->sides[1].stiffness_kg = kRodGain * mass_b;
  }
}

// Of a restitution above 0, the least gap at the end of a step in which something hits that bounces: it
// leaves with its share of the speed with which it came, from where the step began.
double ContactFinder::rebound_m(const Contact& c, double restitution) const {
  const Contact::Side& s = c.sides[0];
  const double l = static_cast<double>(batch.units_[s.strand].length_m);
  const auto three = [&](uint32_t field) {
    const auto value = [&](uint32_t k) {
      return static_cast<double>(batch.at(s.strand, s.segment, field + k));
    };
    return Vector{value(0), value(1), value(2)};
  };
  Turn turn;
  for (uint32_t k = 0; k < 4; ++k)
    turn[k] = static_cast<double>(batch.at(s.strand, s.segment, simd::kRodTurn + k));
  const Vector spin = turned(turn, three(simd::kRodSpin));
  const Vector speed = scaled_sum(l, three(simd::kRodVelocity), scaled(s.along_m, cross(spin, s.axis)));
  const double closing = dot(c.normal, c.obstacle_move) - dt_s * dot(c.normal, speed);
  const bool bounces = closing > dt_s * static_cast<double>(kSlowestRebound_m_s) && closing > c.gap_m;
  return bounces ? restitution * closing : 0;
}

// Null: no room.
Contact* ContactFinder::take() const {
  if (to.found_.contacts_before + to.found_.contact_count < to.capacity_)
    return to.found_.contacts + to.found_.contact_count++;
  ++to.found_.dropped;
  return nullptr;
}

Contact* ContactFinder::add(const Contact& contact, double depth_m, double restitution) const {
  Contact* c = take();
  if (!c) return nullptr;
  *c = contact;
  complete(c, depth_m, restitution);
  return c;
}

// `depth_m` is the gap at the step's start where that is in penetration, else 0 or more.
void ContactFinder::complete(Contact* c, double depth_m, double restitution) const {
  const double left = kLeftAlone * static_cast<double>(to.settings_.tolerance) * c->scale_m;
  const double pushed = static_cast<double>(to.settings_.largest_push_out_m_s) * dt_s;
  if (depth_m < 0) c->allowed_m = depth_m + std::min(pushed, std::max(0.0, -depth_m - left));
  const double rebound = restitution > 0 ? rebound_m(*c, restitution) : 0;
  if (rebound > 0) c->allowed_m = std::max(c->allowed_m, std::max(0.0, c->gap_m) + rebound);
  set_gain(c);
  begin_force(c);
}

// Where the rods' own start continues the last steps, contacts' forces go on as they changed.
void ContactFinder::begin_force(Contact* c) const {
  if (batch.settings_.start == RodStart::kZero) return;
  const KeptForce* kept = to.find_kept(c->name);
  if (!kept) return;
  c->last = kept->force;
  const double share = batch.settings_.start >= RodStart::kContinued ? 1 : 0, square = dt_s * dt_s;
  const double press = kept->force.press + share * kept->change.press;
  if (!(press > 0)) return;
  c->force = square * press;
  c->drag = scaled(square, across(scaled_sum(share, kept->change.drag, kept->force.drag), c->normal));
}

Contact* ContactFinder::add_point(const ContactPoint& p, uint64_t kind) const {
  if (p.strand < first_strand() || p.strand >= end_strand() || !free(p.strand, p.segment)) return nullptr;
  const Sweep& s = sweep(p.strand, p.segment);
  const Other other = {kind,
                       p.name,
                       0,
                       kNoSegment,
                       {},
                       {},
                       {},
                       static_cast<double>(p.friction),
                       static_cast<double>(p.restitution)};
  const double half = 0.5 * length(difference(s.start.to, s.start.from));
  Contact c = made(p.strand, p.segment, half * static_cast<double>(p.along), other, 0);
  const Vector n = vector_of(p.normal);
  c.normal = scaled(1 / length(n), n);
  c.gap_m = p.gap_m;
  c.obstacle_move = scaled(dt_s, vector_of(p.velocity_m_s));
  return add(c, p.gap_m, other.restitution);
}

void ContactFinder::add_end(const Plane& plane, const Other& other, uint32_t strand, uint32_t segment,
                            bool end) const {
  const Sweep& s = sweep(strand, segment);
  const Vector before = end ? s.start.to : s.start.from, after = end ? s.end.to : s.end.from;
  const Vector n = scaled(1 / length(vector_of(plane.normal)), vector_of(plane.normal));
  const double height = dot(difference(before, other.middle_m), n) - s.radius_m;
  const Vector foot = scaled_sum(-(height + s.radius_m), n, before);
  const Vector move = surface_move(plane.motion, difference(foot, other.middle_m), dt_s);
  const double gap = height + dot(n, move), free_gap = dot(difference(after, other.middle_m), n) - s.radius_m;
  const double way = length(difference(difference(after, before), move));
  if (!(std::min(gap, free_gap) < kNearRadii * s.radius_m + kNearWay * way)) return;
  const double half = 0.5 * length(difference(s.start.to, s.start.from));
  Contact c = made(strand, segment, end ? half : -half, other, end ? 1 : 0);
  c.normal = n;
  c.gap_m = gap;
  c.obstacle_move = move;
  add(c, gap, other.restitution);
}

// A joint's two ends are one point: the parent's touches, unless the child is thicker.
void ContactFinder::add_plane(const Plane& plane, uint32_t index) const {
  const Other other = {kPlane,
                       index,
                       0,
                       kNoSegment,
                       {},
                       plane.motion,
                       {plane.point_m[0], plane.point_m[1], plane.point_m[2]},
                       static_cast<double>(plane.friction),
                       static_cast<double>(plane.restitution)};
  const simd::RodFlat flat = flat_of(plane);
  for (uint32_t g = to.places_.range.first_group; g < to.places_.range.first_group + to.places_.range.groups;
       ++g) {
    if (!near(g, flat)) continue;
    for_near(g, [&](uint32_t strand, uint32_t i) {
      const bool thicker = i > 0 && batch.radius_m(strand, i) > batch.radius_m(strand, batch.parents_[i]);
      if (i == 0 || thicker) add_end(plane, other, strand, i, false);
      add_end(plane, other, strand, i, true);
    });
  }
}

Sweep ContactFinder::sweep_of(const Capsule& capsule) const {
  const Vector from = {capsule.ends_m[0][0], capsule.ends_m[0][1], capsule.ends_m[0][2]};
  const Vector to_end = {capsule.ends_m[1][0], capsule.ends_m[1][1], capsule.ends_m[1][2]};
  const Vector middle = between(from, to_end, 0.5), half = scaled(0.5, difference(to_end, from));
  const Vector back = scaled(-dt_s, vector_of(capsule.motion.angular_rad_s));
  const Vector was = scaled_sum(-dt_s, vector_of(capsule.motion.linear_m_s), middle);
  const Vector half_then = turned_by(back, half);
  return {{difference(was, half_then), sum(was, half_then)},
          {from, to_end},
          static_cast<double>(capsule.radius_m)};
}

simd::RodFlat ContactFinder::flat_of(const Plane& plane) const {
  const Vector n = vector_of(plane.normal);
  simd::RodFlat flat;
  flat.way_m = dt_s * length(vector_of(plane.motion.linear_m_s));
  flat.turn_rad = dt_s * length(vector_of(plane.motion.angular_rad_s));
  std::copy_n(plane.point_m, 3, flat.point_m);
  put(scaled(1 / length(n), n), flat.normal);
  return flat;
}

simd::RodRound ContactFinder::round_of(const Other& other) const {
  simd::RodRound round;
  round.radius_m = other.sweep.radius_m, round.way_m = longest_way(other.sweep), round.dt_s = dt_s;
  put(other.sweep.start.from, round.start_m[0]), put(other.sweep.start.to, round.start_m[1]);
  put(other.sweep.end.from, round.end_m[0]), put(other.sweep.end.to, round.end_m[1]);
  put(vector_of(other.motion.linear_m_s), round.linear_m_s);
  put(vector_of(other.motion.angular_rad_s), round.angular_rad_s);
  put(other.middle_m, round.middle_m);
  return round;
}

void ContactFinder::add_round(const Capsule& capsule, uint64_t kind, uint32_t index) const {
  const Sweep sweep = sweep_of(capsule);
  const Other other = {kind,
                       index,
                       0,
                       kNoSegment,
                       sweep,
                       capsule.motion,
                       between(sweep.end.from, sweep.end.to, 0.5),
                       static_cast<double>(capsule.friction),
                       static_cast<double>(capsule.restitution)};
  const simd::RodRound round = round_of(other);
  for (uint32_t g = to.places_.range.first_group; g < to.places_.range.first_group + to.places_.range.groups;
       ++g) {
    if (near(g, round)) add_near(g, other, round);
  }
}

// Of the lanes that are near.
uint32_t ContactFinder::not_passing(uint32_t group, uint32_t segment, const Other& other) const {
  uint32_t lanes = to.near_by_.near_lanes[batch.slots_[segment]];
  if (other.kind != kCapsule || !to.obstacles_.passed_any) return lanes;
  for (uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<uint32_t>(std::countr_zero(left));
    if (to.passes(group * batch.width_ + lane, segment, static_cast<uint32_t>(other.index)))
      lanes &= ~(1u << lane);
  }
  return lanes;
}

void ContactFinder::add_near(uint32_t group, const Other& other, const simd::RodRound& round) const {
  simd::RodTouches touches;
  for (uint32_t i = 0; i < batch.segment_count_; ++i) {
    const uint32_t lanes = not_passing(group, i, other);
    if (lanes == 0) continue;
    touch(group, i, lanes, round, &touches);
    for (uint32_t left = touches.touch | touches.other; left != 0; left &= left - 1) {
      const auto lane = static_cast<uint32_t>(std::countr_zero(left));
      const uint32_t strand = group * batch.width_ + lane;
      touches.other >> lane & 1 ? add_touch(strand, i, other) : add_lane(strand, i, other, touches);
    }
  }
}

// What add_at would make of the touch.
void ContactFinder::add_lane(uint32_t strand, uint32_t segment, const Other& other,
                             const simd::RodTouches& touches) const {
  Contact* c = take();
  if (!c) return;
  const size_t lane = batch.lane_of(strand);
  const auto row = [&](size_t r) { return touches.rows[r][lane]; };
  const auto row3 = [&](size_t r) { return Vector{row(r), row(r + 1), row(r + 2)}; };
  const double radius = static_cast<double>(batch.radius_m(strand, segment));
  *c = {};
  c->name = name_of(other, strand, segment, 0);
  c->sides[0] = {strand, segment, row(simd::kTouchAlong), -radius, 0, row3(simd::kTouchAxis)};
  c->sides[1] = {other.strand, kNoSegment, 0, other.sweep.radius_m, 0, {}};
  c->normal = row3(simd::kTouchNormal);
  c->obstacle_move = row3(simd::kTouchMove);
  c->gap_m = row(simd::kTouchGap);
  c->friction = other.friction;
  c->scale_m = radius;
  complete(c, row(simd::kTouchDepth), other.restitution);
  c->open_m = row(simd::kTouchOpen) - c->allowed_m;
  if (is_active(*c, c->open_m) || is_active(*c, 0)) c->slip_m = row3(simd::kTouchSlip);
  c->is_looked_at = true;
}

void ContactFinder::add_touch(uint32_t strand, uint32_t segment, const Other& other) const {
  const Sweep& a = sweep(strand, segment);
  const Touch touch = first_touch(a, other.sweep);
  const Vector way_a = difference(at(a.end, touch.at.a), at(a.start, touch.at.a));
  const Vector way_b = difference(at(other.sweep.end, touch.at.b), at(other.sweep.start, touch.at.b));
  const double radii = a.radius_m + (other.segment == kNoSegment ? 0 : other.sweep.radius_m);
  if (!(touch.gap_m < kNearRadii * radii + kNearWay * length(difference(way_a, way_b)))) return;
  // A chain's segments, deep in something, would be pushed out along themselves, away from each other.
  const Vector z = difference(a.start.to, a.start.from);
  if (touch.time == 0 && touch.gap_m < -simd::kRodDeep * a.radius_m &&
      std::fabs(dot(touch.normal, z)) > simd::kRodEndOn * length(z)) {
    const Vector n = way_out(touch.axis_a, touch.axis_b, touch.normal);
    const Vector apart = difference(at(touch.axis_a, touch.at.a), at(touch.axis_b, touch.at.b));
    add_at(strand, segment, other, touch.at, n, dot(apart, n) - a.radius_m - other.sweep.radius_m, 0, 0);
    return;
  }
  if (add_side_by_side(strand, segment, other, touch)) return;
  add_at(strand, segment, other, touch.at, touch.normal, touch.gap_m, touch.time, 0);
}

// The ends of where two capsules overlap. Returns whether the middle is touched by these as well.
bool ContactFinder::add_side_by_side(uint32_t strand, uint32_t segment, const Other& other,
                                     const Touch& touch) const {
  const Vector u = difference(touch.axis_a.to, touch.axis_a.from);
  const Vector v = difference(touch.axis_b.to, touch.axis_b.from), across_both = cross(u, v);
  const double uu = dot(u, u), vv = dot(v, v), sine = dot(across_both, across_both);
  if (!(sine < simd::kRodSideBySide * uu * vv)) return false;
  const double radii = sweep(strand, segment).radius_m + other.sweep.radius_m;
  const double ends[2] = {nearest(touch.axis_a, touch.axis_b.from), nearest(touch.axis_a, touch.axis_b.to)};
  const double overlap_m = std::fabs(ends[1] - ends[0]) * std::sqrt(uu);
  if (!(overlap_m > kOverlap * radii)) return false;
  for (uint64_t k = 0; k < 2; ++k) {
    const Vector point = at(touch.axis_a, ends[k]);
    const Nearest place = {ends[k], nearest(touch.axis_b, point)};
    const Vector apart = difference(point, at(touch.axis_b, place.b));
    const double distance = length(apart);
    const bool known = distance > 0.1 * radii && dot(apart, touch.normal) > 0;
    const Vector n = known ? scaled(1 / distance, apart) : touch.normal;
    add_at(strand, segment, other, place, n, dot(apart, n) - radii, touch.time, 1 + k);
  }
  const double bent = 0.5 * overlap_m * std::sqrt(sine / (uu * vv));
  return bent < kFlat * radii;
}

void ContactFinder::add_at(uint32_t strand, uint32_t segment, const Other& other, const Nearest& place,
                           const Vector& normal, double gap_then_m, double time, uint64_t feature) const {
  const Sweep &a = sweep(strand, segment), &b = other.sweep;
  const double length_a = length(difference(a.start.to, a.start.from));
  const Vector point_b = at(b.start, place.b), end_b = at(b.end, place.b);
  Contact c = made(strand, segment, (place.a - 0.5) * length_a, other, feature);
  c.normal = normal;
  c.gap_m = dot(difference(at(a.start, place.a), point_b), normal) - a.radius_m - b.radius_m;
  if (other.segment != kNoSegment) {
    const Vector way = difference(b.start.to, b.start.from);
    const double length_b = length(way);
    c.sides[1].along_m = (place.b - 0.5) * length_b;
    c.sides[1].axis = scaled(1 / length_b, way);
  } else {
    const Vector surface = scaled_sum(b.radius_m, normal, end_b), axis_move = difference(end_b, point_b);
    const Vector slides = surface_move(other.motion, difference(surface, other.middle_m), dt_s);
    c.obstacle_move = scaled_sum(dot(normal, axis_move), normal, across(slides, normal));
  }
  add(c, time > 0 ? 0 : gap_then_m, other.restitution);
}

bool ContactFinder::overlap_at_rest(uint32_t strand, uint32_t i, uint32_t j) const {
  const double l = static_cast<double>(batch.units_[strand].length_m);
  double radii = 0;
  Axis axes[2];
  for (const uint32_t s : {i, j}) {
    const float* rest = batch.rest_ + (size_t{strand} * batch.segment_count_ + s) * RodBatch::kRestNumbers;
    const Vector middle = {static_cast<double>(rest[0]) + static_cast<double>(rest[3]),
                           static_cast<double>(rest[1]) + static_cast<double>(rest[4]),
                           static_cast<double>(rest[2]) + static_cast<double>(rest[5])};
    const double half = static_cast<double>(batch.at(strand, s, simd::kRodHalfLength));
    const Vector along = axis_of({rest[6], rest[7], rest[8], rest[9]});
    axes[s == j] = {scaled_sum(-half, along, middle), scaled_sum(half, along, middle)};
    radii += static_cast<double>(batch.radius_m(strand, s));
  }
  const Nearest n = nearest(axes[0], axes[1]);
  return length(difference(at(axes[0], n.a), at(axes[1], n.b))) * l < kRestDistance * radii;
}

// Two segments of the range by their local numbers.
void ContactFinder::add_pair(uint32_t i, uint32_t j) const {
  const uint32_t count = batch.segment_count_, strand_i = strand_of(i), strand_j = strand_of(j),
                 a = i % count, b = j % count;
  if (!free(strand_i, a) && !free(strand_j, b)) return;
  if (strand_i == strand_j && overlap_at_rest(strand_i, a, b)) return;
  const Other other = {kRod,
                       uint64_t{strand_j} << 32 | b,
                       strand_j,
                       b,
                       to.near_by_.sweeps[j],
                       {},
                       {},
                       static_cast<double>(to.settings_.rod_friction),
                       0};
  add_touch(strand_i, a, other);
}

// From the step's start to the iterate.
Sweep ContactFinder::taken_sweep(uint32_t strand, uint32_t segment) const {
  Turn now;
  for (uint32_t k = 0; k < 4; ++k) {
    now[k] = static_cast<double>(*to.scratch_row(batch, strand, segment, simd::kRodNow + k));
  }
  const double l = static_cast<double>(batch.units_[strand].length_m);
  const Sweep& known = sweep(strand, segment);
  const Vector move = scaled(l, iterate3(strand, segment, simd::kRodMove));
  return {known.start, axis(strand, segment, move, axis_of(now)), known.radius_m};
}

void ContactFinder::stop_at_core(uint32_t strand, uint32_t segment, const Sweep& round) const {
  Sweep own = taken_sweep(strand, segment), core = round;
  const Nearest n = nearest(own.start, core.start);
  const double began = length(difference(at(own.start, n.a), at(core.start, n.b)));
  if (began < kLost * (own.radius_m + core.radius_m)) return;
  core.radius_m = std::min(kCore * (own.radius_m + core.radius_m), kNearer * began);
  own.radius_m = 0;
  const Touch touch = first_touch(own, core, kCoreMoments);
  if (!(touch.gap_m < kThere * core.radius_m) || touch.time >= to.progress_.ways[strand]) return;
  const Vector moved = difference(at(core.end, touch.at.b), at(core.start, touch.at.b));
  to.progress_.ways[strand] = touch.time;
  to.progress_.carries[strand] = moved;
}

void ContactFinder::stop_at_cores(uint32_t strand, uint32_t segment) const {
  for (uint32_t i = 0; i < to.obstacles_.sphere_count; ++i) {
    stop_at_core(strand, segment, sweep_of(capsule_of(to.obstacles_.spheres[i])));
  }
  for (uint32_t i = 0; i < to.obstacles_.capsule_count; ++i) {
    if (!to.passes(strand, segment, i)) stop_at_core(strand, segment, sweep_of(to.obstacles_.capsules[i]));
  }
}

void ContactFinder::stop_at_cores() const {
  for (uint32_t g = 0; g < to.places_.range.groups; ++g) {
    const uint32_t group = to.places_.range.first_group + g;
    if (!may_enter(group)) continue;
    for_near(group, [this](uint32_t s, uint32_t i) { stop_at_cores(s, i); });
  }
}

// Gaps grow about in proportion to the way, from what they are where fixed segments are already there. Half a
// turn leaves gaps too, so what is torn again stays where it began.
void ContactFinder::stop_torn(uint32_t strand, bool again) const {
  const double most = kHardlyTorn * static_cast<double>(batch.units_[strand].length_m);
  for (uint32_t i = 1; i < batch.segment_count_; ++i) {
    const uint32_t p = batch.parents_[i];
    const Sweep parent = taken_sweep(strand, p), own = taken_sweep(strand, i);
    const Vector& from = (free(strand, p) ? parent.start : parent.end).to;
    const Vector& to_here = (free(strand, i) ? own.start : own.end).from;
    const double began = length(difference(from, to_here));
    const double ends = length(difference(parent.end.to, own.end.from));
    if (!(ends > most) || !(began < most)) continue;
    const double way = again ? 0 : (most - began) / (ends - began);
    to.progress_.ways[strand] = std::min(to.progress_.ways[strand], way);
  }
}

bool ContactFinder::find_holds(bool again) const noexcept {
  for (uint32_t s = first_strand(); s < end_strand(); ++s)
    to.progress_.moved[s] = !again || to.progress_.ways[s] < 1;
  std::fill(to.progress_.ways + first_strand(), to.progress_.ways + end_strand(), 1.0);
  if (to.asked_.source) stop_at_hits();
  if (to.obstacles_.sphere_count + to.obstacles_.capsule_count > 0) stop_at_cores();
  for (uint32_t s = first_strand(); s < end_strand(); ++s) {
    if (to.progress_.turning[s] && to.progress_.near[s]) stop_torn(s, again);
  }
  return std::any_of(to.progress_.ways + first_strand(), to.progress_.ways + end_strand(),
                     [](double w) { return w < 1; });
}

void ContactFinder::find() const noexcept {
  const uint32_t obstacles = to.obstacles_.point_count + to.obstacles_.plane_count +
                             to.obstacles_.sphere_count + to.obstacles_.capsule_count;
  if (obstacles == 0 && !to.asked_.source && !to.settings_.rods_collide) return;
  find_reaches();
  if (to.asked_.source || to.settings_.rods_collide) {
    for (uint32_t s = first_strand(); s < end_strand(); ++s) {
      for (uint32_t i = 0; i < batch.segment_count_; ++i) add_sweep(s, i);
    }
  }
  for (uint32_t i = 0; i < to.obstacles_.point_count; ++i) add_point(to.obstacles_.points[i], kPoint);
  for (uint32_t i = 0; i < to.obstacles_.plane_count; ++i) add_plane(to.obstacles_.planes[i], i);
  for (uint32_t i = 0; i < to.obstacles_.sphere_count; ++i)
    add_round(capsule_of(to.obstacles_.spheres[i]), kSphere, i);
  for (uint32_t i = 0; i < to.obstacles_.capsule_count; ++i)
    add_round(to.obstacles_.capsules[i], kCapsule, i);
  if (to.asked_.source) add_hits();
  if (!to.settings_.rods_collide) return;
  to.near_by_.hash.build(to.near_by_.boxes, (end_strand() - first_strand()) * batch.segment_count_);
  to.near_by_.hash.for_pairs([this](uint32_t i, uint32_t j) { add_pair(i, j); });
}

}  // namespace sinew::rods

// test_rod_forces.cpp  Contacts followed a contact a lane, against those followed one at a time, on every
// instruction set.
#include <array>
#include <bit>
#include <catch2/catch.hpp>

#include "kernels/rod_contacts/rod_force_job.hpp"
#include "rods/contacts/contact.hpp"
#include "tests/rods/plain_look.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using rods::Contact;
using rods::Turn;
using rods::Vector;
using test::Iterate;
using test::Looked;

namespace {

constexpr size_t kLanes = simd::kForceLanes;

class Dice {
 public:
  explicit Dice(uint32_t seed) : state_(seed * 2654435761u + 1) {}
  // -1 to 1.
  double any() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(static_cast<int64_t>(state_) >> 11) * 0x1p-52;
  }
  double above_zero() { return 0.01 + std::fabs(any()); }
  bool one_in(int n) { return std::fabs(any()) * n < 1; }
  Vector vector() { return {any(), any(), any()}; }
  Vector unit() {
    const Vector v = vector();
    return rods::scaled(1 / rods::length(v), v);
  }
  Turn turn() { return rods::normalised({any(), any(), any(), any()}); }

 private:
  uint64_t state_;
};

bool same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }
bool same(const Vector& a, const double (*rows)[kLanes], size_t lane) {
  return same(a[0], rows[0][lane]) && same(a[1], rows[1][lane]) && same(a[2], rows[2][lane]);
}
void put3(double (*rows)[kLanes], size_t lane, const Vector& v) {
  for (size_t k = 0; k < 3; ++k) rows[k][lane] = v[k];
}

// Anything from far off to sliding and sticking, drags at their limit and on either side of it.
Contact any_contact(Dice& dice) {
  Contact c = {};
  c.sides[0] = {0, 0, 0.1 * dice.any(), -dice.above_zero(), dice.above_zero(), dice.unit()};
  c.sides[1].segment = rods::kNoSegment;
  c.normal = dice.unit(), c.obstacle_move = rods::scaled(0.1, dice.vector());
  c.gap_m = 0.1 * dice.any(), c.allowed_m = 0.01 * dice.any();
  c.gain_kg = 1000 * dice.above_zero(), c.friction = dice.one_in(5) ? 0 : dice.above_zero();
  c.force = dice.one_in(4) ? 0 : 30 * dice.above_zero();
  c.limit = dice.one_in(6) ? 0 : c.friction * c.force * (1 + 0.1 * dice.any());
  c.state = static_cast<rods::Friction>(dice.one_in(3) ? 2 : dice.one_in(2));
  c.changes = dice.one_in(2) ? 2 : dice.one_in(2);
  c.drag = rods::scaled(c.limit * (dice.one_in(2) ? 1 : 1.5 * dice.above_zero()), dice.unit());
  c.open_m = 0.01 * dice.any(), c.open_before_m = -0.01 * dice.above_zero();
  c.slip_m = rods::scaled(dice.one_in(2) ? 1e-3 : 0.1, dice.vector());
  c.slip_before_m = dice.one_in(3) ? rods::scaled(0.5, c.slip_m) : rods::scaled(0.1, dice.vector());
  return c;
}

Iterate any_iterate(Dice& dice) {
  Iterate out = {static_cast<double>(static_cast<float>(dice.above_zero())), {}, {}, {}};
  const Turn now = dice.turn(), before = dice.turn();
  for (float& x : out.move) x = static_cast<float>(dice.any());
  for (size_t k = 0; k < 4; ++k)
    out.now[k] = static_cast<float>(now[k]), out.before[k] = static_cast<float>(before[k]);
  return out;
}

void put(const Contact& c, const Iterate& at, size_t lane, simd::RodLooks* out) {
  put3(out->rows + simd::kLookNormal, lane, c.normal);
  put3(out->rows + simd::kLookAxis, lane, c.sides[0].axis);
  put3(out->rows + simd::kLookObstacle, lane, c.obstacle_move);
  const double rest[] = {c.gap_m,         c.allowed_m,        rods::kLetsGo * c.gain_kg, c.force,
                         c.open_before_m, c.sides[0].along_m, c.sides[0].radius_m,       at.length_m};
  for (size_t k = 0; k < std::size(rest); ++k) out->rows[simd::kLookGap + k][lane] = rest[k];
  for (size_t k = 0; k < 3; ++k) out->floats[simd::kLookMove + k][lane] = at.move[k];
  for (size_t k = 0; k < 4; ++k)
    out->floats[simd::kLookNow + k][lane] = at.now[k], out->floats[simd::kLookTurn + k][lane] = at.before[k];
}

struct Law {
  double share, tolerance_m, nothing_m, rounding_kg_m;
};

bool slides_on(const Contact& c, const Vector& slip, double drag) {
  return rods::dot(slip, c.drag) < 0 && rods::dot(slip, c.slip_before_m) > 0 &&
         rods::dot(slip, slip) > rods::dot(c.slip_before_m, c.slip_before_m) && drag > 2 * c.limit;
}
bool changes(const Contact& c, const Vector& slip, double drag) {
  return c.state == rods::Friction::kSlides ? rods::dot(slip, c.drag) > 0 || drag < c.limit : drag > c.limit;
}
// Returns whether it comes to rest.
bool plain_friction(Contact* c, const Vector& slip) {
  const double drag = rods::length(rods::scaled_sum(-c->gain_kg, slip, c->drag));
  const bool slid = c->state == rods::Friction::kSlides;
  if (!(c->force > 0)) return false;
  if (c->state == rods::Friction::kEither) {
    if (slides_on(*c, slip, drag)) c->state = rods::Friction::kSlides;
    return false;
  }
  if (!changes(*c, slip, drag)) return false;
  const auto other = slid ? rods::Friction::kSticks : rods::Friction::kSlides;
  c->state = ++c->changes > simd::kMostFrictionChanges ? rods::Friction::kEither : other;
  return slid;
}
Vector shortened(const Vector& v, double limit) {
  const double size = rods::length(v);
  return size > limit ? rods::scaled(limit / size, v) : v;
}
double plain_miss(const Contact& c, const Contact& before, const Law& law) {
  const rods::ContactForce f = rods::forces_of(before, before.open_before_m, before.slip_before_m);
  const Vector slipped = rods::difference(c.slip_m, c.slip_before_m);
  const bool stuck = before.state == rods::Friction::kSticks;
  const double moved = std::max(std::fabs(c.open_m - c.open_before_m), rods::length(slipped));
  if (!stuck && moved <= law.nothing_m) return 0;
  const double pull = std::max(0.0, c.gain_kg * c.open_m - before.force);
  if (!(c.friction > 0)) return std::max(0.0, pull - law.rounding_kg_m);
  const Vector drag = rods::drag_after(c, f, slipped);
  const Vector lawful =
      shortened(stuck ? drag : rods::scaled_sum(-c.gain_kg, c.slip_m, drag), c.friction * c.force);
  return std::max(0.0, pull + rods::length(rods::difference(lawful, drag)) - law.rounding_kg_m);
}

struct Taken {
  Contact contact;
  double miss;
  bool exact;
};
Taken plain_take(const Contact& before, const Law& law) {
  Contact c = before;
  const double left = 1 - law.share;
  const Vector slip = rods::scaled_sum(-left, c.slip_before_m, c.slip_m);
  c.force = std::max(0.0, c.force - c.gain_kg * (c.open_m - left * c.open_before_m));
  c.limit += (c.friction * c.force - c.limit) / (1 + c.friction * c.friction);
  const bool rests = plain_friction(&c, slip);
  c.drag = rests ? shortened(c.drag, c.limit) : rods::forces_of(c, 0, slip).drag;
  const bool held = before.state == rods::Friction::kSticks && c.friction > 0;
  const double off = std::max(std::fabs(c.open_m), held ? rods::length(c.slip_m) : 0.0);
  return {c, plain_miss(c, before, law), off <= law.tolerance_m};
}

void put(const Contact& c, const Law& law, size_t lane, simd::RodTakes* out) {
  const double first[] = {c.gain_kg,     c.friction,        law.share, law.tolerance_m,
                          law.nothing_m, law.rounding_kg_m, c.open_m,  c.open_before_m};
  for (size_t k = 0; k < std::size(first); ++k) out->rows[simd::kTakeGain + k][lane] = first[k];
  put3(out->rows + simd::kTakeSlip, lane, c.slip_m);
  put3(out->rows + simd::kTakeSlipBefore, lane, c.slip_before_m);
  out->rows[simd::kTakeForce][lane] = c.force, out->rows[simd::kTakeLimit][lane] = c.limit;
  put3(out->rows + simd::kTakeDrag, lane, c.drag);
  out->rows[simd::kTakeState][lane] = static_cast<uint32_t>(c.state);
  out->rows[simd::kTakeChanges][lane] = c.changes;
}
bool same(const Taken& t, const simd::RodTakes& lanes, size_t k) {
  const auto row = [&](size_t r) { return lanes.rows[r][k]; };
  return same(t.contact.force, row(simd::kTakeForce)) && same(t.contact.limit, row(simd::kTakeLimit)) &&
         same(t.contact.drag, lanes.rows + simd::kTakeDrag, k) &&
         row(simd::kTakeState) == static_cast<uint32_t>(t.contact.state) &&
         row(simd::kTakeChanges) == t.contact.changes && same(t.miss, row(simd::kTakeMiss)) &&
         (row(simd::kTakeExact) != 0) == t.exact;
}

struct Units {
  double length_m, mass_kg;
};
// As ContactForces::add_to_side.
void plain_push(const Contact& c, const Iterate& at, const Units& units,
                float (&out)[simd::RodPushes::kOut]) {
  const Contact::Side& s = c.sides[0];
  const rods::ContactForce f = rods::forces_of(c);
  const double pressed = s.stiffness_kg, held = f.across * pressed, along_held = f.along * pressed;
  const double m = units.mass_kg, l = units.length_m;
  const rods::Axes own = rods::axes_of(rods::turn_of(at.now));
  const Vector arm =
      rods::scaled(1 / l, rods::scaled_sum(s.radius_m, c.normal, rods::scaled(s.along_m, own.z)));
  const Vector moves[6] = {{1, 0, 0},
                           {0, 1, 0},
                           {0, 0, 1},
                           rods::cross(own.x, arm),
                           rods::cross(own.y, arm),
                           rods::cross(own.z, arm)};
  const Vector force = rods::scaled_sum(f.press, c.normal, f.drag);
  size_t at_row = 0;
  for (size_t r = 0; r < 6; ++r) {
    const Vector held_all = rods::scaled_sum((along_held - held) * rods::dot(moves[r], f.direction),
                                             f.direction, rods::scaled(held, moves[r]));
    const Vector stiff = rods::scaled(
        1 / m, rods::scaled_sum((pressed - held) * rods::dot(moves[r], c.normal), c.normal, held_all));
    for (size_t k = 0; k <= r; ++k) out[at_row++] = static_cast<float>(rods::dot(stiff, moves[k]));
    out[21 + r] = static_cast<float>(rods::dot(force, moves[r]) / (m * l));
  }
}
void put(const Contact& c, const Iterate& at, const Units& units, size_t lane, simd::RodPushes* out) {
  out->rows[simd::kPushGain][lane] = c.gain_kg, out->rows[simd::kPushFriction][lane] = c.friction;
  out->rows[simd::kPushForce][lane] = c.force, out->rows[simd::kPushLimit][lane] = c.limit;
  put3(out->rows + simd::kPushDrag, lane, c.drag);
  out->rows[simd::kPushState][lane] = static_cast<uint32_t>(c.state);
  out->rows[simd::kPushOpen][lane] = c.open_m;
  put3(out->rows + simd::kPushSlip, lane, c.slip_m);
  put3(out->rows + simd::kPushNormal, lane, c.normal);
  const double rest[] = {c.sides[0].along_m, c.sides[0].radius_m, c.sides[0].stiffness_kg, units.length_m,
                         units.mass_kg};
  for (size_t k = 0; k < std::size(rest); ++k) out->rows[simd::kPushAlong + k][lane] = rest[k];
  for (size_t k = 0; k < 4; ++k) out->now[k][lane] = at.now[k];
}

// body(dice, count): of any part of the lanes.
template <class Body>
void for_many(const Body& body) {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    Dice dice(7);
    for (uint32_t run = 0; run < 400; ++run) body(*kernels.rod_forces, dice, 1 + run % kLanes);
  });
}

}  // namespace

TEST_CASE("gaps_and_slips_a_contact_a_lane_have_the_bits_of_one_at_a_time") {
  for_many([](const simd::RodForceKernels& kernels, Dice& dice, size_t count) {
    simd::RodLooks lanes = {};
    std::vector<Looked> expected;
    for (size_t k = 0; k < count; ++k) {
      const Contact c = any_contact(dice);
      const Iterate at = any_iterate(dice);
      put(c, at, k, &lanes);
      expected.push_back(test::plain_look(c, at));
    }
    kernels.look(&lanes, count);
    for (size_t k = 0; k < count; ++k) {
      REQUIRE(same(expected[k].open_m, lanes.rows[simd::kLookOpen][k]));
      REQUIRE(same(expected[k].slip_m, lanes.rows + simd::kLookSlip, k));
    }
  });
}

TEST_CASE("forces_taken_over_a_contact_a_lane_have_the_bits_of_one_at_a_time") {
  for_many([](const simd::RodForceKernels& kernels, Dice& dice, size_t count) {
    simd::RodTakes lanes = {};
    std::vector<Taken> expected;
    for (size_t k = 0; k < count; ++k) {
      const Contact c = any_contact(dice);
      const Law law = {dice.one_in(2) ? 1 : dice.above_zero(), 0.005, dice.one_in(3) ? 0.05 : 1e-4, 1e-3};
      put(c, law, k, &lanes);
      expected.push_back(plain_take(c, law));
    }
    kernels.take(&lanes, count);
    for (size_t k = 0; k < count; ++k) REQUIRE(same(expected[k], lanes, k));
  });
}

TEST_CASE("rows_of_a_contact_a_lane_have_the_numbers_of_one_at_a_time") {
  for_many([](const simd::RodForceKernels& kernels, Dice& dice, size_t count) {
    simd::RodPushes lanes = {};
    std::vector<std::array<float, simd::RodPushes::kOut>> expected;
    for (size_t k = 0; k < count; ++k) {
      Contact c = any_contact(dice);
      c.force += 30, c.open_m = -std::fabs(c.open_m);
      const Iterate at = any_iterate(dice);
      const Units units = {at.length_m, dice.above_zero()};
      put(c, at, units, k, &lanes);
      float rows[simd::RodPushes::kOut];
      plain_push(c, at, units, rows);
      expected.push_back(std::to_array(rows));
    }
    kernels.push(&lanes, count);
    for (size_t k = 0; k < count; ++k) {
      for (size_t r = 0; r < simd::RodPushes::kOut; ++r) REQUIRE(expected[k][r] == lanes.out[r][k]);
    }
  });
}

// test_rod_touch.cpp  Touches found a strand a lane, against those found one at a time, on every instruction
// set.
#include <bit>
#include <catch2/catch.hpp>

#include "tests/rods/lane_scenes.hpp"
#include "tests/rods/plain_look.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using rods::Axis;
using rods::Sweep;
using rods::Vector;

namespace {

Vector at(const Axis& axis, double share) { return rods::between(axis.from, axis.to, share); }

Vector way(const Sweep& s, double share) { return rods::difference(at(s.end, share), at(s.start, share)); }

// What find_contacts.cpp makes of a touch, one at a time.
struct Expected {
  bool touches, ordinary;
  double along_m, gap_m, depth_m;
  Vector axis, normal, move;
};

bool is_side_by_side(const Axis& a, const Axis& b) {
  const Vector u = rods::difference(a.to, a.from), v = rods::difference(b.to, b.from), n = rods::cross(u, v);
  return rods::dot(n, n) < simd::kRodSideBySide * rods::dot(u, u) * rods::dot(v, v);
}

Expected expected(const Sweep& a, const Sweep& b, const simd::RodRound& round) {
  const rods::Touch t = rods::first_touch(a, b);
  const Vector z = rods::difference(a.start.to, a.start.from), move_b = way(b, t.at.b);
  const double near = simd::kRodNearRadii * a.radius_m +
                      simd::kRodNearWay * rods::length(rods::difference(way(a, t.at.a), move_b));
  const bool odd = t.time == 0 && t.gap_m < -simd::kRodDeep * a.radius_m &&
                   std::fabs(rods::dot(t.normal, z)) > simd::kRodEndOn * rods::length(z);
  // Where axes have met at some moment they are as near then, or nearer.
  const double sum_m = a.radius_m + b.radius_m;
  const bool meets = !(t.gap_m + sum_m > simd::kRodMeeting * sum_m);
  Expected out = {};
  out.touches = t.gap_m < near;
  out.ordinary = !meets && !odd && !is_side_by_side(t.axis_a, t.axis_b);
  const Vector end_b = at(b.end, t.at.b), point_b = at(b.start, t.at.b);
  const auto three = [](const double(&v)[3]) { return Vector{v[0], v[1], v[2]}; };
  const Vector arm = rods::difference(rods::scaled_sum(b.radius_m, t.normal, end_b), three(round.middle_m));
  const Vector slides = rods::scaled(
      round.dt_s, rods::sum(three(round.linear_m_s), rods::cross(three(round.angular_rad_s), arm)));
  out.along_m = (t.at.a - 0.5) * rods::length(z);
  out.axis = rods::scaled(1 / rods::length(z), z);
  out.normal = t.normal;
  out.move = rods::scaled_sum(rods::dot(t.normal, rods::difference(end_b, point_b)), t.normal,
                              rods::across(slides, t.normal));
  out.gap_m = rods::dot(rods::difference(at(a.start, t.at.a), point_b), t.normal) - a.radius_m - b.radius_m;
  out.depth_m = t.time > 0 ? 0 : t.gap_m;
  return out;
}

// At the iterate of a lane, of what presses however far it is open.
test::Looked looked(test::LaneScene& scene, uint32_t i, uint32_t k, const Expected& e) {
  rods::Contact c = {};
  c.sides[0] = {0, 0, e.along_m, -scene.radius_m(i, k), 0, e.axis};
  c.sides[1].segment = rods::kNoSegment;
  c.normal = e.normal, c.obstacle_move = e.move, c.gap_m = e.gap_m, c.force = 1;
  test::Iterate iterate = {scene.length_m(k), {}, {}, {}};
  for (uint32_t n = 0; n < 3; ++n) iterate.move[n] = scene.at(i, simd::kRodMove + n, k);
  for (uint32_t n = 0; n < 4; ++n) {
    iterate.now[n] = scene.at(i, simd::kRodNow + n, k);
    iterate.before[n] = scene.at(i, simd::kRodTurn + n, k);
  }
  return test::plain_look(c, iterate);
}

// Also of zeros.
bool same_bits(const Expected& e, const test::Looked& look, const simd::RodTouches& t, uint32_t k) {
  const auto is_in = [&](double value, size_t row) {
    return std::bit_cast<uint64_t>(value) == std::bit_cast<uint64_t>(t.rows[row][k]);
  };
  bool same = is_in(e.along_m, simd::kTouchAlong) && is_in(e.gap_m, simd::kTouchGap) &&
              is_in(e.depth_m, simd::kTouchDepth) && is_in(look.open_m, simd::kTouchOpen);
  for (size_t i = 0; i < 3; ++i) {
    same = same && is_in(e.axis[i], simd::kTouchAxis + i) && is_in(e.normal[i], simd::kTouchNormal + i) &&
           is_in(e.move[i], simd::kTouchMove + i) && is_in(look.slip_m[i], simd::kTouchSlip + i);
  }
  return same;
}

struct Found {
  int wrong = 0, differ = 0, ordinary = 0, other = 0, none = 0;
};

// `asked` lanes of every segment against one obstacle.
void compare(const simd::Kernels& kernels, test::LaneScene& scene, const Sweep& obstacle, uint32_t asked,
             Found* found) {
  simd::RodRound round = test::round_of(obstacle);
  for (size_t k = 0; k < 3; ++k)
    round.linear_m_s[k] = 0.3 * static_cast<double>(k), round.angular_rad_s[k] = 2;
  const simd::RodReachJob job = scene.job(scene.width());
  for (uint32_t i = 0; i < scene.segments(); ++i) {
    simd::RodTouches touches;
    test::touch_calls(kernels, scene.width()).touch(job, round, i, asked, &touches);
    for (uint32_t k = 0; k < scene.width(); ++k) {
      const bool one = touches.touch >> k & 1, other = touches.other >> k & 1;
      const Expected e = expected(scene.sweep(i, k), obstacle, round);
      const bool touch = e.touches && (asked >> k & 1);
      found->wrong += (one || other) != touch || (touch && one != e.ordinary);
      found->differ += one && !same_bits(e, looked(scene, i, k, e), touches, k);
      found->ordinary += one, found->other += other, found->none += !touch;
    }
  }
}

// Anywhere near the strands; some stand, some go.
Sweep any_capsule(test::LaneScene& scene, double far_m, float way_m) {
  const Vector from = scene.any_place(far_m, 1.5f), to = scene.any_place(far_m, 1.5f);
  const Vector by = scene.any_place(0, way_m);
  return {{from, to}, {rods::sum(from, by), rods::sum(to, by)}, static_cast<double>(scene.any(0.05f, 0.5f))};
}

}  // namespace

TEST_CASE("touches_found_a_strand_a_lane_have_the_bits_of_those_found_one_at_a_time") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    for (const uint32_t width : {16u, 4u}) {
      Found found;
      for (uint32_t run = 0; run < 40; ++run) {
        const float way_m = run % 4 == 0 ? 0 : run % 4 == 1 ? 0.01f : run % 4 == 2 ? 0.3f : 3;
        const double far_m = run % 3 == 0 ? 0 : run % 3 == 1 ? -7 : 3e4;
        test::LaneScene scene(width, 5, far_m, way_m, run);
        const Sweep capsule = any_capsule(scene, far_m, way_m);
        compare(kernels, scene, capsule, ~0u, &found);
        const Sweep sphere = {
            {capsule.start.from, capsule.start.from}, {capsule.end.from, capsule.end.from}, capsule.radius_m};
        compare(kernels, scene, sphere, 0x5a69, &found);
      }
      INFO("groups of " << width);
      CHECK(found.wrong == 0);
      CHECK(found.differ == 0);
      CHECK((found.ordinary > 100 && found.other > 5 && found.none > 1000));
    }
  });
}

TEST_CASE("touches_in_lanes_of_what_is_degenerate_are_left_to_the_other_way_or_have_its_bits") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    for (const uint32_t width : {16u, 4u}) {
      test::LaneScene scene(width, 3, 0, 0.01f, 11);
      const auto z = [&](uint32_t k) {
        const Axis a = scene.sweep(0, k).start;
        return rods::difference(a.to, a.from);
      };
      Found found;
      for (uint32_t k = 0; k < width; ++k) {
        const Axis own = scene.sweep(0, k).start;
        const Vector middle = at(own, 0.5), beside = {0.02, 0, 0};
        const std::vector<Axis> axes = {
            own,                                                            // the segment's own
            {middle, rods::sum(middle, beside)},                            // begins on it
            {rods::difference(middle, beside), rods::sum(middle, beside)},  // crosses it
            {rods::sum(own.from, beside), rods::sum(own.to, beside)},       // parallel
            {own.to, rods::sum(own.to, z(k))},                              // in line
            {own.to, own.to},                                               // its end
            {middle, middle},                                               // on its axis
            {rods::sum(middle, {0, 1e-9, 0}), rods::sum(middle, {0, 1e-9, 1e-40})}};
        for (const Axis& axis : axes) {
          for (const double radius : {1e-6, 0.02, 0.5})
            compare(kernels, scene, {axis, axis, radius}, ~0u, &found);
          // On its way through the segment.
          const Vector before = {0, -1, 0}, after = {0, 1, 0};
          compare(kernels, scene,
                  {{rods::sum(axis.from, before), rods::sum(axis.to, before)},
                   {rods::sum(axis.from, after), rods::sum(axis.to, after)},
                   0.02},
                  ~0u, &found);
        }
      }
      CHECK(found.wrong == 0);
      CHECK(found.differ == 0);
      CHECK(found.other > 50);
    }
  });
}

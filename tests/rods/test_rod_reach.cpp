// test_rod_reach.cpp  Which segments may touch: never too few, and not many more.
#include <catch2/catch.hpp>

#include "tests/rods/lane_scenes.hpp"
#include "tests/simd/every_isa.hpp"

using namespace sinew;
using rods::Axis;
using rods::Sweep;
using rods::Vector;

namespace {

// A contact is kept within this share of ways and radii (kernels/rod_contacts/rod_touch_job.hpp), on top of
// them.
constexpr double kKept = 1.25;
// What a bound may be above the truth, of radii and ways: rounding in float, 2e-6 of coordinates, and what
// ways are bounded by: the sum of move and turn, by a chord, for at most the way of an end and that of the
// other.
constexpr double kBound = 2.5;
// Of coordinates and sizes, twice what is allowed for.
constexpr double kRounding = 4e-6;

double distance(const Axis& a, const Axis& b) {
  const rods::Nearest n = rods::nearest(a, b);
  return rods::length(rods::difference(rods::between(a.from, a.to, n.a), rods::between(b.from, b.to, n.b)));
}

double longest_way(const Sweep& s) {
  return std::max(rods::length(rods::difference(s.end.from, s.start.from)),
                  rods::length(rods::difference(s.end.to, s.start.to)));
}

struct Told {
  int missed = 0, needless = 0, near = 0, far = 0, behind = 0;
};

bool told(const std::vector<uint16_t>& lanes, uint32_t i, uint32_t k) { return lanes[i] >> k & 1; }

Sweep any_round(test::LaneScene& scene, double far_m, float way_m, bool point, float radius_m) {
  const Vector from = scene.any_place(far_m, 3), to = point ? from : scene.any_place(far_m, 3);
  const Vector by = scene.any_place(0, way_m);
  return {{from, to}, {rods::sum(from, by), rods::sum(to, by)}, static_cast<double>(radius_m)};
}

// From being looked at.
double just_apart(const Sweep& own, const Sweep& round) {
  const double ways = longest_way(own) + longest_way(round), radii = kKept * own.radius_m + round.radius_m;
  return distance(own.start, round.start) - radii - kKept * ways;
}

// Of all but the last strand.
void compare(const simd::Kernels& kernels, test::LaneScene& scene, const Sweep& round, Told* out) {
  const simd::RodReachJob job = scene.job(scene.width() - 1);
  const simd::RodTouchCalls& calls = test::touch_calls(kernels, scene.width());
  std::vector<uint16_t> lanes(scene.segments(), 0xffff);
  const double rounding_m = kRounding * (10 + round.radius_m + 3 * rods::length(round.start.from));
  calls.reach(job);
  calls.near_round(job, test::round_of(round), lanes.data());
  for (uint32_t i = 0; i < scene.segments(); ++i) {
    for (uint32_t k = 0; k + 1 < scene.width(); ++k) {
      const Sweep own = scene.sweep(i, k);
      const double ways = longest_way(own) + longest_way(round), radii = own.radius_m + round.radius_m;
      const double apart = distance(own.start, round.start) - radii;
      const bool near = apart < (kKept - 1) * own.radius_m + kKept * ways;
      out->missed += near && !told(lanes, i, k);
      const double length_m = rods::length(rods::difference(own.start.to, own.start.from));
      // Along an obstacle's axis the bound is a tangent's, off by less than the segment's own length.
      const bool point = round.start.from == round.start.to;
      const bool far = apart > kBound * (own.radius_m + ways) + (point ? 0 : length_m) + rounding_m;
      out->needless += far && told(lanes, i, k);
      out->near += near, out->far += far;
    }
    out->behind += told(lanes, i, scene.width() - 1);
  }
}

}  // namespace

TEST_CASE("no_segment_that_may_touch_something_round_is_left_out_and_few_are_looked_at_for_nothing") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    for (const uint32_t width : {16u, 4u}) {
      Told out;
      for (uint32_t run = 0; run < 240; ++run) {
        const float way_m = run % 4 == 0 ? 0 : run % 4 == 1 ? 0.003f : run % 4 == 2 ? 0.1f : 2;
        const double far_m = run % 5 == 0 ? -4e3 : 0;
        test::LaneScene scene(width, 6, far_m, way_m, run);
        // Thin, ordinary, and as large as a planet whose surface is near.
        const bool point = run % 2 == 0;
        const float radius_m = run % 3 == 0 ? 1e-4f : 0.4f;
        compare(kernels, scene, any_round(scene, far_m, way_m, point, radius_m), &out);
        Sweep planet = any_round(scene, far_m, way_m, point, 6e3f);
        for (Vector* v : {&planet.start.from, &planet.start.to, &planet.end.from, &planet.end.to}) {
          (*v)[1] -= 6e3;
        }
        compare(kernels, scene, planet, &out);
        // As large as just touches one of them, so that roundings count.
        planet.radius_m += just_apart(scene.sweep(0, 0), planet) + 1e-7;
        compare(kernels, scene, planet, &out);
      }
      INFO("groups of " << width);
      CHECK(out.missed == 0);
      CHECK(out.needless == 0);
      CHECK(out.behind == 0);
      CHECK((out.near > 500 && out.far > 500));
    }
  });
}

TEST_CASE("what_is_held_is_never_looked_at_and_beside_what_leaves_floats_range_all_else_is") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    test::LaneScene scene(16, 2, 0, 0.1f, 3);
    scene.at(0, simd::kRodFree, 4) = 0;
    const simd::RodReachJob job = scene.job(16);
    const simd::RodTouchCalls& calls = kernels.rod_touches->wide;
    const std::vector<uint16_t> all = {0xffef, 0xffff};
    std::vector<uint16_t> lanes(2);
    calls.reach(job);
    for (const double radius_m : {100.0, 1e30, 1e60}) {
      const Axis axis = {{0, -radius_m, 0}, {0.1 * radius_m, -radius_m, 0}};
      for (const Axis& one : {axis, Axis{axis.from, axis.from}}) {
        CHECK(calls.near_round(job, test::round_of({one, one, 1.2 * radius_m}), lanes.data()));
        CHECK(lanes == all);
      }
      simd::RodFlat flat = {{0, radius_m, 0}, {0, 1, 0}, 0, 0};
      CHECK(calls.near_flat(job, flat, lanes.data()));
      CHECK(lanes == all);
      flat.point_m[1] = -50;
      CHECK_FALSE(calls.near_flat(job, flat, lanes.data()));
    }
  });
}

TEST_CASE("no_segment_that_a_plane_may_reach_is_left_out_and_few_are_looked_at_for_nothing") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    for (const uint32_t width : {16u, 4u}) {
      int missed = 0, needless = 0, near_ones = 0, far_ones = 0;
      for (uint32_t run = 0; run < 120; ++run) {
        const float way_m = run % 3 == 0 ? 0 : run % 3 == 1 ? 0.01f : 0.3f;
        const double far_m = run % 5 == 0 ? -4e3 : 0;
        test::LaneScene scene(width, 6, far_m, way_m, run);
        const Vector p = scene.any_place(far_m, 1), up = scene.any_place(0, 1),
                     n = rods::scaled(1 / rods::length(up), up);
        const double moved = static_cast<double>(way_m);
        const simd::RodFlat flat = {{p[0], p[1], p[2]}, {n[0], n[1], n[2]}, moved, 0};
        const simd::RodReachJob job = scene.job(width);
        std::vector<uint16_t> lanes(6);
        test::touch_calls(kernels, width).reach(job);
        test::touch_calls(kernels, width).near_flat(job, flat, lanes.data());
        for (uint32_t i = 0; i < 6; ++i) {
          for (uint32_t k = 0; k < width; ++k) {
            const Sweep own = scene.sweep(i, k);
            const auto height = [&](const Vector& at) { return rods::dot(rods::difference(at, p), n); };
            const double least = std::min(height(own.start.from), height(own.start.to)) - own.radius_m;
            const double ways = longest_way(own) + moved;
            const bool near = least < (kKept - 1) * own.radius_m + kKept * ways;
            const bool far = least > kBound * (own.radius_m + ways) + 0.001;
            missed += near && !told(lanes, i, k), needless += far && told(lanes, i, k);
            near_ones += near, far_ones += far;
          }
        }
      }
      INFO("groups of " << width);
      CHECK(missed == 0);
      CHECK(needless == 0);
      CHECK((near_ones > 500 && far_ones > 500));
    }
  });
}

TEST_CASE("no_way_to_the_iterate_leads_into_a_core_unseen") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    for (const uint32_t width : {16u, 4u}) {
      int entered = 0, missed = 0, clear = 0;
      for (uint32_t run = 0; run < 120; ++run) {
        const float way_m = run % 3 == 0 ? 0.01f : 0.5f;
        test::LaneScene scene(width, 6, 0, way_m, run);
        const simd::RodReachJob job = scene.job(width);
        const simd::RodTouchCalls& calls = test::touch_calls(kernels, width);
        const Sweep rounds[2] = {any_round(scene, 0, 0, true, 0.3f), any_round(scene, 0, way_m, false, 0.3f)};
        std::vector<uint16_t> near(6), lanes(6);
        calls.reach(job);
        for (const Sweep& round : rounds) calls.near_round(job, test::round_of(round), near.data());
        calls.enter(job, lanes.data());
        for (uint32_t i = 0; i < 6; ++i) {
          for (uint32_t k = 0; k < width; ++k) {
            Sweep own = scene.taken(i, k);
            bool enters = false;
            for (Sweep round : rounds) {
              round.radius_m = 0.5 * (own.radius_m + round.radius_m);  // its core
              Sweep axis = own;
              axis.radius_m = 0;
              enters = enters || rods::first_touch(axis, round, 256).gap_m < 0;
            }
            entered += enters, missed += enters && !told(lanes, i, k), clear += !told(lanes, i, k);
          }
        }
      }
      INFO("groups of " << width);
      CHECK(missed == 0);
      INFO(entered << " enter, " << clear << " may not");
      CHECK((entered > 20 && clear > 1000));
    }
  });
}

// Every other ball is far off in a segment's own direction and thinner than it: its box leaves the least
// there.
TEST_CASE("a_straight_way_into_a_core_is_seen_however_short_of_it_free_motion_ends") {
  test::for_every_isa([](const char*, const simd::Kernels& kernels) {
    for (uint32_t run = 0; run < 40; ++run) {
      test::LaneScene scene(4, 1, 0, 0, run);
      const bool ahead = run % 2 == 0;
      for (uint32_t k = 0; ahead && k < 4; ++k) {
        for (const uint32_t turn : {simd::kRodTurn, simd::kRodFreeTurn, simd::kRodNow})
          scene.at(0, turn + k, 0) = k == 3 ? 1 : 0;
      }
      const Vector end = scene.sweep(0, 0).start.to;
      const Vector ball = ahead ? rods::sum(end, Vector{0, 0, 5}) : scene.any_place(0, 2);
      const Sweep round = {{ball, ball}, {ball, ball}, ahead ? 0.0005 : 0.01};
      const Axis own = scene.sweep(0, 0).start;
      const double share = rods::nearest(own, ball);
      const Vector way = rods::difference(ball, rods::between(own.from, own.to, share));
      const simd::RodReachJob job = scene.job(4);
      const simd::RodTouchCalls& calls = kernels.rod_touches->narrow;
      uint16_t lanes = 0;
      for (uint32_t k = 0; k < 3; ++k) scene.at(0, simd::kRodMove + k, 0) = 0;
      calls.reach(job);
      calls.near_round(job, test::round_of(round), &lanes);
      const double apart_m = rods::length(way), core_m = 0.5 * (round.radius_m + scene.radius_m(0, 0));
      for (uint32_t k = 0; k < 3; ++k) {
        scene.at(0, simd::kRodMove + k, 0) =
            static_cast<float>((1.0001 - core_m / apart_m) * way[k] / scene.length_m(0));
      }
      INFO("run " << run << ", " << apart_m << " m away");
      CHECK(calls.enter(job, &lanes));
      CHECK((lanes & 1) == 1);
    }
  });
}

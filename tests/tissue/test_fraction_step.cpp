// test_fraction_step.cpp  Fractions of a tick: at both ends the ticks' own values, and one slope through
// them.
#include "tissue/frames/fraction_step.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <utility>

#include "baker/pack/character/modes_pack.hpp"
#include "tests/simd/test_data.hpp"
#include "tissue/modes/retuned.hpp"

using namespace sinew;

namespace {

constexpr double kTick_s = 1.0 / 60;

// One node, one mode along x, and a rest along y that answers with half of what it feels.
struct Point {
  std::vector<pack::ModeRecord> modes;
  test::Floats shape{16}, turn{16}, response{3 * 32}, project{3 * 16};
  tissue::SwingSlopes slopes[2];
  float q[2] = {}, r[2][3] = {};
  float force_q = 0, added_q = 0, off_q = 0, force_r[3] = {}, added_r[3] = {}, off_r[3] = {};
  float rest_a1 = 0.9f, rest_a2 = -0.35f;

  Point(double hz, double damping_ratio) {
    const baker::Recurrence mode = baker::modal_recurrence(2 * M_PI * hz, damping_ratio, 1 / kTick_s);
    modes.push_back({static_cast<float>(2 * M_PI * hz),
                     static_cast<float>(damping_ratio),
                     mode.a1,
                     mode.a2,
                     mode.gain,
                     {}});
    shape[0] = response[16] = 1;
    response[32 + 1] = 0.5f;
    slopes[0] = tissue::swing_slopes(mode.a1, mode.a2);
    slopes[1] = tissue::swing_slopes(rest_a1, rest_a2);
  }
  tissue::ModalBase base() {
    return {modes,
            1,
            16,
            16,
            shape.data(),
            turn.data(),
            response.data(),
            project.data(),
            rest_a1,
            rest_a2,
            1 - rest_a1 - rest_a2};
  }
  tissue::TickForce force() { return {&force_q, force_r, &added_q, added_r, &off_q, off_r}; }
  void hear(double x_m_s2, double y_m_s2, float* heard) {
    const float felt[3] = {static_cast<float>(x_m_s2), static_cast<float>(y_m_s2), 0}, none[3] = {};
    float e[3];
    tissue::modal_hear(base(), felt, none, e, heard);
  }
  // A tick, which adds so much to the mode.
  void tick(double x_m_s2, double y_m_s2, float added = 0) {
    test::Floats heard(32), l(16);
    hear(x_m_s2, y_m_s2, heard.data());
    tissue::take_force(base(), heard.data(), force());
    float q_next, r_next[3];
    tissue::modal_answer(base(), heard.data(), {&q[0], &q[1], r[0], r[1]}, {&q_next, r_next, l.data()});
    q[1] = q[0];
    q[0] = q_next + added;
    off_q = added_q - added;
    added_q = added;
    std::copy_n(r[0], 3, r[1]);
    std::copy_n(r_next, 3, r[0]);
  }
  // l along x and y.
  std::array<double, 2> at(double x, double x_m_s2, double y_m_s2) {
    test::Floats heard(32), l(16);
    if (x > 0) hear(x_m_s2, y_m_s2, heard.data());
    float q_now, r_now[3];
    tissue::fraction_answer(base(), slopes, heard.data(), {&q[0], &q[1], r[0], r[1]}, force(),
                            static_cast<float>(x), {&q_now, r_now, l.data()});
    return {double{l[0]}, double{l[1]}};
  }
};

// What is felt of a path of places, by a fraction of the tick that ends at tick + 1
// (tissue/frames/node_drive.hpp).
double felt(const std::function<double(double)>& place, double tick, double x) {
  return -(place(tick + x) - (1 + x) * place(tick) + x * place(tick - 1)) / (kTick_s * kTick_s);
}

double path(double tick) { return 0.1 * std::sin(0.21 * tick) + 0.02 * std::sin(0.6 * tick + 1); }

}  // namespace

TEST_CASE("slopes_are_those_of_a_free_swing") {
  for (const double hz : {0.5, 4.0, 8.0, 14.0}) {
    const double w = 2 * M_PI * hz * kTick_s, zeta = 0.15, damped = w * std::sqrt(1 - zeta * zeta);
    const baker::Recurrence mode = baker::modal_recurrence(2 * M_PI * hz, zeta, 1 / kTick_s);
    const tissue::SwingSlopes slopes = tissue::swing_slopes(mode.a1, mode.a2);
    CHECK(double{slopes.of_now} == Approx(damped / std::tan(damped) - zeta * w).margin(2e-4));
    CHECK(double{slopes.of_before} == Approx(-std::exp(-zeta * w) * damped / std::sin(damped)).margin(2e-4));
  }
}

TEST_CASE("slopes_of_any_stable_recurrence_are_finite") {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    const float a2 = test::uniform(random, -1, 1), a1 = (1 - a2) * test::uniform(random, -1, 1);
    const tissue::SwingSlopes slopes = tissue::swing_slopes(a1, a2);
    CHECK((std::isfinite(slopes.of_now) && std::isfinite(slopes.of_before)));
  }
  CHECK(std::isfinite(tissue::swing_slopes(0, 0).of_now));
}

TEST_CASE("a_whole_fraction_is_the_tick_and_none_is_the_last_one") {
  for (const double hz : {1.0, 5.5, 9.0}) {
    Point point(hz, 0.1);
    for (int t = 0; t < 40; ++t) {
      const double now = felt(path, t, 1), across = 2 * now;
      const auto begins = point.at(0, 0, 0), ends = point.at(1, now, across);
      CHECK(begins[0] == Approx(double{point.q[0]}).margin(1e-7));
      CHECK(begins[1] == Approx(double{point.r[0][1]}).margin(1e-7));
      point.tick(now, across);
      CHECK(ends[0] == Approx(double{point.q[0]}).margin(1e-7));
      CHECK(ends[1] == Approx(double{point.r[0][1]}).margin(1e-6));
    }
  }
}

// Of what is moved without being turned: the velocity at which a tick's fractions end is that at which the
// next one's begin.
TEST_CASE("place_and_velocity_go_on_through_ticks") {
  constexpr double kStep = 2e-3;
  for (const double hz : {1.0, 5.5, 9.0}) {
    Point point(hz, 0.1);
    for (int t = 0; t < 60; ++t) {
      const auto velocity = [&](double from, double tick) {
        const auto a = point.at(from, felt(path, tick, from), 2 * felt(path, tick, from)),
                   b = point.at(from + kStep, felt(path, tick, from + kStep),
                                2 * felt(path, tick, from + kStep));
        return std::array<double, 2>{(b[0] - a[0]) / kStep, (b[1] - a[1]) / kStep};
      };
      const auto before = velocity(1 - kStep, t);
      point.tick(felt(path, t, 1), 2 * felt(path, t, 1));
      const auto after = velocity(0, t + 1);
      if (t < 20) continue;
      INFO(hz << " Hz, tick " << t);
      // What velocity changes by in the two thousandths of a tick between where it is measured, and
      // roundings.
      for (size_t k = 0; k < 2; ++k)
        CHECK(std::abs(after[k] - before[k]) < 0.02 * (std::abs(before[k]) + double{k == 0 ? 0.01f : 1.0f}));
    }
  }
}

TEST_CASE("what_a_constant_force_holds_does_not_move") {
  Point point(5.5, 0.1);
  for (int t = 0; t < 2000; ++t) point.tick(3, 3);
  for (const double x : {0.1, 0.3, 0.5, 0.8}) {
    // Of a constant force a fraction hears so much (tissue/frames/node_drive.hpp).
    const double heard = 3 * x * (1 + x) / 2;
    const auto at = point.at(x, heard, heard);
    CHECK(at[0] == Approx(double{point.q[0]}).epsilon(1e-4));
    CHECK(at[1] == Approx(double{point.r[0][1]}).epsilon(1e-4));
  }
}

// A network's corrections, of which each tick's is another one.
TEST_CASE("what_is_added_anew_is_taken_in_within_the_tick") {
  constexpr double kStep = 1e-3;
  Point point(4, 0.1);
  for (int t = 0; t < 30; ++t) {
    const auto ends = point.at(1, 0, 0), before = point.at(1 - kStep, 0, 0);
    point.tick(0, 0, 1e-3f * static_cast<float>(std::sin(0.5 * t)));
    const auto begins = point.at(0, 0, 0), after = point.at(kStep, 0, 0);
    CHECK(begins[0] == Approx(ends[0]).margin(1e-7));
    CHECK((after[0] - begins[0]) / kStep == Approx((ends[0] - before[0]) / kStep).margin(1e-4));
    const double off = double{std::exchange(point.off_q, 0.0f)};
    const auto without = point.at(1, 0, 0);
    point.off_q = static_cast<float>(off);
    CHECK(point.at(1, 0, 0)[0] == without[0]);
  }
}

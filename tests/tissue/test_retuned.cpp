// test_retuned.cpp  Modes that are stiffer or damped otherwise than they were baked.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tissue/modes/retuned.hpp"

using namespace sinew;
using tissue::Recurrence;
using tissue::Retuning;

namespace {

constexpr float kTick_s = 1.0f / 60;

// As a baker makes it.
pack::ModeRecord mode(double hz, double zeta) {
  const double w = 2 * std::numbers::pi * hz, turn = w / 60, r = std::exp(-zeta * turn);
  pack::ModeRecord made{};
  made.rad_per_s = static_cast<float>(w);
  made.damping_ratio = static_cast<float>(zeta);
  made.a1 = static_cast<float>(2 * r * std::cos(std::sqrt(1 - zeta * zeta) * turn));
  made.a2 = static_cast<float>(-r * r);
  made.gain = (1 - made.a1 - made.a2) / (made.rad_per_s * made.rad_per_s);
  return made;
}

bool is_stable(float a1, float a2) { return std::abs(a1) < 1 - a2 && a2 > -1; }

}  // namespace

// A recurrence in floats.
TEST_CASE("a_mode_of_the_baked_numbers_is_the_baked_one") {
  for (const double hz : {0.5, 3.5, 9.0, 20.0, 29.0}) {
    const pack::ModeRecord baked = mode(hz, 0.1), same = tissue::retuned(baked, {}, kTick_s);
    CHECK(same.a1 == Approx(baked.a1).margin(1e-6));
    CHECK(same.a2 == Approx(baked.a2).margin(1e-6));
    CHECK(same.gain == Approx(baked.gain).epsilon(1e-3));
    const Recurrence told = tissue::retuned(Recurrence{baked.a1, baked.a2}, {});
    CHECK(told.a1 == Approx(baked.a1).margin(1e-5));
    CHECK(told.a2 == Approx(baked.a2).margin(1e-5));
  }
}

TEST_CASE("a_mode_s_frequency_goes_with_the_root_of_its_stiffness_and_its_load_with_its_inverse") {
  const pack::ModeRecord changed = tissue::retuned(mode(3, 0.1), {.stiffness = 4, .damping = 2}, kTick_s);
  const pack::ModeRecord right = mode(6, 0.2);
  CHECK(changed.a1 == Approx(right.a1).margin(1e-6));
  CHECK(changed.a2 == Approx(right.a2).margin(1e-6));
  const auto held = [](const pack::ModeRecord& m) { return m.gain / (1 - m.a1 - m.a2); };
  CHECK(held(changed) == Approx(held(mode(3, 0.1)) / 4).epsilon(1e-4));
}

TEST_CASE("a_mode_is_stable_at_every_extreme") {
  for (const double hz : {0.3, 3.5, 12.0, 29.0, 80.0})
    for (const float stiffness : {0.01f, 0.3f, 1.0f, 5.0f, 100.0f})
      for (const float damping : {0.0f, 1.0f, 7.0f, 100.0f})
        for (const float stiffens : {0.0f, 0.12f, 1.0f}) {
          const Retuning by{stiffness, damping, stiffens};
          const pack::ModeRecord m = tissue::retuned(mode(hz, 0.1), by, kTick_s);
          INFO(hz << " Hz, " << stiffness << ", " << damping << ": " << m.a1 << " " << m.a2);
          CHECK(is_stable(m.a1, m.a2));
          CHECK((m.gain > 0 && std::isfinite(m.gain)));
          const Recurrence rest = tissue::retuned(Recurrence{mode(hz, 0.1).a1, mode(hz, 0.1).a2}, by);
          CHECK(is_stable(rest.a1, rest.a2));
        }
  const Recurrence at_once = tissue::retuned(Recurrence{0, 0}, {.stiffness = 0.1f});
  CHECK((at_once.a1 == 0 && at_once.a2 == 0));
}

// Half the tick's rate: beyond it a mode answers at once.
TEST_CASE("a_mode_that_becomes_too_fast_gets_there_without_a_step") {
  const pack::ModeRecord baked = mode(20, 0.1);
  pack::ModeRecord last = tissue::retuned(baked, {}, kTick_s);
  for (float stiffness = 1; stiffness < 3; stiffness += 0.01f) {
    const pack::ModeRecord now = tissue::retuned(baked, {.stiffness = stiffness}, kTick_s);
    CHECK(std::abs(now.a1 - last.a1) < 0.05f);
    CHECK(std::abs(now.a2 - last.a2) < 0.05f);
    last = now;
  }
  CHECK((last.a1 == 0 && last.a2 > -1e-6f));
}

// test_correction_budget.cpp  Whatever a network says, a region swings on little more than its modal base.
#include "tissue/modes/correction_budget.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "baker/pack/character/modes_pack.hpp"
#include "tissue/modes/retuned.hpp"

using namespace sinew;

namespace {

constexpr size_t kRegions = 4000;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

enum class Saying { kNoise, kPushes, kHuge, kNotFinite, kCount };

// Modes, what corrections have moved them by, and a base that is driven for a while and then let go.
struct Region {
  explicit Region(uint32_t seed) : random(seed) {
    // Ten to two hundred ticks a swing and beyond: 0.05 to 20 Hz, damped by 0.01 to 0.5.
    const double first_hz = std::exp(uniform(std::log(0.05), std::log(20.0)));
    const size_t modes = 1 + random() % 8;
    for (size_t m = 0; m < modes; ++m) {
      const double hz = std::min(first_hz * (1 + 0.7 * static_cast<double>(m)), 25.0);
      const double ratio = uniform(0.01, 0.5), rad_per_s = 2 * M_PI * hz;
      const baker::Recurrence r = baker::modal_recurrence(rad_per_s, ratio, 60);
      records.push_back({static_cast<float>(rad_per_s), static_cast<float>(ratio), r.a1, r.a2, r.gain, {}});
    }
    slowest_damping = std::ranges::max(records, {}, [](const auto& mode) { return -mode.a2; }).a2 * -1;
    for (auto* values : {&base, &base_before, &d, &d_before, &p}) values->resize(modes);
  }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  }
  float gauss() { return std::normal_distribution<float>()(random); }

  void say(Saying saying) {
    for (size_t m = 0; m < p.size(); ++m) {
      const float moves = d[m] - d_before[m], away = d[m];
      p[m] = saying == Saying::kNoise    ? 0.1f * gauss()
             : saying == Saying::kPushes ? 10 * moves + away + 1e-3f
             : saying == Saying::kHuge   ? 1e6f * gauss()
                                         : (random() % 2 ? kNan : kInfinity);
    }
  }
  // Returns the largest force, so that units do not matter.
  void tick(bool driven, Saying saying) {
    std::vector<float> now = base;
    for (size_t m = 0; m < records.size(); ++m) {
      const float force = driven ? gauss() / records[m].gain * (1 - records[m].a1 - records[m].a2) : 0.0f;
      now[m] = records[m].a1 * base[m] + records[m].a2 * base_before[m] + records[m].gain * force;
    }
    base_before = base;
    base = now;
    say(saying);
    share = tissue::bounded_share({.modes = records,
                                   .base = base.data(),
                                   .d = d.data(),
                                   .d_before = d_before.data(),
                                   .correction = p.data(),
                                   .pose_stays = !driven},
                                  &swing);
    for (size_t m = 0; m < records.size(); ++m) {
      const float goes_on = records[m].a1 * d[m] + records[m].a2 * d_before[m];
      d_before[m] = d[m];
      d[m] = goes_on + (share > 0 ? share * p[m] : 0);
    }
  }
  double energy() const {
    double sum = 0;
    for (size_t m = 0; m < records.size(); ++m) {
      const double a1 = double{records[m].a1}, a2 = double{records[m].a2}, x = double{d[m]},
                   y = double{d_before[m]};
      sum += (x * x - a1 * x * y - a2 * y * y) / (1 - a1 - a2);
    }
    return sum;
  }

  std::mt19937 random;
  std::vector<pack::ModeRecord> records;
  std::vector<float> base, base_before, d, d_before, p;
  float swing = 0, share = 0;
  float slowest_damping = 0;
};

// Rounding of a1 and a2 to float leaves a slow mode's 1 - a1 - a2 (2e-5 at 0.05 Hz) off by some hundredths.
constexpr double kSlack = 1.1;
constexpr double kSquared = double{tissue::kMostCorrection} * double{tissue::kMostCorrection};

}  // namespace

TEST_CASE("a_correction_that_is_not_finite_takes_no_share") {
  Region region(1);
  for (int t = 0; t < 30; ++t) region.tick(true, Saying::kNoise);
  for (int t = 0; t < 30; ++t) {
    region.tick(true, Saying::kNotFinite);
    CHECK(region.share == 0);
    CHECK(std::isfinite(region.swing));
  }
}

TEST_CASE("a_small_correction_beside_a_large_swing_is_taken_whole") {
  Region region(2);
  for (int t = 0; t < 30; ++t) region.tick(true, Saying::kNoise);
  std::ranges::fill(region.d, 0.0f);
  std::ranges::fill(region.d_before, 0.0f);
  region.swing = 1e6f;
  region.tick(true, Saying::kNoise);
  CHECK(region.share == 1);
}

TEST_CASE("without_a_swing_there_is_no_correction") {
  Region region(3);
  region.tick(false, Saying::kHuge);
  CHECK(region.share == 0);
  CHECK(region.swing == 0);
}

// 0.05 to 20 Hz: noise, pushes along the motion, numbers of 1e6.
TEST_CASE("corrections_keep_their_budget_whatever_a_network_says") {
  double most = 0;
  for (uint32_t seed = 0; seed < kRegions; ++seed) {
    Region region(seed);
    const auto saying = static_cast<Saying>(seed % static_cast<uint32_t>(Saying::kNotFinite));
    for (int t = 0; t < 120; ++t) {
      region.tick(true, saying);
      if (region.swing > 0) most = std::max(most, region.energy() / (kSquared * double{region.swing}));
    }
  }
  WARN("largest energy of corrections over their budget " << most);
  CHECK(most <= kSlack);
  CHECK(most > 0.5);  // the budget was felt
}

// With the base it comes to rest: no energy is added once the pose stays, and what is left falls by L a tick.
TEST_CASE("corrections_vanish_at_the_base_s_pace_once_the_pose_stays") {
  for (uint32_t seed = 0; seed < kRegions; ++seed) {
    Region region(seed);
    const auto saying = static_cast<Saying>(seed % static_cast<uint32_t>(Saying::kNotFinite));
    for (int t = 0; t < 60; ++t) region.tick(true, saying);
    const double at_first = kSquared * double{region.swing};
    for (int t = 1; t <= 300; ++t) region.tick(false, saying);
    const double bound = at_first * std::pow(double{region.slowest_damping}, 300);
    INFO("seed " << seed);
    REQUIRE(region.energy() <= kSlack * bound + 1e-20 * at_first);
  }
}

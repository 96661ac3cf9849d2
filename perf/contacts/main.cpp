// main.cpp  What contacts cost: hair on a head, with a collider and without, as CSV.
//
// One thread's CPU time. 1,000 strands of 16 segments at 60 Hz after three seconds, then two seconds:
// `still`, and `turning` to and fro. Without a collider the same hair hangs through the head. `over_rods` is
// what the collider adds over what the rods cost alone, of the medians of a step. --rods: of 200 strands,
// with one another too; --long: 25 seconds, for the deepest; --quick: that everything runs.
#include <cstdio>
#include <cstring>

#include "perf/scale/stopwatch.hpp"
#include "rods/default_settings.hpp"
#include "simd/isa.hpp"
#include "tests/scenes/hair_on_head.hpp"

namespace sinew::perf {
namespace {

enum class With { kNothing, kHead, kFarPlane, kHeadAndRods };
constexpr const char* kNames[] = {"nothing", "head", "far plane", "head and rods"};

struct Result {
  double step_us = 0, iterations = 0, contacts = 0, unconverged = 0, contacts_unconverged = 0, deepest = 0;
};

constexpr float kStep_s = 1.0f / 60;
constexpr int kSettle = 180;

Status place(With with, double velocity_rad_s, rods::RodCollider* collider) {
  const rods::Plane floor = {.point_m = {0, -10, 0}};
  if (with == With::kFarPlane) return collider->set_planes({&floor, 1});
  return test::HairOnHead::put(collider, velocity_rad_s);
}

Result measure(const test::HairOnHead& hair, With with, bool turning, int steps) {
  rods::RodBatch batch =
      hair.batch(rods::default_settings({.segments = 16, .young_pa = 1e6f, .contacts = true}));
  rods::RodCollider collider;
  if (!rods::RodCollider::create(batch, {.rods_collide = with == With::kHeadAndRods}, &collider).ok())
    return {};
  Result out;
  std::vector<double> times;
  for (int i = 0; i < kSettle + steps; ++i) {
    const double now = i * static_cast<double>(kStep_s), then = now + static_cast<double>(kStep_s);
    const double speed =
        (hair.angle(then, turning) - hair.angle(now, turning)) / static_cast<double>(kStep_s);
    if (turning) hair.turn(&batch, then);
    if (with != With::kNothing && !place(with, speed, &collider).ok()) return {};
    rods::RodReport report;
    const double begin = clock_us(CLOCK_THREAD_CPUTIME_ID);
    const Status status = batch.step(kStep_s, with == With::kNothing ? nullptr : &collider, &report);
    const double us = clock_us(CLOCK_THREAD_CPUTIME_ID) - begin;
    if (!status.ok() || i < kSettle) continue;
    times.push_back(us);
    out.iterations += static_cast<double>(report.iterations_sum) / batch.strand_count() / steps;
    out.contacts += static_cast<double>(report.contacts) / steps;
    out.unconverged += static_cast<double>(report.unconverged) / steps;
    out.contacts_unconverged += static_cast<double>(report.contacts_unconverged) / steps;
    out.deepest = std::max(out.deepest, static_cast<double>(report.deepest_penetration));
  }
  out.step_us = median(times);
  return out;
}

void run(int strands, int steps, bool rods) {
  const test::HairOnHead hair(static_cast<uint32_t>(strands));
  std::printf("# %s\n", simd::active_isa());
  std::puts(
      "motion,with,us_a_step,over_rods,iterations_a_strand,contacts,unconverged,contacts_unconverged,"
      "deepest");
  for (const bool turning : {false, true}) {
    double alone = 0;
    for (const With with : {With::kNothing, With::kFarPlane, With::kHead, With::kHeadAndRods}) {
      if (with == With::kHeadAndRods && !rods) continue;
      const Result r = measure(hair, with, turning, steps);
      if (with == With::kNothing) alone = r.step_us;
      std::printf("%s,%s,%.0f,%.2f,%.2f,%.0f,%.1f,%.1f,%.3f\n", turning ? "turning" : "still",
                  kNames[static_cast<int>(with)], r.step_us, (r.step_us - alone) / alone, r.iterations,
                  r.contacts, r.unconverged, r.contacts_unconverged, r.deepest);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int argc, char** argv) {
  const auto asked = [&](const char* what) { return argc > 1 && std::strcmp(argv[1], what) == 0; };
  const bool quick = asked("--quick"), rods = asked("--rods");
  sinew::perf::run(quick ? 20 : rods ? 200 : 1000, quick ? 5 : asked("--long") ? 1500 : 120, quick || rods);
}

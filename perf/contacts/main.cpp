// main.cpp  What contacts cost: hair on a head, with a collider and without, as CSV.
//
// One thread's CPU time. 1,000 strands of 16 segments at 60 Hz after three seconds, then two seconds:
// `still`, and `turning` to and fro. Without a collider the same hair hangs through the head. `over_rods` is
// what the collider adds over what the rods cost alone, of the medians of a step. --rods: of 200 strands,
// with one another too; --long: 25 seconds, for the deepest; --quick: that everything runs.
#include <cmath>
#include <cstdio>
#include <cstring>

#include "kernels/isa.hpp"
#include "perf/help.hpp"
#include "perf/scale/stopwatch.hpp"
#include "rods/rod_batch.hpp"
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
constexpr int kInTurn = 20;

Status place(With with, double velocity_rad_s, rods::RodCollider* collider) {
  const rods::Plane floor = {.point_m = {0, -10, 0}};
  if (with == With::kFarPlane) return collider->set_planes({&floor, 1});
  return test::HairOnHead::put(collider, velocity_rad_s);
}

// One batch with its collider, that steps through the motion.
class Run {
 public:
  Run(const test::HairOnHead& hair, With with, bool turning)
      : hair_(hair),
        with_(with),
        turning_(turning),
        batch_(hair.batch({.start = rods::RodStart::kContinued})) {
    ok_ = rods::RodCollider::create(batch_, {.rods_collide = with == With::kHeadAndRods}, &collider_).ok();
  }

  void step(int i) {
    const double now = i * static_cast<double>(kStep_s), then = now + static_cast<double>(kStep_s);
    const double turn = hair_.angle(then, turning_) - hair_.angle(now, turning_);
    if (turning_) hair_.turn(&batch_, then);
    if (with_ != With::kNothing) ok_ &= place(with_, turn / static_cast<double>(kStep_s), &collider_).ok();
    rods::RodReport report;
    const double begin = clock_us(CLOCK_THREAD_CPUTIME_ID);
    ok_ &= batch_.step(kStep_s, with_ == With::kNothing ? nullptr : &collider_, &report).ok();
    if (i >= kSettle) add(clock_us(CLOCK_THREAD_CPUTIME_ID) - begin, report);
  }

  // NaN where a step was refused.
  Result result() const {
    Result out = sum_;
    const auto steps = static_cast<double>(times_us_.size());
    for (double* value : {&out.iterations, &out.contacts, &out.unconverged, &out.contacts_unconverged})
      *value /= steps;
    out.step_us = ok_ ? median(times_us_) : std::nan("");
    return out;
  }

 private:
  void add(double us, const rods::RodReport& report) {
    times_us_.push_back(us);
    sum_.iterations += static_cast<double>(report.iterations_sum) / batch_.strand_count();
    sum_.contacts += report.contacts;
    sum_.unconverged += report.unconverged;
    sum_.contacts_unconverged += report.contacts_unconverged;
    sum_.deepest = std::max(sum_.deepest, static_cast<double>(report.deepest_penetration));
  }

  const test::HairOnHead& hair_;
  With with_;
  bool turning_, ok_ = false;
  rods::RodBatch batch_;
  rods::RodCollider collider_;
  std::vector<double> times_us_;
  Result sum_;
};

void print(const char* motion, With with, const Result& r, double alone_us) {
  std::printf("%s,%s,%.0f,%.2f,%.2f,%.0f,%.1f,%.1f,%.3f\n", motion, kNames[static_cast<int>(with)], r.step_us,
              (r.step_us - alone_us) / alone_us, r.iterations, r.contacts, r.unconverged,
              r.contacts_unconverged, r.deepest);
}

// In turn, a few steps each: what the machine is slowed down by, all are.
void run(const test::HairOnHead& hair, bool turning, int steps, bool rods) {
  std::vector<With> kinds = {With::kNothing, With::kFarPlane, With::kHead};
  if (rods) kinds.push_back(With::kHeadAndRods);
  std::vector<Run> runs;
  for (const With with : kinds) runs.emplace_back(hair, with, turning);
  for (int first = 0; first < kSettle + steps; first += kInTurn) {
    for (Run& one : runs) {
      for (int i = first; i < std::min(first + kInTurn, kSettle + steps); ++i) one.step(i);
    }
  }
  for (size_t k = 0; k < kinds.size(); ++k)
    print(turning ? "turning" : "still", kinds[k], runs[k].result(), runs[0].result().step_us);
}

void run(int strands, int steps, bool rods) {
  const test::HairOnHead hair(static_cast<uint32_t>(strands));
  std::printf("# %s\n", simd::active_isa());
  std::puts(
      "motion,with,us_a_step,over_rods,iterations_a_strand,contacts,unconverged,contacts_unconverged,"
      "deepest");
  for (const bool turning : {false, true}) run(hair, turning, steps, rods);
}

}  // namespace
}  // namespace sinew::perf

int main(int argc, char** argv) {
  if (sinew::perf::gives_help(argc, argv,
                              "usage: perf_contacts [--quick | --rods | --long]\n"
                              "What contacts of rods and soft parts cost and how deep they go; CSV to "
                              "standard output. --quick: a few "
                              "steps, --rods: rods alone, --long: more steps."))
    return 0;
  const auto asked = [&](const char* what) { return argc > 1 && std::strcmp(argv[1], what) == 0; };
  const bool quick = asked("--quick"), rods = asked("--rods");
  sinew::perf::run(quick ? 20 : rods ? 200 : 1000, quick ? 5 : asked("--long") ? 1500 : 120, quick || rods);
}

// length.cpp  How long rods stay over long runs, at default settings, as CSV.
//
// The rod of perf_rods' single rows: 4 m, radius 0.02 m, torsion modulus 1e6 Pa, its root held, no damping,
// steps of 0.02 s from the horizontal. `longest` and `shortest` are the rod's length from joint to joint over
// that at rest, the extremes over all steps; `stretch` the largest gap at a joint over a segment. Starts:
// previous, and given: the last step's forces and accelerations, each number off by up to a fifth at random.
// `energy` is the highest above the energy it began with, over what gravity can give.
#include <algorithm>
#include <cstdio>
#include <random>

#include "baker/research/rods/compared_solver.hpp"
#include "perf/help.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::perf {
namespace {

constexpr float kDt_s = 0.02f;
constexpr double kGravity_m_s2 = 9.81;

struct Run {
  baker::SolverKind solver = baker::SolverKind::kDirect;
  rods::RodStart start = rods::RodStart::kPrevious;
  uint32_t segments = 30;
  float young_pa = 1e6f;
  int steps = 10000;
};

struct Lengths {
  double longest = 0, shortest = HUGE_VAL, stretch = 0, energy = -HUGE_VAL;
  uint32_t iterations = 0, unconverged = 0, rejoined = 0;
};

void guess(rods::RodBatch* batch, std::mt19937* random) {
  std::uniform_real_distribution<float> off(0.8f, 1.2f);
  for (uint32_t i = 0; i < batch->segment_count(); ++i) {
    rods::SegmentStart start = batch->last_forces(0, i);
    for (float* three :
         {start.acceleration_m_s2, start.angular_acceleration_rad_s2, start.force_n, start.moment_nm}) {
      for (int k = 0; k < 3; ++k) three[k] *= off(*random);
    }
    if (!batch->set_start(0, i, start).ok()) std::fputs("a start was refused\n", stderr);
  }
}

Lengths simulate(const Run& run) {
  const test::Segments rod = test::straight_rod({.segments = run.segments, .young_pa = run.young_pa});
  baker::ComparedSolver solver = {.kind = run.solver};
  rods::RodBatch batch = test::batch_of({rod}, {.solver = solver.solver(), .start = run.start});
  const double began = test::energy(batch, rod, kGravity_m_s2).sum_j();
  const double fall = 2 * run.segments * rods::segment_inertia(rod[0]).mass_kg * kGravity_m_s2;
  std::mt19937 random(1);
  Lengths out;
  for (int i = 0; i < run.steps; ++i) {
    if (run.start == rods::RodStart::kGiven) guess(&batch, &random);
    const rods::RodReport report = test::step(batch, kDt_s);
    const double length = test::length_ratio(batch, rod);
    out.longest = std::max(out.longest, length);
    out.shortest = std::min(out.shortest, length);
    out.stretch = std::max(out.stretch, test::largest_stretch(batch, rod));
    out.energy = std::max(out.energy, (test::energy(batch, rod, kGravity_m_s2).sum_j() - began) / fall);
    out.iterations += report.iterations;
    out.unconverged += report.unconverged;
    out.rejoined += report.rejoined;
  }
  return out;
}

void print(const Run& run) {
  const char* const starts[] = {"zero", "previous", "given"};
  const Lengths l = simulate(run);
  std::printf("%s,%s,%u,%.0e,%d,%.6f,%.6f,%.1e,%.3f,%.2f,%u,%u\n", name_of(run.solver),
              starts[static_cast<int>(run.start)], run.segments, static_cast<double>(run.young_pa), run.steps,
              l.longest, l.shortest, l.stretch, l.energy, static_cast<double>(l.iterations) / run.steps,
              l.unconverged, l.rejoined);
  std::fflush(stdout);
}

void print_all() {
  std::puts(
      "solver,start,segments,young_pa,steps,longest,shortest,stretch,energy,iterations,unconverged,rejoined");
  for (const uint32_t segments : {50u, 100u, 200u}) {
    print({.segments = segments, .young_pa = 1e4f, .steps = 1000});
  }
  for (const rods::RodStart start : {rods::RodStart::kPrevious, rods::RodStart::kGiven}) {
    for (const uint32_t segments : {30u, 50u, 200u}) {
      for (float young = 1e4f; young < 2e9f; young *= 10) {
        print({.start = start, .segments = segments, .young_pa = young});
      }
    }
  }
  for (const uint32_t segments : {10u, 30u, 200u}) {
    for (const float young : {1e4f, 1e6f}) {
      print({.solver = baker::SolverKind::kLocal, .segments = segments, .young_pa = young, .steps = 1000});
    }
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int argc, char** argv) {
  if (sinew::perf::gives_help(argc, argv,
                              "usage: perf_rod_length\n"
                              "How much rods stretch; CSV to standard output."))
    return 0;
  sinew::perf::print_all();
}

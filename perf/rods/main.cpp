// main.cpp  Rods by number of segments and stiffness: time, iterations and what is left of stretch, as CSV.
//
// One thread. Batches: 1,000 strands 2 cm a segment, 1 mm thin, that differ by some per cent and in where
// they point, falling for a second at 60 Hz. Single rods: 4 m, radius 0.02 m, torsion modulus 1e6 Pa, steps
// of 0.02 s. Times are medians over steps, of a step's time over its strands, and over its segments and
// iterations; lengths and gaps the worst of all steps, of every tenth strand. The first line is the
// processor's multiply-add peak in the same process, for comparing machines.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "baker/research/rods/compared_solver.hpp"
#include "kernels/isa.hpp"
#include "perf/help.hpp"
#include "perf/rods/peak.hpp"
#include "rods/rod_batch.hpp"
#include "tests/rods/rod_scenes.hpp"
#include "tests/scenes/hair.hpp"

namespace sinew::perf {
namespace {

struct Scene {
  const char* name;
  uint32_t strands;
  test::RodShape shape;
  float dt_s;
  int steps;
};

struct Worst {
  double gap = 0, length_ratio = 1;
  void look(const rods::RodBatch& batch, const std::vector<test::Segments>& strands) {
    for (uint32_t s = 0; s < strands.size(); s += 10) {
      gap = std::max(gap, test::largest_stretch(batch, strands[s], s));
      const double ratio = test::length_ratio(batch, strands[s], s);
      if (std::fabs(ratio - 1) > std::fabs(length_ratio - 1)) length_ratio = ratio;
    }
  }
};

const char* name_of(rods::RodStart start) { return start == rods::RodStart::kZero ? "zero" : "previous"; }

void run(const Scene& scene, rods::RodStart start, baker::SolverKind kind = baker::SolverKind::kDirect) {
  const test::Segments rod = test::straight_rod(scene.shape);
  const std::vector<test::Segments> strands =
      scene.strands == 1 ? std::vector<test::Segments>{rod} : test::varied(rod, scene.strands);
  baker::ComparedSolver solver = {.kind = kind};
  rods::RodBatch batch = test::batch_of(strands, {.solver = solver.solver(), .start = start});
  std::vector<double> step_us, iteration_us;
  double iterations = 0;
  uint32_t unconverged = 0;
  Worst worst;
  for (int i = 0; i < scene.steps; ++i) {
    const double begin = clock_us(CLOCK_THREAD_CPUTIME_ID);
    const rods::RodReport report = test::step(batch, scene.dt_s);
    const double us = clock_us(CLOCK_THREAD_CPUTIME_ID) - begin;
    step_us.push_back(us / scene.strands);
    iteration_us.push_back(us / (static_cast<double>(report.iterations_sum) * scene.shape.segments));
    iterations += static_cast<double>(report.iterations_sum) / scene.strands / scene.steps;
    unconverged += report.unconverged;
    worst.look(batch, strands);
  }
  const double inner = static_cast<double>(solver.cg_iterations) / scene.strands / scene.steps;
  std::printf("%s,%s,%s,%u,%u,%.0e,%.3f,%.4f,%.2f,%.0f,%.1e,%.6f,%u\n", scene.name, name_of(kind),
              name_of(start), scene.strands, scene.shape.segments, static_cast<double>(scene.shape.young_pa),
              median(step_us), median(iteration_us), iterations, inner, worst.gap, worst.length_ratio,
              unconverged);
  std::fflush(stdout);
}

Scene hair(uint32_t segments, float young_pa) {
  const test::RodShape shape = {.segments = segments,
                                .young_pa = young_pa,
                                .length_m = 0.02 * segments,
                                .radius_m = 0.001f,
                                .torsion_pa = young_pa};
  return {"batch", 1000, shape, 1.0f / 60, 60};
}

Scene single(uint32_t segments, float young_pa) {
  return {"single", 1, {.segments = segments, .young_pa = young_pa}, 0.02f, 1000};
}

void run_all() {
  std::printf("# %s, multiply-add peak %.1f GFLOP/s\n", simd::active_isa(), peak_gflops());
  std::puts(
      "scene,solver,start,strands,segments,young_pa,us_a_strand_step,us_a_segment_iteration,iterations,"
      "inner,largest_gap,length_ratio,unconverged");
  for (const rods::RodStart start : {rods::RodStart::kPrevious, rods::RodStart::kZero}) {
    for (const uint32_t segments : {16u, 32u}) {
      for (const float young : {1e5f, 1e7f, 1e9f}) run(hair(segments, young), start);
    }
    for (const uint32_t segments : {30u, 50u, 100u, 200u}) {
      for (const float young : {1e4f, 1e6f, 1e8f}) run(single(segments, young), start);
    }
    for (const float young : {1e4f, 1e6f}) run(single(30, young), start, baker::SolverKind::kCg);
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int argc, char** argv) {
  if (sinew::perf::gives_help(
          argc, argv,
          "usage: perf_rods\n"
          "What a step of rods costs, by their number, segments and stiffness; CSV to standard output."))
    return 0;
  sinew::perf::run_all();
}

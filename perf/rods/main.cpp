// main.cpp  Rods by number of segments and stiffness: time, iterations and what is left of stretch, as CSV.
//
// One thread. Batches: 1,000 strands 2 cm a segment, 1 mm thin, falling from the horizontal for a second at
// 60 Hz. Single rods: 4 m, radius 0.02 m, torsion modulus 1e6 Pa, steps of 0.02 s. Times are medians over
// steps, of a step's time over its strands, and over its segments and iterations. The first line is the
// processor's multiply-add peak in the same process, for comparing machines.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <vector>

#include "perf/kernels/fma_peak.hpp"
#include "rods/rod_batch.hpp"
#include "simd/isa.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::perf {
namespace {

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// The thread's own, so that what else runs counts only by the caches it takes.
double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double peak_gflops() {
  float sink = 1;
  std::vector<double> measured;
  for (int i = 0; i < 15; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    const double operations = run_fma(1'000'000, &sink);
    measured.push_back(1e-9 * operations /
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return median(measured);
}

struct Scene {
  const char* name;
  uint32_t strands;
  test::RodShape shape;
  float dt_s;
  int steps;
};

void run(const Scene& scene, rods::RodStart start, rods::RodSolver solver = rods::RodSolver::kDirect) {
  const test::Segments rod = test::straight_rod(scene.shape);
  rods::RodBatch batch =
      test::batch_of(std::vector<test::Segments>(scene.strands, rod), {.solver = solver, .start = start});
  std::vector<double> step_us, iteration_us;
  double iterations = 0, inner = 0, stretch = 0;
  uint32_t unconverged = 0;
  for (int i = 0; i < scene.steps; ++i) {
    const double begin = thread_us();
    const rods::RodReport report = test::step(batch, scene.dt_s);
    const double us = thread_us() - begin;
    step_us.push_back(us / scene.strands);
    iteration_us.push_back(us / (static_cast<double>(report.iterations_sum) * scene.shape.segments));
    iterations += static_cast<double>(report.iterations_sum) / scene.strands / scene.steps;
    inner += static_cast<double>(report.cg_iterations) / scene.strands / scene.steps;
    unconverged += report.unconverged;
    stretch = std::max(stretch, test::largest_stretch(batch, rod));
  }
  std::printf("%s,%s,%s,%u,%u,%.0e,%.3f,%.4f,%.2f,%.0f,%.1e,%u\n", scene.name,
              solver == rods::RodSolver::kCg ? "cg" : "direct",
              start == rods::RodStart::kZero ? "zero" : "previous", scene.strands, scene.shape.segments,
              static_cast<double>(scene.shape.young_pa), median(step_us), median(iteration_us), iterations,
              inner, stretch, unconverged);
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
  return {"single", 1, {.segments = segments, .young_pa = young_pa}, 0.02f, 500};
}

void run_all() {
  std::printf("# %s, multiply-add peak %.1f GFLOP/s\n", simd::active_isa(), peak_gflops());
  std::puts(
      "scene,solver,start,strands,segments,young_pa,us_a_strand_step,us_a_segment_iteration,iterations,"
      "stretch,"
      "unconverged");
  for (const rods::RodStart start : {rods::RodStart::kPrevious, rods::RodStart::kZero}) {
    for (const uint32_t segments : {16u, 32u}) {
      for (const float young : {1e5f, 1e7f, 1e9f}) run(hair(segments, young), start);
    }
    for (const uint32_t segments : {30u, 200u}) {
      for (const float young : {1e4f, 1e6f, 1e8f}) run(single(segments, young), start);
    }
    for (const float young : {1e4f, 1e6f}) run(single(30, young), start, rods::RodSolver::kCg);
  }
}

}  // namespace
}  // namespace sinew::perf

int main() { sinew::perf::run_all(); }

// surfaces.cpp  What a deforming mesh costs: its refit, and a question for a probe near it and far from it.
//
// The bust of samples/hair, turned by a tick between refits. Capsules of 2 cm and 2.5 mm radius that move 5
// mm away from the skin: `near` begin half a millimetre off it, `off` 2 cm, `far` 20 cm. One thread's CPU
// time, the least of 10 runs; CSV.
#include <cstdio>
#include <random>

#include "perf/help.hpp"
#include "perf/scale/stopwatch.hpp"
#include "samples/hair/bust.hpp"
#include "sinew/surface_contacts.hpp"

namespace sinew::perf {
namespace {

using Eigen::Vector3d;

constexpr uint32_t kProbes = 4000, kRuns = 10;
constexpr double kHalf_m = 0.01, kRadius_m = 0.0025, kWay_m = 0.005;
constexpr float kTick_s = 1.0f / 60;

template <class Run>
double least_us(Run run) {
  double least = 1e30;
  for (uint32_t i = 0; i < kRuns; ++i) {
    const double begin = clock_us(CLOCK_THREAD_CPUTIME_ID);
    run(i);
    least = std::min(least, clock_us(CLOCK_THREAD_CPUTIME_ID) - begin);
  }
  return least;
}

std::vector<ContactProbe> probes_off(const sample::Bust& bust, double off_m) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> any(-1, 1);
  std::uniform_int_distribution<size_t> vertex(0, bust.rest_m.size() - 1);
  std::vector<ContactProbe> out(kProbes);
  for (ContactProbe& p : out) {
    const Vector3d& on = bust.rest_m[vertex(engine)];
    const Vector3d normal = bust.field.sample(on).gradient.normalized();
    const Vector3d along =
        kHalf_m * Vector3d(any(engine), any(engine), any(engine)).cross(normal).normalized();
    for (int k = 0; k < 3; ++k) {
      p.start_m[0][k] = on[k] + off_m * normal[k] - along[k];
      p.start_m[1][k] = on[k] + off_m * normal[k] + along[k];
      for (auto e : {0, 1}) p.end_m[e][k] = p.start_m[e][k] + kWay_m * normal[k];
    }
    p.radius_m = static_cast<float>(kRadius_m);
  }
  return out;
}

void measure(size_t vertices) {
  const sample::Bust bust = sample::make_bust(vertices);
  std::vector<uint32_t> indices;
  for (const auto& t : bust.triangles) indices.insert(indices.end(), t.begin(), t.end());
  const std::vector<float> rest = bust.places({});
  SurfaceContacts contacts;
  SurfaceId skin;
  if (!SurfaceContacts::create({.max_surfaces = 1, .max_owners = 0}, &contacts).ok()) return;
  if (!contacts.add_surface({.triangles = indices, .rest_m = rest}, &skin).ok()) return;
  std::vector<std::vector<float>> poses;
  for (uint32_t i = 0; i < kRuns; ++i) poses.push_back(bust.places(sample::turning_at(2 + i / 60.0)));
  const double refit_us = least_us(
      [&](uint32_t i) { (void)contacts.move_surface(skin, {.places_m = poses[i], .dt_s = kTick_s}); });
  std::printf("%zu,refit,1,%.0f,\n", bust.triangles.size(), refit_us);
  (void)contacts.move_surface(skin, {.places_m = rest});
  std::vector<ContactHit> hits(4 * kProbes);
  for (const auto& [name, off_m] : {std::pair("near", kRadius_m + 0.0005), {"off", 0.02}, {"far", 0.2}}) {
    const std::vector<ContactProbe> probes = probes_off(bust, off_m);
    uint32_t found = 0;
    const double us = least_us([&](uint32_t) { found = contacts.find(probes, kTick_s, hits); });
    std::printf("%zu,%s,%u,%.3f,%u\n", bust.triangles.size(), name, kProbes, us / kProbes, found);
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int argc, char** argv) {
  if (sinew::perf::gives_help(
          argc, argv,
          "usage: perf_surfaces\n"
          "What a skinned mesh costs to refit and to probe, by its triangles; CSV to standard output."))
    return 0;
  std::printf("triangles,what,count,us_each,hits\n");
  for (const size_t vertices : {size_t{3000}, size_t{6000}, size_t{20000}}) sinew::perf::measure(vertices);
}

// starts.cpp  What a start is worth: iterations and time of both solvers, for every start, as CSV.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "baker/rods/rod_run.hpp"
#include "baker/truth/random.hpp"

namespace sinew::perf {
namespace {

double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}
double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

struct Case {
  std::string name;
  baker::RodRange range;
  uint32_t strands, steps;
};

using Truth = std::vector<std::vector<rods::SegmentStart>>;  // [step][strand * segment]

struct Scenes {
  std::vector<baker::RodScene> scenes;
  std::vector<rods::StrandDef> defs;
};
Scenes make(const Case& c) {
  Scenes out;
  for (uint32_t i = 0; i < c.strands; ++i) out.scenes.push_back(baker::make_rod_scene(c.range, 50001 + i));
  for (const auto& s : out.scenes) out.defs.push_back({s.segments});
  return out;
}

struct Result {
  double newton = 0, group = 0, cg = 0, us = 0, late_cg = 0;
  uint32_t bad = 0;
};

Truth truth(const Case& c, const Scenes& s) {
  rods::RodSettings set{.start = rods::RodStart::kZero, .max_iterations = 200, .tolerance_rad = 1e-5f};
  rods::RodBatch batch;
  rods::RodBatch::create(s.defs, set, &batch);
  Truth out;
  for (uint32_t t = 0; t < c.steps; ++t) {
    for (uint32_t i = 0; i < c.strands; ++i) baker::drive_root(s.scenes[i], (t + 1) * 0.02, i, &batch);
    rods::RodReport r;
    batch.step(0.02f, &r);
    std::vector<rods::SegmentStart> now;
    for (uint32_t i = 0; i < c.strands; ++i)
      for (uint32_t k = 0; k < batch.segment_count(); ++k) now.push_back(batch.last_forces(i, k));
    out.push_back(now);
  }
  return out;
}

Result run(const Case& c, const Scenes& s, rods::RodSettings set, const Truth* oracle, double noise) {
  rods::RodBatch batch;
  const Status st = rods::RodBatch::create(s.defs, set, &batch);
  if (!st.ok()) std::printf("# %s\n", st.message);
  Result out;
  baker::Random random(7);
  std::vector<double> us;
  for (uint32_t t = 0; t < c.steps; ++t) {
    for (uint32_t i = 0; i < c.strands; ++i) baker::drive_root(s.scenes[i], (t + 1) * 0.02, i, &batch);
    if (oracle) {
      for (uint32_t i = 0; i < c.strands; ++i)
        for (uint32_t k = 0; k < batch.segment_count(); ++k) {
          rods::SegmentStart g = (*oracle)[t][i * batch.segment_count() + k];
          const auto disturb = [&](float(&v)[3]) {
            for (float& x : v) x *= static_cast<float>(1 + noise * random.uniform(-1.73, 1.73));
          };
          if (noise > 0) disturb(g.acceleration_m_s2), disturb(g.angular_acceleration_rad_s2), disturb(g.force_n), disturb(g.moment_nm);
          batch.set_start(i, k, g);
        }
    }
    rods::RodReport r;
    const double begin = thread_us();
    batch.step(0.02f, &r);
    us.push_back((thread_us() - begin) / c.strands);
    const double per = 1.0 / c.strands / c.steps;
    out.newton += r.iterations_sum * per;
    out.group += double(r.iterations) / c.steps;
    out.cg += r.cg_iterations * per;
    out.bad += r.unconverged + r.recovered;
  }
  out.us = median(us);
  return out;
}

}  // namespace
}  // namespace sinew::perf

int main(int argc, char** argv) {
  using namespace sinew;
  using namespace sinew::perf;
  const double tol = argc > 1 ? std::atof(argv[1]) : 0.01;
  std::vector<Case> cases;
  for (const char* kind : {"bending_rod", "helix"})
    for (double n : {20., 50.})
      for (double e : {1e4, 1e6, 1e8})
        cases.push_back({kind, {baker::rod_kind(kind, ""), n, n, e, e, 1}, 32, 50});
  for (int rods : {10, 40}) cases.push_back({"tree" + std::to_string(rods), {baker::RodKind::kTree, 8, 8, 1e7, 1e7, rods}, 1, 50});
  std::puts("scene,segments,young_pa,solver,start,newton,most,cg,us,bad");
  for (const Case& c : cases) {
    const Scenes s = make(c);
    const Truth t = truth(c, s);
    for (const auto solver : {rods::RodSolver::kDirect, rods::RodSolver::kCg}) {
      const auto line = [&](const char* start, rods::RodStart how, const Truth* o, double noise) {
        rods::RodSettings set{.solver = solver, .start = how, .max_iterations = 30, .tolerance_rad = static_cast<float>(tol)};
        const Result r = run(c, s, set, o, noise);
        std::printf("%s,%zu,%.0e,%s,%s,%.2f,%.2f,%.0f,%.2f,%u\n", c.name.c_str(), s.scenes[0].segments.size(), c.range.softest_pa,
                    solver == rods::RodSolver::kCg ? "cg" : "direct", start, r.newton, r.group, r.cg, r.us, r.bad);
        std::fflush(stdout);
      };
      line("zero", rods::RodStart::kZero, nullptr, 0);
      line("previous", rods::RodStart::kPrevious, nullptr, 0);
      line("continued", rods::RodStart::kContinued, nullptr, 0);
      line("oracle", rods::RodStart::kGiven, &t, 0);
      line("oracle5", rods::RodStart::kGiven, &t, 0.05);
      line("oracle20", rods::RodStart::kGiven, &t, 0.2);
    }
  }
}

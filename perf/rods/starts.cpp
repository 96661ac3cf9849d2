// starts.cpp  What a start is worth: iterations and time of both solvers for every start, as CSV.
//
//   perf_rod_starts [--steps S] [--scene PREFIX] [--examples FILE] [WEIGHTS ...]
//
// Scenes as the networks are trained on (baker/rods/rod_scene.hpp), of seeds in no plan. The direct solver
// steps one group of 16 strands, which waits for its slowest; conjugate gradients step each rod alone, as the
// paper does; trees are alone in both. All starts of a scene and solver go through the same steps, one after
// the other in each step, so that what else runs on the machine meets them alike; times are the thread's own,
// means over the steps without the first five, in which no start knows anything.
//
// `oracle` starts from what a tight tolerance found, oracle5 and oracle20 from that with every number off by
// 5 or 20 % at random: what a guess of that error is worth. They cost nothing, which no guess does. Horizons:
// the first step, before which there is no past; steps 5 to 50; those after. `head`: a thousand strands at
// once.
//
//   perf_rod_starts --length STEPS WEIGHTS   worst length over length at rest with kLearned, by stiffness
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/research/rods/compared_solver.hpp"
#include "baker/rods/rod_run.hpp"
#include "baker/truth/motion/random.hpp"
#include "perf/help.hpp"
#include "perf/rods/start_files.hpp"
#include "perf/scale/stopwatch.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::perf {
namespace {

constexpr float kDt_s = 0.02f;
constexpr uint32_t kBlindSteps = 5, kTrainedSteps = 50, kFirstSeed = 900001;

double thread_us() { return clock_us(CLOCK_THREAD_CPUTIME_ID); }

struct Given {  // on the command line
  std::vector<std::unique_ptr<StartNetwork>> networks;
  std::unique_ptr<ExampleFile> examples;
  uint32_t steps = 200, length_steps = 0;
  std::string scene;  // only those that begin so
};

struct Case {
  std::string name;
  baker::RodRange range;
  uint32_t strands = 16, alone = 6;  // in a group; one by one
};

struct Strands {
  Strands(const Case& c, uint32_t count, uint64_t seed) {
    for (uint32_t i = 0; i < count; ++i) scenes.push_back(baker::make_rod_scene(c.range, seed + i));
    for (const baker::RodScene& s : scenes) defs.push_back({s.segments});
  }
  void drive(uint32_t step, rods::RodBatch* batch) const {
    for (uint32_t i = 0; i < scenes.size(); ++i) {
      baker::drive_root(scenes[i], (step + 1) * static_cast<double>(kDt_s), i, batch);
    }
  }
  rods::RodBatch batch(const rods::RodSettings& settings) const {
    rods::RodBatch out;
    const Status status = rods::RodBatch::create(defs, settings, &out);
    if (!status.ok()) throw baker::BadInput(status.message);
    return out;
  }
  std::vector<baker::RodScene> scenes;
  std::vector<rods::StrandDef> defs;
};

struct Sums {  // over strands, but for `most`, which is over groups
  double newton = 0, most = 0, cg = 0, us = 0;
  uint32_t unconverged = 0, steps = 0, strand_steps = 0;
};

struct Contender {
  std::string name;
  std::unique_ptr<baker::ComparedSolver> solver;
  rods::RodSettings settings;
  double noise = -1;  // not negative: given what is true, disturbed
  rods::RodBatch batch;
  std::array<Sums, 3> sums;
};

std::vector<Contender> contenders(const Given& given, baker::SolverKind solver) {
  std::vector<Contender> out;
  const auto add = [&](const std::string& name, rods::RodStart start, double noise = -1) {
    Contender& who = out.emplace_back();
    who.name = name;
    who.noise = noise;
    who.solver = std::make_unique<baker::ComparedSolver>();
    who.solver->kind = solver;
    who.settings.solver = who.solver->solver();
    who.settings.start = start;
    who.settings.max_iterations = 30;
    return &who.settings;
  };
  add("zero", rods::RodStart::kZero);
  add("previous", rods::RodStart::kPrevious);
  add("continued", rods::RodStart::kContinued);
  if (given.examples) add("knn", rods::RodStart::kContinued)->correction = given.examples->nearest();
  for (const auto& network : given.networks) {
    add(network->name(), rods::RodStart::kLearned)->network = network->net();
  }
  add("oracle", rods::RodStart::kGiven, 0);
  add("oracle5", rods::RodStart::kGiven, 0.05);
  add("oracle20", rods::RodStart::kGiven, 0.2);
  return out;
}

void give(const rods::RodBatch& truth, double noise, baker::Random& random, rods::RodBatch* batch) {
  const auto disturb = [&](float(&v)[3]) {
    for (float& x : v) x *= static_cast<float>(1 + noise * random.uniform(-1.7320508, 1.7320508));
  };
  for (uint32_t i = 0; i < truth.strand_count(); ++i) {
    for (uint32_t k = 0; k < truth.segment_count(); ++k) {
      rods::SegmentStart start = truth.last_forces(i, k);
      disturb(start.acceleration_m_s2);
      disturb(start.angular_acceleration_rad_s2);
      disturb(start.force_n);
      disturb(start.moment_nm);
      batch->set_start(i, k, start);
    }
  }
}

void step(uint32_t at, const Strands& strands, const rods::RodBatch& truth, baker::Random& random,
          Contender* who, std::array<Sums, 3>* totals) {
  strands.drive(at, &who->batch);
  if (who->noise >= 0) give(truth, who->noise, random, &who->batch);
  rods::RodReport report;
  const uint32_t cg_before = who->solver->cg_iterations;
  const double begin = thread_us();
  who->batch.step(kDt_s, &report);
  const double us = thread_us() - begin;
  if (at > 0 && at < kBlindSteps) return;
  Sums& sums = (*totals)[at == 0 ? 0 : at < kTrainedSteps ? 1 : 2];
  sums.newton += report.iterations_sum;
  sums.most += report.iterations;
  sums.cg += who->solver->cg_iterations - cg_before;
  sums.us += us;
  sums.unconverged += report.unconverged;
  sums.steps += 1;
  sums.strand_steps += who->batch.strand_count();
}

constexpr const char* kHorizons[] = {"first", "within", "beyond"};

void print(const Case& c, size_t segments, baker::SolverKind solver, const Contender& who) {
  for (size_t h = 0; h < who.sums.size(); ++h) {
    const Sums& s = who.sums[h];
    if (s.steps == 0) continue;
    std::printf("%s,%zu,%.0e,%s,%s,%s,%.3f,%.3f,%.1f,%.3f,%u\n", c.name.c_str(), segments, c.range.softest_pa,
                name_of(solver), who.name.c_str(), kHorizons[h], s.newton / s.strand_steps, s.most / s.steps,
                s.cg / s.strand_steps, s.us / s.strand_steps, s.unconverged);
  }
  std::fflush(stdout);
}

// One batch a contender, from rest; what it took is added to `totals`.
void run_batch(const Strands& strands, uint32_t steps, std::vector<Contender>* totals) {
  rods::RodSettings tight;
  tight.start = rods::RodStart::kContinued;
  tight.max_iterations = 200;
  tight.tolerance_rad = 1e-5f;
  rods::RodBatch truth = strands.batch(tight);
  for (Contender& who : *totals) who.batch = strands.batch(who.settings);
  baker::Random random(7);
  for (uint32_t at = 0; at < steps; ++at) {
    strands.drive(at, &truth);
    truth.step(kDt_s, nullptr);
    for (Contender& who : *totals) step(at, strands, truth, random, &who, &who.sums);
  }
}

void run(const Case& c, const Given& given) {
  for (const baker::SolverKind solver : {baker::SolverKind::kDirect, baker::SolverKind::kCg}) {
    const bool alone = solver == baker::SolverKind::kCg || c.range.kind == baker::RodKind::kTree;
    std::vector<Contender> totals = contenders(given, solver);
    size_t segments = 0;
    for (uint32_t i = 0; i < (alone ? c.alone : 1); ++i) {
      const Strands strands(c, alone ? 1 : c.strands, kFirstSeed + i);
      segments = strands.scenes[0].segments.size();
      run_batch(strands, given.steps, &totals);
    }
    for (const Contender& who : totals) print(c, segments, solver, who);
  }
}

std::vector<Case> all_cases() {
  std::vector<Case> out;
  for (const char* kind : {"bending_rod", "helix"}) {
    for (const double n : {50.0, 100.0}) {
      for (const double e : {1e4, 1e6, 1e8})
        out.push_back({kind, {baker::rod_kind(kind, ""), n, n, e, e, 1}});
    }
  }
  for (const double n : {16.0, 32.0, 64.0})
    out.push_back({"soft", {baker::RodKind::kBendingRod, n, n, 1e4, 1e4, 1}});
  out.push_back({"head", {baker::RodKind::kBendingRod, 16, 16, 1e7, 1e7, 1}, 1000, 6});
  for (const int rods : {10, 20, 40, 70}) {
    out.push_back({"tree" + std::to_string(rods), {baker::RodKind::kTree, 8, 8, 1e7, 1e7, rods}});
  }
  return out;
}

// Medians over steps in turns, us a segment and strand of a group of 16. A start's cost is its step's less
// that of kPrevious, both of one iteration; an iteration's is what steps of several take more, by their
// number.
void print_costs(const Given& given) {
  constexpr uint32_t kSteps = 400;
  for (const double n : {16.0, 50.0, 100.0}) {
    const Case c = {"bending_rod", {baker::RodKind::kBendingRod, n, n, 1e7, 1e7, 1}};
    const Strands strands(c, c.strands, kFirstSeed);
    std::vector<Contender> all = contenders(given, baker::SolverKind::kDirect);
    all.resize(all.size() - 3);
    for (Contender& who : all) who.settings.max_iterations = 1, who.settings.tolerance_rad = 1;
    all[0].settings.max_iterations = 30;
    all[0].settings.tolerance_rad = 1e-3f;
    std::vector<std::vector<double>> us(all.size());
    for (Contender& who : all) who.batch = strands.batch(who.settings);
    std::vector<double> iteration;
    for (uint32_t at = 0; at < kSteps; ++at) {
      rods::RodReport reports[2];
      for (size_t k = 0; k < all.size(); ++k) {
        strands.drive(at, &all[k].batch);
        const double begin = thread_us();
        all[k].batch.step(kDt_s, &reports[k > 0]);
        us[k].push_back((thread_us() - begin) / c.strands / n);
      }
      const bool several = reports[0].iterations > 1 && reports[0].unconverged == 0;
      if (several) iteration.push_back((us[0].back() - us[1].back()) / (reports[0].iterations - 1));
    }
    std::printf("# cost,%.0f,iteration,%.4f\n", n, median(iteration));
    for (size_t k = 2; k < all.size(); ++k) {
      std::printf("# cost,%.0f,%s,%.4f\n", n, all[k].name.c_str(), median(us[k]) - median(us[1]));
    }
  }
}

void print_lengths(uint32_t steps, const rods::CopingNet* network) {
  std::puts("young_pa,segments,steps,largest_length_ratio,least_length_ratio,unconverged");
  for (const float young : {1e4f, 1e5f, 1e6f, 1e7f, 1e8f, 1e9f}) {
    const test::Segments rod = test::straight_rod({.segments = 30, .young_pa = young});
    rods::RodSettings settings;
    settings.start = rods::RodStart::kLearned;
    settings.network = network;
    rods::RodBatch batch = test::batch_of({rod}, settings);
    double largest = 0, least = 2;
    uint32_t unconverged = 0;
    for (uint32_t i = 0; i < steps; ++i) {
      unconverged += test::step(batch, kDt_s).unconverged;
      const double ratio = test::length_ratio(batch, rod);
      largest = std::max(largest, ratio), least = std::min(least, ratio);
    }
    std::printf("%.0e,30,%u,%.6f,%.6f,%u\n", static_cast<double>(young), steps, largest, least, unconverged);
    std::fflush(stdout);
  }
}

uint32_t whole(const std::string& name, const char* text) {
  const int value = std::atoi(text);
  if (value < 1) throw baker::BadInput(name + " " + text + ": must be a whole number from 1");
  return static_cast<uint32_t>(value);
}

Given read_arguments(int count, char** arguments) {
  Given given;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    const bool valued = word == "--steps" || word == "--examples" || word == "--length" || word == "--scene";
    if (valued && i + 1 == count) throw baker::BadInput(word + ": needs a value");
    if (word == "--steps") {
      given.steps = whole(word, arguments[++i]);
    } else if (word == "--scene") {
      given.scene = arguments[++i];
    } else if (word == "--length") {
      given.length_steps = whole(word, arguments[++i]);
    } else if (word == "--examples") {
      given.examples = std::make_unique<ExampleFile>(arguments[++i]);
    } else {
      given.networks.push_back(std::make_unique<StartNetwork>(word));
    }
  }
  if (given.length_steps > 0 && given.networks.empty()) throw baker::BadInput("--length: name the weights");
  return given;
}

void run_all(const Given& given) {
  if (given.length_steps > 0) return print_lengths(given.length_steps, given.networks[0]->net());
  print_costs(given);
  std::puts(
      "scene,segments,young_pa,solver,start,horizon,newton,most,cg_iterations,us_a_strand_step,unconverged");
  for (const Case& c : all_cases()) {
    if (c.name.starts_with(given.scene)) run(c, given);
  }
}

}  // namespace
}  // namespace sinew::perf

int main(int count, char** arguments) {
  if (sinew::perf::gives_help(count, arguments,
                              "usage: perf_rod_starts [WEIGHTS.safetensors...] [--steps N] [--scene NAME] "
                              "[--examples FILE] [--length N]\n"
                              "Iterations of rods' solvers by where they start; CSV to standard output. "
                              "--length: the worst length over "
                              "rest length of rods that the first weights start, in so many steps."))
    return 0;
  try {
    sinew::perf::run_all(sinew::perf::read_arguments(count, arguments));
  } catch (const sinew::baker::BadInput& error) {
    std::fprintf(stderr, "perf_rod_starts: %s\n", error.what());
    return 2;
  }
}

// measure.cpp  see measure.hpp.
#include "perf/trade/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "perf/scale/stopwatch.hpp"
#include "tests/rods/rod_scenes.hpp"

namespace sinew::perf {
namespace {

constexpr int kSteps = 60, kEvery = 10, kRepeats = 5;
constexpr double kNever = std::numeric_limits<double>::infinity();

// The same for all, for it is part of a step's equations: twice this much of penetration is left alone.
constexpr float kContactTolerance = 1e-4f;

// Strands and what they touch.
struct Rig {
  rods::RodBatch batch;
  rods::RodCollider collider;
  bool contacts;

  rods::RodReport step(float dt_s) {
    rods::RodReport report;
    const Status status = batch.step(dt_s, contacts ? &collider : nullptr, &report);
    if (!status.ok()) throw std::runtime_error(status.message);
    return report;
  }
  void take_state(const Rig& from) {
    Status status = batch.take_state(from.batch);
    if (status.ok() && contacts) status = collider.take_state(from.collider);
    if (!status.ok()) throw std::runtime_error(status.message);
  }
};

bool solved(const rods::RodReport& report, double residual) {
  return static_cast<double>(report.residual) <= residual && report.contacts_dropped == 0;
}

// Strands differ by some per cent, as hairs do.
std::vector<Segments> strands_of(const TradeCase& c) {
  std::vector<Segments> out;
  for (uint32_t s = 0; s < c.strands; ++s)
    out.push_back(c.scene->rod(c.segments, c.young_pa * (1 + 0.01 * s)));
  return out;
}

class CaseRun {
 public:
  explicit CaseRun(const TradeCase& c) : case_(c), strands_(strands_of(c)) {}

  std::vector<Reached> run() {
    std::vector<Tally> tallies(std::size(kResiduals));
    // With the case's own start, for what it remembers of the steps before.
    rods::RodSettings tight = settings({}, 200, false);
    tight.tolerance_rad = 1e-4f;
    Rig scene = made(tight);
    for (int step = 0; step < kSteps; ++step) {
      case_.scene->drive(scene.batch, step);
      if (step % every() == every() - 1) try_all(scene, &tallies);
      (void)scene.step(case_.scene->dt_s);
    }
    std::vector<Reached> out;
    for (size_t i = 0; i < tallies.size(); ++i) out.push_back(tallies[i].result(kResiduals[i]));
    return out;
  }

 private:
  struct Tally {
    std::vector<double> us, errors;
    double iterations = 0, inner = 0;
    uint32_t most = 0;
    Reached result(double residual) const {
      const auto count = static_cast<double>(errors.size());
      return {residual,
              static_cast<uint32_t>(us.size()),
              static_cast<uint32_t>(errors.size()),
              errors.empty() ? 0 : iterations / count,
              errors.empty() ? 0 : inner / count,
              most,
              median(us),
              errors.empty() ? kNever : median(errors)};
    }
  };

  int every() const { return case_.solver->inner && case_.segments >= 100 ? 2 * kEvery : kEvery; }

  Rig made(const rods::RodSettings& settings) const {
    Rig rig{{}, {}, case_.scene->contacts};
    Status status = test::try_batch(strands_, settings, &rig.batch);
    if (status.ok() && rig.contacts) status = furnish(&rig);
    if (!status.ok()) throw std::runtime_error(key_of(case_) + ": " + status.message);
    return rig;
  }

  // Strands are at the same place, and do not touch one another.
  Status furnish(Rig* rig) const {
    const rods::ColliderSettings settings = {.rods_collide = false, .tolerance = kContactTolerance};
    const Status status = rods::RodCollider::create(rig->batch, settings, &rig->collider);
    return status.ok() ? case_.scene->furnish(rig->collider) : status;
  }

  // CG is asked for a tenth of what is wanted, down to what floats can.
  baker::ComparedSolver solver_for(double residual) const {
    return {.kind = case_.solver->kind,
            .cg = {.tolerance = static_cast<float>(std::max(0.1 * residual, 1e-7)), .max_iterations = 2000}};
  }
  rods::RodSettings settings(rods::RodSolver solver, uint32_t iterations, bool report) const {
    return {.solver = solver,
            .start = case_.start->start,
            .max_iterations = iterations,
            .tolerance_rad = 1e-6f,
            .report_residual = report,
            .network = case_.start->network,
            .correction = case_.start->correction};
  }

  void try_all(const Rig& from, std::vector<Tally>* tallies) const {
    Rig exact = made({.max_iterations = 200, .tolerance_rad = 1e-6f});
    exact.take_state(from);
    (void)exact.step(case_.scene->dt_s);
    uint32_t k = 1;
    for (size_t i = 0; i < tallies->size(); ++i) {
      // With a tighter inner tolerance fewer iterations may do.
      if (case_.solver->kind == baker::SolverKind::kCg && k <= case_.solver->most_iterations) k = 1;
      k = try_one(from, exact, k, kResiduals[i], &(*tallies)[i]);
    }
  }

  // From so many iterations on: fewer left more than this. Returns how many it took.
  uint32_t try_one(const Rig& from, const Rig& exact, uint32_t k, double residual, Tally* tally) const {
    while (k <= case_.solver->most_iterations) {
      baker::ComparedSolver solver = solver_for(residual);
      Rig tried = made(settings(solver.solver(), k, true));
      tried.take_state(from);
      const rods::RodReport report = tried.step(case_.scene->dt_s);
      if (solved(report, residual)) {
        tally->us.push_back(time_us(from, residual, k));
        tally->errors.push_back(apart(tried.batch, exact.batch));
        tally->iterations += k;
        tally->inner += static_cast<double>(solver.cg_iterations) / case_.strands;
        tally->most = std::max(tally->most, k);
        return k;
      }
      k = std::max(k + 1, k * 5 / 4);
    }
    tally->us.push_back(kNever);
    return k;
  }

  double time_us(const Rig& from, double residual, uint32_t iterations) const {
    baker::ComparedSolver solver = solver_for(residual);
    Rig timed = made(settings(solver.solver(), iterations, false));
    std::vector<double> us;
    for (int i = 0; i <= kRepeats; ++i) {
      timed.take_state(from);
      const double begin = clock_us(CLOCK_THREAD_CPUTIME_ID);
      (void)timed.step(case_.scene->dt_s);
      if (i > 0) us.push_back((clock_us(CLOCK_THREAD_CPUTIME_ID) - begin) / case_.strands);
    }
    return median(us);
  }

  // Of any segment, over the first one's length.
  double apart(const rods::RodBatch& a, const rods::RodBatch& b) const {
    double largest = 0;
    for (uint32_t s = 0; s < case_.strands; ++s) {
      for (uint32_t i = 0; i < case_.segments; ++i) {
        largest = std::max(largest, test::distance(a.pose(s, i).position_m, b.pose(s, i).position_m));
      }
    }
    return largest / static_cast<double>(strands_[0][0].length_m);
  }

  const TradeCase& case_;
  std::vector<Segments> strands_;
};

}  // namespace

std::vector<Reached> measure(const TradeCase& c) { return CaseRun(c).run(); }

}  // namespace sinew::perf

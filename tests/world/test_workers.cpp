// test_workers.cpp  The number of threads changes when things are done, never what comes out.
#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "tests/scenes/thread_pool.hpp"
#include "tests/world/stage.hpp"

using namespace sinew;
using test::Stage;

namespace {

constexpr size_t kBlocks = 11;

uint64_t hash_of_run(const TaskHook& tasks) {
  Stage stage(kBlocks, {.budget_mode = BudgetMode::kWorkUnits, .tasks = tasks});
  std::vector<float> seen;
  for (int f = 0; f < 40; ++f) {
    // Generous, then short: some instances change tiers, some are denied.
    REQUIRE(stage.world.set_budget_us(f % 20 < 10 ? 1e9f : 4).ok());
    stage.step(scenes::walk, 1.0 / 50);
    for (size_t i = 0; i < kBlocks; ++i) {
      const std::vector<float> places = stage.read(i);
      seen.insert(seen.end(), places.begin(), places.end());
    }
  }
  return test::hash_of(seen);
}

}  // namespace

TEST_CASE("same_bits_for_one_to_eight_workers") {
  const uint64_t serial = hash_of_run({});
  for (uint32_t workers = 1; workers <= 8; ++workers) {
    INFO(workers << " workers");
    scenes::ThreadPool pool(workers);
    CHECK(hash_of_run(pool.hook()) == serial);
  }
}

namespace {

// One of two threads goes away in the midst of each step's tasks, after its first; the other does the rest.
struct LosesAWorker {
  struct Ticket {
    TaskHook::Task task;
    void* argument;
    uint32_t count;
    std::thread lost;
  };
  static void* enqueue(TaskHook::Task task, void* argument, uint32_t count, void*) {
    return new Ticket{task, argument, count, std::thread([=] { task(argument, 0); })};
  }
  static void finish(void* given, void*) {
    const std::unique_ptr<Ticket> ticket(static_cast<Ticket*>(given));
    for (uint32_t i = 1; i < ticket->count; ++i) ticket->task(ticket->argument, i);
    ticket->lost.join();
  }
  static TaskHook hook() { return {.enqueue = enqueue, .finish = finish}; }
};

}  // namespace

TEST_CASE("a_worker_that_is_lost_in_the_midst_of_a_step_changes_no_bits") {
  CHECK(hash_of_run(LosesAWorker::hook()) == hash_of_run({}));
}

TEST_CASE(
    "by_the_clock_too_every_instance_is_served_or_counted_where_a_worker_is_lost_in_the_midst_of_a_step") {
  Stage stage(kBlocks, {.tasks = LosesAWorker::hook()});
  for (int f = 0; f < 60; ++f) {
    REQUIRE(stage.world.set_budget_us(f % 20 < 10 ? 1e6f : 20).ok());
    const FrameReport report = stage.step(scenes::walk, 1.0 / 60);
    const uint32_t simulated = report.instances_network + report.instances_modal;
    CHECK(simulated + report.instances_extrapolated + report.instances_skinned == kBlocks);
    if (f % 20 == 9) CHECK(simulated == kBlocks);
    for (size_t i = 0; i < kBlocks; ++i)
      CHECK(std::ranges::all_of(stage.read(i), [](float x) { return std::isfinite(x); }));
  }
  REQUIRE(stage.world.set_budget_us(1e6f).ok());
  stage.play(scenes::walk, 3);
  CHECK(stage.report(kBlocks - 1).tier == Tier::kNetwork);
}

// The order in which indices run must not matter either.
TEST_CASE("same_bits_when_tasks_run_backwards") {
  const auto enqueue = [](TaskHook::Task task, void* argument, uint32_t count, void*) -> void* {
    for (uint32_t i = count; i > 0; --i) task(argument, i - 1);
    return nullptr;
  };
  const TaskHook backwards{.enqueue = enqueue, .finish = [](void*, void*) {}};
  CHECK(hash_of_run(backwards) == hash_of_run({}));
}

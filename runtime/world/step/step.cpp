// step.cpp  One step of the world: plan, run, report.
#include "world/step/step.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "core/clock.hpp"
#include "core/floating_point.hpp"
#include "core/marker.hpp"
#include "core/run_tasks.hpp"
#include "world/step/fold.hpp"
#include "world/step/look.hpp"
#include "world/step/plan.hpp"
#include "world/step/skip_pose.hpp"

namespace sinew::world {
namespace {

Instance& take_answer(const WorldState& world, uint32_t slot, frame::TickPlans& ticks) noexcept {
  Instance& instance = *world.instances.at(slot);
  keep_hidden_ticks(world.rows[slot]);
  const PlanAnswer& answer = world.planning.answers[slot];
  instance.plan = {.decision = answer.decision,
                   .ticks = own_ticks(world, world.rows[slot], ticks),
                   .dt_s = own_step_s(world, *instance.state)};
  instance.state->turn_left_s = answer.turn_left_s;
  instance.marks.passed = false;
  return instance;
}

void bring_whole_near(const WorldState& world, uint32_t slot) noexcept {
  world.instances.bring_near(slot, sizeof(Instance));
  core::bring_near(world.rows[slot].state, sizeof(InstanceState));
}

void run_idle_chunk(WorldState& world, uint32_t chunk) noexcept {
  constexpr uint32_t kAhead = 6;
  const Marker marker(world.def.profiler, "idle", kNoInstance);
  const uint64_t start_ns = core::now_ns(world.def.clock);
  frame::TickPlans ticks = tick_plans(world);
  const uint32_t first = chunk * kIdleChunk, last = std::min(first + kIdleChunk, world.order.idle_count);
  for (uint32_t i = first; i < last; ++i) {
    if (i + kAhead < last) bring_whole_near(world, world.order.idle_slots[i + kAhead]);
    const uint32_t slot = world.order.idle_slots[i];
    Instance& instance = take_answer(world, slot, ticks);
    step_idle(instance, world.context);
    copy_to_row(instance, &world.rows[slot]);
  }
  world.order.idle_ns[chunk] = core::now_ns(world.def.clock) - start_ns;
}

// Idle chunks come behind what is in order.
void run_one(void* argument, uint32_t index) {
  const core::FloatingPointScope mode;
  WorldState& world = *static_cast<WorldState*>(argument);
  const auto active = static_cast<uint32_t>(world.order.running.size());
  if (index >= active) return run_idle_chunk(world, index - active);
  const uint32_t slot = world.order.running[index];
  if (index + 1 < active) bring_whole_near(world, world.order.running[index + 1]);
  frame::TickPlans ticks = tick_plans(world);
  Instance& instance = take_answer(world, slot, ticks);
  step_instance(instance, world.context, slot);
  copy_to_row(instance, &world.rows[slot]);
  world.bounds[slot] = instance.bound;
}

uint32_t idle_chunks(const WorldState& world) noexcept {
  return (world.order.idle_count + kIdleChunk - 1) / kIdleChunk;
}

bool is_limited(const WorldState& world) noexcept {
  return costs_are_measured(world) && world.budget_us > 0 && world.budget_us < 1e12f;
}

TickContext context_of(const WorldState& world, uint64_t start_ns) noexcept {
  TickContext context{.clock = world.def.clock,
                      .profiler = world.def.profiler,
                      .frame_s = world.dt_s,
                      .teleport = world.def.teleport};
  if (!is_limited(world)) return context;
  const float tasks_us = std::max(0.0f, world.budget_us - world.costs.reporting.p95_us());
  context.deadline_ns = start_ns + static_cast<uint64_t>(tasks_us * 1e3);
  context.tasks_us = tasks_us;
  context.behind_scale = 1 / std::max(1.0f, world.costs.capacity.scale());
  return context;
}

void run(WorldState& world) noexcept {
  core::run_tasks(world.def.tasks, run_one, &world,
                  static_cast<uint32_t>(world.order.running.size()) + idle_chunks(world));
}

// In microseconds of the world's clock since the step began.
struct Moments {
  float planned_us, ran_us, end_us;
};

void learn(WorldState& world, const Moments& at, const frame::ScheduleResult& plan,
           const FrameReport& report) noexcept {
  if (!costs_are_measured(world)) return;
  world.costs.reporting.observe(at.end_us - at.ran_us);
  world.costs.overhead.observe(at.planned_us + at.end_us - at.ran_us);
  const uint64_t idle_ns =
      std::accumulate(world.order.idle_ns.get(), world.order.idle_ns.get() + idle_chunks(world), uint64_t{0});
  if (world.order.idle_count > 0)
    world.costs.idle.observe(core::microseconds(idle_ns) / static_cast<float>(world.order.idle_count));
  if (!world.def.tasks.enqueue && !world.order.running.empty()) {
    const float busy_us = core::microseconds(world.order.busy_ns + idle_ns);
    world.costs.between.observe(std::max(0.0f, at.ran_us - at.planned_us - busy_us) /
                                static_cast<float>(world.order.running.size()));
  }
  for (frame::CostEstimate* estimate :
       {&world.costs.reporting, &world.costs.overhead, &world.costs.idle, &world.costs.between})
    estimate->settle();
  if (!is_limited(world) || report.ticks == 0) return;
  const float had_us = world.budget_us - at.planned_us - (at.end_us - at.ran_us);
  const float spent = had_us > 0 ? (at.ran_us - at.planned_us) / had_us : 2;
  const float planned_us = plan.planned_us, undone = planned_us > 0 ? world.order.undone_us / planned_us : 0;
  world.costs.capacity.observe(spent, std::min(undone, 1.0f), plan.denied);
}

void tell_spending(const WorldState& world, const frame::ScheduleResult& plan, FrameReport& report) noexcept {
  const float spent_us = costs_are_measured(world) ? report.total_us : plan.planned_us;
  report.over_budget = spent_us > report.budget_us;
  const bool wanting = plan.denied || report.instances_cut > 0;
  if (wanting && std::isfinite(report.budget_us))
    report.unspent_us = std::max(0.0f, report.budget_us - spent_us);
}

void remember(WorldState& world, const FrameReport& report) noexcept {
  if (world.def.report_history > 0) world.history[report.frame % world.def.report_history] = report;
}

}  // namespace

FrameReport step(WorldState& world, float dt_s) noexcept {
  std::optional<core::FloatingPointScope> mode(std::in_place);
  const uint64_t start_ns = core::now_ns(world.def.clock);
  const auto since_start_us = [&] { return core::microseconds(core::now_ns(world.def.clock) - start_ns); };
  FrameReport report{.frame = world.frames++, .budget_us = world.budget_us};
  Moments at{};
  Marker scheduling(world.def.profiler, "schedule", kNoInstance);
  look(world);
  const frame::ScheduleResult plan = plan_step(world, frame::exact_seconds(dt_s));
  world.context = context_of(world, start_ns);
  scheduling.end();
  report.schedule_us = at.planned_us = since_start_us();
  mode.reset();  // the caller's hook runs in the caller's mode: threads that it begins inherit it
  run(world);
  mode.emplace();
  at.ran_us = since_start_us();
  Marker reporting(world.def.profiler, "report", kNoInstance);
  fold_results(world, report);
  report.rejected_poses = std::exchange(world.rejected_poses, 0u);
  report.total_us = at.end_us = since_start_us();
  learn(world, at, plan, report);
  tell_spending(world, plan, report);
  remember(world, report);
  return report;
}

}  // namespace sinew::world

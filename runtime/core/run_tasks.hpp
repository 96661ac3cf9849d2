// run_tasks.hpp  Runs indices 0..count-1 of a task on the caller's threads, or serially without a hook.
#pragma once
#include <cstdint>

#include "sinew/types.hpp"

namespace sinew::core {

// Returns when all indices have run.
inline void run_tasks(const TaskHook& hook, TaskHook::Task task, void* argument, uint32_t count) noexcept {
  if (count == 0) return;
  if (!hook.enqueue) {
    for (uint32_t i = 0; i < count; ++i) task(argument, i);
    return;
  }
  hook.finish(hook.enqueue(task, argument, count, hook.context), hook.context);
}

}  // namespace sinew::core

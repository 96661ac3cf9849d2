// unreliable_pool.hpp  Two workers, one of which may be away.
#pragma once
#include "samples/demo/thread_pool.hpp"

namespace sinew::perf {

class UnreliablePool {
 public:
  void lose_worker(bool lost) { lost_ = lost; }
  TaskHook hook() { return {.enqueue = enqueue, .finish = finish, .context = this}; }

 private:
  static void* enqueue(TaskHook::Task task, void* argument, uint32_t count, void* pool) {
    auto& self = *static_cast<UnreliablePool*>(pool);
    if (!self.lost_) return self.both_hook_.enqueue(task, argument, count, self.both_hook_.context);
    for (uint32_t i = 0; i < count; ++i) task(argument, i);
    return nullptr;
  }
  static void finish(void* ticket, void* pool) {
    auto& self = *static_cast<UnreliablePool*>(pool);
    if (ticket) self.both_hook_.finish(ticket, self.both_hook_.context);
  }

  demo::ThreadPool both_{2};
  TaskHook both_hook_ = both_.hook();
  bool lost_ = false;
};

}  // namespace sinew::perf

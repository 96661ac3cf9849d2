// pinned_pair.hpp  Two workers, each on a processor of its own for as long as they are looked at: on a busy
// machine the kernel would put both on one.
#pragma once
#include <sched.h>

#include <memory>

#include "samples/demo/thread_pool.hpp"

namespace sinew::perf {

class PinnedPair {
 public:
  PinnedPair() : before_(allowed()), pool_(start_on(1)) { move_to(0); }
  ~PinnedPair() { sched_setaffinity(0, sizeof before_, &before_); }
  PinnedPair(const PinnedPair&) = delete;
  PinnedPair& operator=(const PinnedPair&) = delete;
  TaskHook hook() const { return pool_->hook(); }

 private:
  static cpu_set_t allowed() {
    cpu_set_t set;
    sched_getaffinity(0, sizeof set, &set);
    return set;
  }
  // The calling thread, to the index-th of the allowed processors; the last where there are fewer. Threads
  // that it starts stay there.
  void move_to(int index) const {
    cpu_set_t one;
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (!CPU_ISSET(cpu, &before_)) continue;
      CPU_ZERO(&one);
      CPU_SET(cpu, &one);
      if (index-- == 0) break;
    }
    sched_setaffinity(0, sizeof one, &one);
  }
  std::unique_ptr<demo::ThreadPool> start_on(int index) const {
    move_to(index);
    return std::make_unique<demo::ThreadPool>(2);
  }

  cpu_set_t before_;
  std::unique_ptr<demo::ThreadPool> pool_;
};

}  // namespace sinew::perf

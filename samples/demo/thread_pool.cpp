// thread_pool.cpp  see thread_pool.hpp.
#include "samples/demo/thread_pool.hpp"

namespace sinew::demo {

ThreadPool::ThreadPool(int threads) {
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadPool::~ThreadPool() {
  stop_ = true;
  ++generation_;
  generation_.notify_all();
}

TaskHook ThreadPool::hook() {
  if (workers_.empty()) return {};
  return {.enqueue = enqueue, .finish = finish, .context = this};
}

void* ThreadPool::enqueue(TaskHook::Task task, void* argument, uint32_t count, void* context) {
  ThreadPool& pool = *static_cast<ThreadPool*>(context);
  // No share can be claimed until all is set: a worker late from the last round meets an index beyond every
  // count.
  pool.claimed_.store(UINT32_MAX, std::memory_order_relaxed);
  pool.task_ = task;
  pool.argument_ = argument;
  pool.done_.store(0, std::memory_order_relaxed);
  pool.count_.store(count, std::memory_order_release);
  const uint32_t generation = pool.generation_.load(std::memory_order_relaxed) + 1;
  pool.claimed_.store(uint64_t{generation} << 32, std::memory_order_release);
  pool.generation_.store(generation, std::memory_order_release);
  pool.generation_.notify_all();
  return &pool;
}

void ThreadPool::finish(void* ticket, void*) {
  ThreadPool& pool = *static_cast<ThreadPool*>(ticket);
  pool.run_shares();
  const uint32_t count = pool.count_.load(std::memory_order_relaxed);
  while (pool.done_.load(std::memory_order_acquire) < count) std::this_thread::yield();
}

bool ThreadPool::claim(uint32_t* index) {
  uint64_t seen = claimed_.load(std::memory_order_acquire);
  do {
    *index = static_cast<uint32_t>(seen);
    if (*index >= count_.load(std::memory_order_acquire)) return false;
  } while (!claimed_.compare_exchange_weak(seen, seen + 1, std::memory_order_acquire));
  return true;
}

void ThreadPool::run_shares() {
  for (uint32_t index = 0; claim(&index);) {
    task_(argument_, index);
    done_.fetch_add(1, std::memory_order_release);
  }
}

void ThreadPool::work() {
  for (uint32_t seen = 0; !stop_;) {
    generation_.wait(seen, std::memory_order_acquire);
    seen = generation_.load(std::memory_order_acquire);
    run_shares();
  }
}

}  // namespace sinew::demo

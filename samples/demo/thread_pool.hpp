// thread_pool.hpp  A few threads behind the world's task hook: what an engine's job system would do in its
// place.
#pragma once
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "sinew/types.hpp"

namespace sinew::demo {

class ThreadPool {
 public:
  explicit ThreadPool(int threads);  // the calling thread is one of them
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  // For WorldDef::tasks; the pool must outlive the world. One thread: the null hook, serial.
  TaskHook hook();

 private:
  static void* enqueue(TaskHook::Task task, void* argument, uint32_t count, void* pool);
  static void finish(void* ticket, void* pool);
  void work();
  void run_shares();
  bool claim(uint32_t* index);

  // The one job at a time. Its generation and next index lie in one word: an index is claimed only for the
  // job it was read for, so a thread that wakes late never touches the next job's fields while they change.
  TaskHook::Task task_ = nullptr;
  void* argument_ = nullptr;
  std::atomic<uint32_t> count_{0}, done_{0};
  std::atomic<uint64_t> claimed_{0};     // generation << 32 | next index
  std::atomic<uint32_t> generation_{0};  // what sleeping threads wait on
  std::atomic<bool> stop_{false};
  std::vector<std::jthread> workers_;
};

}  // namespace sinew::demo

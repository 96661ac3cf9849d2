// thread_pool.hpp  Worker threads behind a TaskHook, as an engine's job system would be.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "sinew/types.hpp"

namespace sinew::scenes {

// The thread that calls finish() works too: `workers` of 1 starts no thread. Starting a batch allocates
// nothing.
class ThreadPool {
 public:
  explicit ThreadPool(uint32_t workers);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  TaskHook hook();

 private:
  void begin(TaskHook::Task task, void* argument, uint32_t count);
  void finish();
  void serve();
  void work();

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  uint64_t batch_ = 0;  // guarded by mutex_
  uint32_t busy_ = 0;   // guarded by mutex_: workers that have not yet left the present batch
  bool stop_ = false;   // guarded by mutex_
  TaskHook::Task task_ = nullptr;
  void* argument_ = nullptr;
  uint32_t count_ = 0;
  std::atomic<uint32_t> next_{0};
};

}  // namespace sinew::scenes

// thread_pool.cpp  Worker threads behind a TaskHook.
#include "tests/scenes/thread_pool.hpp"

namespace sinew::scenes {

ThreadPool::ThreadPool(uint32_t workers) {
  for (uint32_t w = 1; w < workers; ++w) threads_.emplace_back([this] { serve(); });
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

TaskHook ThreadPool::hook() {
  const auto enqueue = [](TaskHook::Task task, void* argument, uint32_t count, void* context) -> void* {
    static_cast<ThreadPool*>(context)->begin(task, argument, count);
    return context;
  };
  const auto finish = [](void* ticket, void*) { static_cast<ThreadPool*>(ticket)->finish(); };
  return {.enqueue = enqueue, .finish = finish, .context = this};
}

void ThreadPool::begin(TaskHook::Task task, void* argument, uint32_t count) {
  {
    const std::lock_guard lock(mutex_);
    task_ = task;
    argument_ = argument;
    count_ = count;
    next_ = 0;
    busy_ = static_cast<uint32_t>(threads_.size());
    ++batch_;
  }
  wake_.notify_all();
}

void ThreadPool::finish() {
  work();
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::serve() {
  uint64_t seen = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stop_ || batch_ != seen; });
      if (stop_) return;
      seen = batch_;
    }
    work();
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) done_.notify_one();
  }
}

void ThreadPool::work() {
  for (uint32_t index = next_++; index < count_; index = next_++) task_(argument_, index);
}

}  // namespace sinew::scenes

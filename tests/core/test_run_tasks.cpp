// test_run_tasks.cpp  Every index runs exactly once, with or without the caller's threads.
#include <catch2/catch.hpp>
#include <vector>

#include "core/run_tasks.hpp"

namespace {

struct Counts {
  std::vector<int> ran;
};

void count(void* argument, uint32_t index) { ++static_cast<Counts*>(argument)->ran[index]; }

// Runs everything backwards, and only when asked to finish.
struct LazyPool {
  sinew::TaskHook::Task task = nullptr;
  void* argument = nullptr;
  uint32_t count = 0;
  int enqueued = 0, finished = 0;

  static void* enqueue(sinew::TaskHook::Task task, void* argument, uint32_t count, void* context) {
    auto& pool = *static_cast<LazyPool*>(context);
    pool.task = task;
    pool.argument = argument;
    pool.count = count;
    ++pool.enqueued;
    return &pool;
  }
  static void finish(void* ticket, void*) {
    auto& pool = *static_cast<LazyPool*>(ticket);
    for (uint32_t i = pool.count; i > 0; --i) pool.task(pool.argument, i - 1);
    ++pool.finished;
  }
};

}  // namespace

TEST_CASE("no_hook_runs_every_index_once_in_order") {
  Counts counts{std::vector<int>(5)};
  sinew::core::run_tasks({}, count, &counts, 5);
  CHECK(counts.ran == std::vector<int>(5, 1));
}

TEST_CASE("hook_runs_every_index_once_before_return") {
  LazyPool pool;
  Counts counts{std::vector<int>(5)};
  const sinew::TaskHook hook{.enqueue = LazyPool::enqueue, .finish = LazyPool::finish, .context = &pool};
  sinew::core::run_tasks(hook, count, &counts, 5);
  CHECK(counts.ran == std::vector<int>(5, 1));
  CHECK(pool.finished == 1);
}

TEST_CASE("no_tasks_do_not_reach_the_hook") {
  LazyPool pool;
  const sinew::TaskHook hook{.enqueue = LazyPool::enqueue, .finish = LazyPool::finish, .context = &pool};
  sinew::core::run_tasks(hook, count, nullptr, 0);
  CHECK(pool.enqueued == 0);
}

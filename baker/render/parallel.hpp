// parallel.hpp  A loop over indices on a few threads.
#pragma once
#include <atomic>
#include <thread>
#include <vector>

namespace sinew::render {

// Calls body(index) for 0..count-1, each once, in any order. threads < 1: as many as the machine has.
template <class Body>
void parallel_for(int count, int threads, const Body& body) {
  const int wanted = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int index = next++; index < count; index = next++) body(index);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < wanted && i < count; ++i) helpers.emplace_back(work);
  work();
}

}  // namespace sinew::render
